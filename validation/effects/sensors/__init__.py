"""Errors of the measurement itself."""
