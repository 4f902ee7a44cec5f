"""Shipped files as they are, through the commands that take them: none dies, and what comes out is finite."""

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest

from lumped.condensation.reduction import Recipe
from thermoscope.case_folder.folder import load_machine_file
from thermoscope.cli import main
from thermoscope.commands.model.crosscheck import checked
from thermoscope.verification.network_size import smallest_network

ROOT = Path(__file__).resolve().parents[2]
SMALL = Recipe(tolerance=0.1, random_points=2, local_points=2, local_states=4)
# One of each kind: two bases to stand on, a jacket, a cowl with radial fins. The others differ from these in numbers.
MACHINES = ["cases/pmsm-bases/machine.toml", "ipmsm-48s8p-jacket", "tefc-industrial-radial"]
COMMANDS = {
    "tclab": [["compare"], ["simulate"], ["doctor"], ["export", "--csv"]],
    "hust-ipmsm": [["simulate", "--cycle", "s3-40"], ["doctor"]],
}


def document(monkeypatch, capsys, *arguments):
    """Exit code and JSON document of a command in this process."""
    monkeypatch.setattr(sys, "argv", ["thermoscope", *map(str, arguments), "--json", "-"])
    with pytest.raises(SystemExit) as end:
        main()
    return end.value.code, json.loads(capsys.readouterr().out)


@pytest.mark.parametrize("name", MACHINES)
def test_a_shipped_machine_is_built_and_held_against_its_field(name):
    """On a coarse mesh, and of any accuracy: that it runs and closes its balance is the point."""
    machine = load_machine_file(ROOT / name if name.endswith(".toml") else Path(name))
    found = smallest_network(machine, 1e3, size_m=0.15, segments=24, recipe=SMALL, rounds=0, across=1)
    result = checked(found.built, found, lambda message: None)
    assert result["energy_balance"] < 1e-9
    assert all(math.isfinite(part["network_mean_C"]) for part in result["crosscheck"])


@pytest.mark.parametrize(("case", "words"), [(c, w) for c, all_ in COMMANDS.items() for w in all_])
def test_a_shipped_case_goes_through_the_commands(tmp_path, monkeypatch, capsys, case, words):
    monkeypatch.chdir(tmp_path)
    command, *options = words
    out = ["--out", tmp_path / "out"] if command in ("simulate", "export") else []
    code, found = document(monkeypatch, capsys, command, ROOT / "cases" / case, *options, *out)
    assert code in (0, 1)
    assert found
    assert "NaN" not in json.dumps(found)


def test_the_package_runs_as_a_module():
    done = subprocess.run([sys.executable, "-m", "thermoscope", "--help"], capture_output=True, text=True, cwd=ROOT)
    assert done.returncode == 0
    assert "explain" in done.stdout
