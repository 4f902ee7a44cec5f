"""thermoscope use ..."""
