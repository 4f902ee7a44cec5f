"""A network over a record: what drives it, its run, its steady state, and where the heat goes."""
