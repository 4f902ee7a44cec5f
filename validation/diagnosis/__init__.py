"""Where a model fails, and what a diagnosis says."""
