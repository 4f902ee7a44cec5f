"""The true machines: fine networks with their own formulas and their own integrator. NumPy and SciPy only."""
