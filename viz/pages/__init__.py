"""Pages to hand on: the report as HTML and PDF."""
