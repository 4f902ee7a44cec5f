"""How many threads the command line leaves to BLAS, and that nobody looks for garbage in what it has loaded."""

import os
import subprocess
import sys

import pytest

AFTER_A_COMMAND = """
import gc, os, sys
from thermoscope.cli import main
sys.argv = ["thermoscope", *sys.argv[1:], "--help"]
try:
    main()
except SystemExit:
    print("numpy" in sys.modules, os.environ["OPENBLAS_NUM_THREADS"], gc.isenabled(), gc.get_freeze_count() > 0)
"""


@pytest.mark.parametrize(
    ("words", "given", "used"),
    [([], {}, "1"), ([], {"OPENBLAS_NUM_THREADS": "3"}, "3"), (["test", "compare"], {}, "1")],
)
def test_blas_has_one_thread_unless_told_otherwise(words, given, used):
    env = {k: v for k, v in os.environ.items() if not k.endswith("_NUM_THREADS")}
    done = subprocess.run(
        [sys.executable, "-c", AFTER_A_COMMAND, *words], env=env | given, capture_output=True, text=True, check=True
    )
    assert done.stdout.splitlines()[-1] == f"{bool(words)} {used} True True"
