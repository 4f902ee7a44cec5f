"""The core works without what is heavy; where an extra is missing, one message says what to install."""

import re
import subprocess
import sys
import tomllib
from importlib.metadata import distribution

import pytest

from geom.errors import MissingDependency
from thermoscope.parts import EXTRAS, NEEDS, required

PYPI = {
    "skfem": "scikit-fem",
    "PIL": "pillow",
    "imageio_ffmpeg": "imageio-ffmpeg",
    "rerun": "rerun-sdk",
    "nptdms": "npTDMS",
    "OCP": "cadquery",
    "vtk": "pyvista",
    "vtkmodules": "pyvista",
}
HEAVY = sorted({p for e in EXTRAS.values() for p in e.packages})
RUN = f"""
import sys

class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {[*HEAVY, "pandas"]}:  # which other packages ask for
            raise ModuleNotFoundError(f"No module named '{{name}}'", name=name)

sys.meta_path.insert(0, Absent())
sys.argv[0] = "thermoscope"
from thermoscope.cli import main
for words in sys.argv[1:]:
    sys.argv[1:] = words.split()
    print("#", words, file=sys.stderr)
    try:
        main()
    except SystemExit as end:
        print("exit", end.code or 0, file=sys.stderr)
"""


def said(case, commands):
    """(exit code, stderr) of each command, in one process where no extra is installed; CASE is the case."""
    asked = [words.replace("CASE", str(case)) for words in commands]
    done = subprocess.run(
        [sys.executable, "-c", RUN, *asked], capture_output=True, text=True, timeout=500, cwd=case.parent
    )
    assert done.returncode == 0, done.stderr
    parts = re.findall(r"^# .*?\n(.*?)^exit (\d+)$", done.stderr, re.M | re.S)
    assert len(parts) == len(commands), done.stderr
    return [(int(code), text) for text, code in parts]


@pytest.mark.nightly
@pytest.mark.parametrize(
    "commands",
    [
        (
            "test compare CASE --why",
            "model calibrate CASE",
            "explain diagnose CASE",
            "model add CASE convection@flange",
        ),
        (
            "test doctor CASE",
            "explain effects CASE",
            "use simulate CASE",
            "use export CASE --as json",
            "use export CASE --as xlsx",
            "use export CASE --as csv",
            "test quantities",
            "test new three/tests/stand.csv --yes --network three/network.toml --out again",
        ),
    ],
)
def test_declared_networks_need_the_core_alone(case, commands):
    for words, (code, text) in zip(commands, said(case, commands), strict=True):
        assert code in (0, 1), f"{words}: {text}"
        assert "Traceback" not in text, f"{words}: {text}"


def test_a_missing_part_is_one_message(case):
    needs = {
        "model build tefc-industrial": "cad",
        "show report CASE": "view",
        "show serve CASE": "view",
        "show picture CASE curves": "view",
    }
    for extra, (code, text) in zip(needs.values(), said(case, list(needs)), strict=True):
        assert code == 2
        assert f"pip install 'thermoscope[{extra}]'" in text
        assert "Traceback" not in text
        assert text.count("error:") == 1


def test_the_extras_are_those_of_the_project(root):
    """Every package that the code may miss is brought by the extra that the message names."""
    declared = tomllib.loads((root / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    for extra in EXTRAS.values():
        brought = {line.split(">")[0].split("[")[0].lower() for line in declared[extra.name]}
        assert {PYPI.get(p, p).lower() for p in extra.packages} <= brought
    assert all(distribution(PYPI.get(p, p)) for p in HEAVY)


@pytest.mark.nightly
def test_a_missing_part_is_said_before_any_work_and_is_the_right_one(case):
    """A declared network has no geometry, whatever is installed; an optimisation lacks its method first."""
    asked = {
        "show viewer CASE": "no geometry",
        "show film CASE": "no geometry",
        "show viewer road-test": "[view]",
        "use optimise road-test --limit winding=155": "[optimise]",
        "show report road-test": "[view]",
        "model build tefc-industrial": "[cad]",
        "use optimise CASE --help": "Usage",
    }
    for (words, right), (code, text) in zip(asked.items(), said(case, list(asked)), strict=True):
        if right == "Usage":
            assert code == 0
            continue
        assert code == 2, (words, text)
        assert right in text
        assert not [line for line in text.splitlines() if not line.startswith(("error: ", "#"))], text


def test_a_package_that_cannot_be_imported_is_said_before_any_work(tmp_path, monkeypatch):
    (tmp_path / "pymoo.py").write_text('raise ImportError("a library of it is gone")')
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "pymoo", raising=False)
    with pytest.raises(MissingDependency, match=r"'pymoo' is not installed: pip install 'thermoscope\[optimise\]'"):
        required(NEEDS["optimise"])
