"""The true machines, a file each: the machine, its tests, and what can go wrong on it."""
