"""Designs that trade temperature, settling time, loss and auxiliary power against each other, from one network."""
