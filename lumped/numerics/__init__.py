"""The compiled kernel: stages, steps, linear algebra, tangents."""
