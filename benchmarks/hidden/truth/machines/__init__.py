"""The true machines, one or two files each: the machine, and its tests with what can go wrong on it."""
