"""Losses as heat sources of a network."""
