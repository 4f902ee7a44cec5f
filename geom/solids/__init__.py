"""Solids: made for CAD, read from STEP files, checked against the formulas."""
