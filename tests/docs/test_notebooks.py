"""The notebooks that come along run from top to bottom, with `thermoscope` alone."""

import ast
import json
import re

import numpy as np
import pytest

NAMES = ["effects", "measurements", "network"]
ALLOWED = {"matplotlib.pyplot", "numpy", "thermoscope"}


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


def test_ways_out_for_the_heat_mend_the_board(root):
    """The error falls by more than nine tenths, on the recording that was never used too."""
    left = run(root, "measurements")
    before, after = ({t.name: t.rmse_K for t in left[name].tests} for name in ("before", "after"))
    assert all(after[name] < 0.1 * before[name] for name in before)
    assert left["better"].effects == tuple(group[0] for group in left["diagnosis"].groups)


def test_the_page_shows_the_cells_as_they_are(root):
    """python -m scripts.notebook_page writes it."""
    page = (root / "docs/notebooks.md").read_text()
    assert all(f"```python\n{cell}\n```" in page for name in NAMES for cell in code(root, name))
    pictures = re.findall(r"!\[.+\]\(images/(notebook-.+\.png)\)", page)
    assert len(pictures) == 5
    assert all((root / "docs/images" / name).is_file() for name in pictures)


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
