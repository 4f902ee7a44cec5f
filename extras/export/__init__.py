"""A model to take along: C99, FMU, JSON or MAT from the network of a case."""
