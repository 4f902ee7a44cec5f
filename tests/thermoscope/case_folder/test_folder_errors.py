"""Every way a case folder can be wrong: one message that says what, where and what would be right; nothing written."""

import shutil

import numpy as np
import pytest
from small_case import small_case

from geom.errors import InputError
from thermoscope.case_folder.folder import find_case, load_case


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    return small_case(tmp_path_factory.mktemp("good"))


@pytest.fixture
def case(good, tmp_path):
    return shutil.copytree(good, tmp_path / "three")


def swap(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def rows(path):
    return path.read_text().splitlines()


def refused(case, *words):
    """The message of the refusal; it holds all the words, and the folder is as it was."""
    before = {p: p.read_bytes() for p in sorted(case.rglob("*")) if p.is_file()}
    with pytest.raises(InputError) as fault:
        load_case(case)
    message = str(fault.value)
    for word in words:
        assert word in message
    assert before == {p: p.read_bytes() for p in sorted(case.rglob("*")) if p.is_file()}
    return message


def test_no_folder(tmp_path):
    with pytest.raises(InputError, match="no such case folder"):
        find_case(tmp_path / "nowhere")
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "case.toml").touch()
    with pytest.raises(InputError, match=f"did you mean '{tmp_path / 'own'}'"):
        find_case(tmp_path / "onw")


def test_missing_recording_names_what_is_there(case):
    (case / "tests" / "road.csv").unlink()
    refused(case, "road.csv", "no such file", "stand.csv")


def test_missing_sheet(case):
    (case / "tests" / "road.toml").unlink()
    refused(case, "road.toml", "no such file")


@pytest.mark.parametrize(
    ("file", "old", "new", "words"),
    [
        ("case.toml", "sample_s", "sample", ["case.toml", "unknown key 'sample'", "sample_s"]),
        ("case.toml", 'role = "validate"', 'role = "validation"', ["[tests.road]", "validation", "validate"]),
        ("case.toml", 'network = "network.toml"', "", ["machine", "network"]),
        ("case.toml", "[tests.road]", "[calibration]\nfree = ['h.*']\n[tests.road]", ["'h.*'", "matches no parameter"]),
        ("tests/road.toml", 'unit = "A"', "", ["[columns.current]", "unit is missing", 'unit = "A"']),
        ("tests/road.toml", 'unit = "A"', 'unit = "V"', ["unknown unit 'V' of a current", "known: A"]),
        ("tests/road.toml", 'quantity = "current"', 'quantity = "curent"', ["curent", "did you mean 'current'"]),
        ("tests/road.toml", "sigma_K", "sigma", ["unknown key 'sigma'", "did you mean 'sigma_K'"]),
        ("tests/road.toml", 'place = "flange"', 'place = "flnge"', ["unknown place 'flnge'", "did you mean 'flange'"]),
        ("tests/road.toml", 'place = "ambient"', 'place = "yoke"', ["boundary 'ambient'", "place ="]),
        ("tests/road.toml", 'quantity = "current"', 'input = "I"\nquantity = "current"', ["'current_A'", "copper"]),
        ("tests/road.toml", "[columns.T_yoke]", "[columns.T_joke]", ["'T_joke' is not in the file", "'T_yoke'"]),
        ("tests/road.toml", 'time = "time_s"', 'time = "t"', ["column 't' is not in the file"]),
        ("tests/road.toml", "[test]", "[test", ["road.toml", "not readable as TOML"]),
        ("network.toml", "G_W_K = 8", "G = 8", ["network.toml", "winding-yoke"]),
    ],
    ids=lambda v: v if isinstance(v, str) and len(v) < 20 else "",
)
def test_wrong_key(case, file, old, new, words):
    swap(case / file, old, new)
    refused(case, *words)


def test_cell_that_is_no_number(case):
    path = case / "tests" / "road.csv"
    lines = rows(path)
    cells = lines[11].split(",")
    lines[11] = ",".join([*cells[:4], "n.a.?", *cells[5:]])
    path.write_text("\n".join(lines) + "\n")
    refused(case, "road.csv column 'T_winding' line 12", "'n.a.?' is not a number")


@pytest.mark.parametrize(
    "content", ["", "time_s,current,wind,air,T_winding,T_yoke,T_flange\n"], ids=["empty", "header"]
)
def test_empty_file(case, content):
    (case / "tests" / "road.csv").write_text(content)
    refused(case, "road.csv", "rows" if content else "empty")


def test_time_given_twice_says_the_line_and_the_cure(case):
    path = case / "tests" / "road.csv"
    lines = rows(path)
    lines.insert(21, lines[20])
    path.write_text("\n".join(lines) + "\n")
    refused(case, "column 'time_s' line 22", "given twice", "delete repeated rows")


def test_shuffled_times(case):
    path = case / "tests" / "road.csv"
    lines = rows(path)
    lines[30], lines[31] = lines[31], lines[30]
    path.write_text("\n".join(lines) + "\n")
    refused(case, "line 32", "comes after", "sort the file by time")


def test_long_gap_in_the_inputs(case):
    path = case / "tests" / "road.csv"
    lines = rows(path)
    path.write_text("\n".join(lines[:50] + lines[80:]) + "\n")
    refused(case, "nothing known from", "max_gap_s")


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


def test_frozen_sensor_is_told(case):
    path = case / "tests" / "road.csv"
    lines = rows(path)
    for i in range(100, 250):
        cells = lines[i].split(",")
        cells[6] = "25.0"
        lines[i] = ",".join(cells)
    path.write_text("\n".join(lines) + "\n")
    assert any("'T_flange': stands at 25" in n for n in load_case(case).notes)


def test_kelvin_and_kmh_are_converted(case):
    road = next(t for t in load_case(case).case.tests if t.name == "road")
    yoke = next(c for c in road.channels if c.name == "T_yoke")
    assert 15 < np.nanmin(yoke.y) < np.nanmax(yoke.y) < 120
    assert np.max(road.inputs["vehicle_speed_mps"]) <= 15.0 + 1e-9
