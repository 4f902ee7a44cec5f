"""What a thermal network is, and what can be read from its links alone."""
