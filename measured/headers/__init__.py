"""What the head of a foreign table says: where it begins, names, units, and what words in it mean."""
