"""Convection, radiation and the surroundings."""
