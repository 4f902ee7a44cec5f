"""python -m thermoscope: the command line."""

from thermoscope.cli import main

main()
