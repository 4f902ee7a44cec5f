"""From matrices to temperatures: direct solvers, Newton's method, time steps."""
