"""The core works without what is heavy; where an extra is missing, one message says what to install."""

import subprocess
import sys
import tomllib
from importlib.metadata import distribution

import pytest

from thermoscope.extras import EXTRAS

PYPI = {"skfem": "scikit-fem", "PIL": "pillow", "rerun": "rerun-sdk", "nptdms": "npTDMS", "OCP": "cadquery",
        "vtk": "pyvista", "vtkmodules": "pyvista"}  # fmt: skip
HEAVY = sorted({p for e in EXTRAS.values() for p in e.packages})
RUN = f"""
import sys

class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {HEAVY}:
            raise ModuleNotFoundError(f"No module named '{{name}}'", name=name)

sys.meta_path.insert(0, Absent())
sys.argv[0] = "thermoscope"
from thermoscope.cli import main
main()
"""


@pytest.fixture
def core(case):
    """core(*arguments) -> (exit code, stderr) of a command where no extra is installed; CASE is the case."""

    def run(words):
        arguments = [str(case) if w == "CASE" else w for w in words.split()]
        done = subprocess.run([sys.executable, "-c", RUN, *arguments], capture_output=True, text=True, timeout=500,
                              cwd=case.parent)  # fmt: skip
        return done.returncode, done.stderr

    return run


@pytest.mark.parametrize("commands", [
    ("test compare CASE --why", "model calibrate CASE", "explain diagnose CASE", "model add CASE convection@flange"),
    ("test doctor CASE", "explain effects CASE", "use simulate CASE", "use export CASE --as json", "test quantities"),
    ("test new three/tests/stand.csv --yes --network three/network.toml --out again",),
])  # fmt: skip
def test_declared_networks_need_the_core_alone(core, commands):
    for words in commands:
        code, said = core(words)
        assert code in (0, 1), f"{words}: {said}"
        assert "Traceback" not in said, f"{words}: {said}"


@pytest.mark.parametrize(("words", "extra"), [
    ("model build tefc-industrial", "cad"), ("show report CASE", "view"), ("show serve CASE", "view"),
    ("show picture CASE curves", "view"),
])  # fmt: skip
def test_a_missing_part_is_one_message(core, words, extra):
    code, said = core(words)
    assert code == 2
    assert f"pip install 'thermoscope[{extra}]'" in said
    assert "Traceback" not in said
    assert said.count("error:") == 1


def test_the_extras_are_those_of_the_project(root):
    """Every package that the code may miss is brought by the extra that the message names."""
    declared = tomllib.loads((root / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    for extra in EXTRAS.values():
        brought = {line.split(">")[0].split("[")[0].lower() for line in declared[extra.name]}
        assert {PYPI.get(p, p).lower() for p in extra.packages} <= brought
    assert all(distribution(PYPI.get(p, p)) for p in HEAVY)
