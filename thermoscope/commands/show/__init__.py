"""thermoscope show ..."""
