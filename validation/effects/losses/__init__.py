"""Losses: copper, iron, friction, brushes, air."""
