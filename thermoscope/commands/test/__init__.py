"""thermoscope test ..."""
