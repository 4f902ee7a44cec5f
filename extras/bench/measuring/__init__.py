"""Temperatures from electrical readings, and how sure they are."""
