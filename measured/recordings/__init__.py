"""Recordings and their sheets: formats, units, clocks, grids."""
