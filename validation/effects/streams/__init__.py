"""Coolant and cooling air: how much flows, and how far it reaches."""
