"""Which base a machine stood on, and what bases carry off."""
