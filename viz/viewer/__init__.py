"""A machine to turn, cut and play in the browser: one page that needs nothing but itself."""
