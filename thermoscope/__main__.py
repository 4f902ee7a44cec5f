"""python -m thermoscope: the command line."""

import os
import sys
from pathlib import Path

# Python searches first where it was started. That is where cases lie, which are data: nothing of them is imported.
if not sys.flags.safe_path and Path(__file__).parents[1] != Path(sys.path[0]).resolve() == Path(os.getcwd()).resolve():
    del sys.path[0]

from thermoscope.cli import main

main()
