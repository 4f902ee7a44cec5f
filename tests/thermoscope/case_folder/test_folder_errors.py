"""A folder that is not there, and gaps in a recording: told, never hidden. What is refused: tests/inputs."""

import numpy as np
import pytest

from geom.errors import InputError
from thermoscope.case_folder.folder import find_case, load_case


def rows(path):
    return path.read_text().splitlines()


def test_no_folder(tmp_path):
    with pytest.raises(InputError, match="no such case folder"):
        find_case(tmp_path / "nowhere")
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "case.toml").touch()
    with pytest.raises(InputError, match=f"did you mean '{tmp_path / 'own'}'"):
        find_case(tmp_path / "onw")


def test_short_gap_is_told_and_not_hidden(case):
    path = case / "tests" / "road.csv"
    lines = rows(path)
    path.write_text("\n".join(lines[:50] + lines[58:]) + "\n")
    folder = load_case(case)
    (note,) = [n for n in folder.notes if "no rows from" in n]
    assert "480 s to 570 s" in note
    road = next(t for t in folder.case.tests if t.name == "road")
    inside = (road.time > 490) & (road.time < 560)
    assert all(np.isnan(c.y[inside]).all() for c in road.channels)
    assert np.isfinite(road.inputs["current_A"]).all()


def test_missing_readings_are_kept_as_missing(case):
    path = case / "tests" / "road.csv"
    lines = rows(path)
    for i in (40, 41, 42, 43):
        cells = lines[i].split(",")
        cells[4] = "" if i % 2 else "NaN"
        lines[i] = ",".join(cells)
    path.write_text("\n".join(lines) + "\n")
    (note,) = [n for n in load_case(case).notes if "missing" in n]
    assert note.endswith("'T_winding': 4 missing readings, first in line 41")
    lines[60] = ",".join([*lines[60].split(",")[:5], "", *lines[60].split(",")[6:]])
    path.write_text("\n".join(lines) + "\n")
    folder = load_case(case)
    (note,) = [n for n in folder.notes if "missing" in n]
    assert note.endswith("'T_winding': 4 missing readings, first in line 41; 5 in 2 columns")
    road = next(t for t in folder.case.tests if t.name == "road")
    winding = next(c for c in road.channels if c.name == "T_winding")
    assert 1 <= np.isnan(winding.y).sum() <= 3
