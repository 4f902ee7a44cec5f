"""thermoscope explain ..."""
