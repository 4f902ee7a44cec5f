"""The benchmarks are scripts: their folder goes on the path as `python benchmarks/NAME.py` would put it there."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
