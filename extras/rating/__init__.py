"""From temperatures to what a machine may carry: continuous and short-time ratings with their bands."""
