"""The notebooks that come along run from top to bottom, with `thermoscope` alone."""

import ast
import json

import numpy as np
import pytest

NAMES = ["effects", "measurements", "network"]
ALLOWED = {"numpy", "thermoscope"}


def code(root, name):
    """The code cells, one text each."""
    cells = json.loads((root / "examples/notebooks" / f"{name}.ipynb").read_text())["cells"]
    return ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]


def run(root, name):
    left = {}
    for cell in code(root, name):
        exec(compile(cell, name, "exec"), left)
    return left


@pytest.mark.parametrize("name", ["effects", "network"])
def test_notebook_against_its_reference(root, name):
    """Steady states of linear networks are exact."""
    left = run(root, name)
    assert np.abs(np.asarray(left["computed"]) - left["expected"]).max() < 1e-6


def test_a_coupling_mends_the_board(root, monkeypatch):
    """Its error falls by more than half, and the figure has the model of before beside that of after."""
    monkeypatch.setattr("matplotlib.pyplot.show", lambda *_: None)
    left = run(root, "measurements")
    assert left["after"].rmse_K < 0.5 * left["before"].rmse_K
    assert left["better"].effects == (left["coupling"][0],)
    assert left["figure"].axes


def test_notebooks_need_no_room(root):
    for name in NAMES:
        for node in ast.walk(ast.parse("\n".join(code(root, name)))):
            if isinstance(node, ast.Import | ast.ImportFrom):
                packages = [node.module] if isinstance(node, ast.ImportFrom) else [a.name for a in node.names]
                assert set(packages) <= ALLOWED, name


def test_no_notebook_is_forgotten_and_none_holds_output(root):
    files = sorted((root / "examples/notebooks").glob("*.ipynb"))
    assert [f.stem for f in files] == NAMES
    cells = [cell for f in files for cell in json.loads(f.read_text())["cells"] if cell["cell_type"] == "code"]
    assert not any(cell["outputs"] or cell["execution_count"] for cell in cells)
