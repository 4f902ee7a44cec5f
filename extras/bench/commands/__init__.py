"""thermoscope bench ..."""
