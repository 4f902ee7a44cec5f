"""The benchmarks are scripts: their folder goes on the path, last, so that none of them hides a module of that name."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parents[2] / "benchmarks"))
