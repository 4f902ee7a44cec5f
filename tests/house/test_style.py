"""The house rules that a program can check: style, types, import directions."""

import subprocess
import sys

import pytest

pytestmark = pytest.mark.heavy
ROOMS = ["geom", "fem", "lumped", "measured", "validation", "viz", "thermoscope", "extras"]


def run(root, *command):
    return subprocess.run([sys.executable, "-m", *command], cwd=root, capture_output=True, text=True)


@pytest.mark.parametrize(
    "command", [["ruff", "check", "."], ["ruff", "format", "--check", "."]], ids=["lint", "format"]
)
def test_ruff(root, command):
    done = run(root, *command)
    assert done.returncode == 0, done.stdout + done.stderr


def test_types(root):
    done = run(root, "mypy")
    assert done.returncode == 0, done.stdout + done.stderr


def test_import_directions(root):
    done = subprocess.run(
        [sys.executable, "-c", "from importlinter.cli import lint_imports_command; lint_imports_command()"],
        cwd=root,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_rooms_load_nothing_heavy():
    """CAD, VTK, viewers and plotting are loaded by the functions that need them, not by `import room`."""
    heavy = ["cadquery", "OCP", "vtkmodules", "pyvista", "rerun", "plotly", "netgen", "matplotlib"]
    said = f"print(room, *[m for m in {heavy} if m in sys.modules])"
    code = f"import sys\nfor room in {ROOMS}:\n    __import__(room)\n    {said}"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.split() == ROOMS, done.stdout + done.stderr
