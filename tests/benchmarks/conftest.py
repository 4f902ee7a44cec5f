"""The benchmarks are scripts: their folder goes on the path, last, for benchmarks/viz.py must not hide the room viz."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parents[2] / "benchmarks"))
