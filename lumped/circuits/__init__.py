"""Coolant circuits and the pressure that drives them."""
