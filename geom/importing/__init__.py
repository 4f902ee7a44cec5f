"""Machine files of other programs, each read by one file: to a machine file that names the source of every value."""
