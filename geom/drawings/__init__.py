"""A machine on paper: drawings with dimensions, sections, the library and the families' pages."""
