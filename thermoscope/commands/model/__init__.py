"""thermoscope model ..."""
