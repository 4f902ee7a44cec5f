"""Plots on paper: curves, errors, candidates, heat flows, screening."""
