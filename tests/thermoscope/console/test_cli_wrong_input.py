"""Wrong input through the real command: one message with what, where and what would be right; nothing half-written.

The command line's own main is called in this process.
"""

import gzip
import json

import pytest
from command_line import answered

from geom.errors import InputError


def edited(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def lines(case, name="stand"):
    return (case / "tests" / f"{name}.csv").read_text().splitlines()


def rewritten(case, rows, name="stand"):
    (case / "tests" / f"{name}.csv").write_text("\n".join(rows) + "\n")


def cell(case, line, column, value):
    """Put a value into line (1 is the header) and column of stand.csv."""
    rows = lines(case)
    cells = rows[line - 1].split(",")
    cells[rows[0].split(",").index(column)] = value
    rows[line - 1] = ",".join(cells)
    rewritten(case, rows)


def unknown_key(case):
    edited(case / "case.toml", "sample_s", "sample_sec")


def unknown_key_in_sheet(case):
    edited(case / "tests" / "road.toml", 'place = "yoke"', 'plase = "yoke"')


def unit_forgotten(case):
    edited(case / "tests" / "stand.toml", 'unit = "A"\n', "")


def unit_unknown(case):
    edited(case / "tests" / "stand.toml", 'unit = "km/h"', 'unit = "kmh"')


def place_unknown(case):
    edited(case / "tests" / "stand.toml", 'place = "flange"', 'place = "flnge"')


def column_absent(case):
    edited(case / "tests" / "stand.toml", "[columns.T_yoke]", "[columns.T_joke]")


def recording_missing(case):
    (case / "tests" / "town.csv").unlink()


def sheet_missing(case):
    (case / "tests" / "town.toml").unlink()


def network_missing(case):
    (case / "network.toml").unlink()


def not_toml(case):
    (case / "case.toml").write_text("[case\n")


def no_role(case):
    edited(case / "case.toml", 'role = "validate"', 'role = "training"')


def empty_recording(case):
    (case / "tests" / "stand.csv").write_text("")


def only_a_header(case):
    rewritten(case, lines(case)[:1])


def word_in_cell(case):
    cell(case, 12, "T_yoke", "hot")


def infinite_cell(case):
    cell(case, 12, "T_yoke", "inf")


def no_time(case):
    cell(case, 12, "time_s", "")


def shuffled_times(case):
    rows = lines(case)
    rows[20], rows[40] = rows[40], rows[20]
    rewritten(case, rows)


def repeated_time(case):
    rows = lines(case)
    rewritten(case, [*rows[:30], rows[29], *rows[30:]])


def long_hole_in_input(case):
    rows = lines(case)
    for i in range(50, 100):
        cells = rows[i].split(",")
        cells[1] = ""
        rows[i] = ",".join(cells)
    rewritten(case, rows)


def long_gap_in_time(case):
    rows = lines(case)
    rewritten(case, [*rows[:100], *rows[200:]])


def no_reading(case):
    rows = lines(case)
    rewritten(case, [rows[0], *(",".join([*r.split(",")[:6], ""]) for r in rows[1:])])


def below_absolute_zero(case):
    cell(case, 12, "T_flange", "-300")


def input_missing(case):
    edited(case / "tests" / "stand.toml", '[columns.current]\nquantity = "current"\nunit = "A"\n', "")


def boundary_missing(case):
    edited(case / "tests" / "stand.toml", "[columns.air]", "[columns.air]\nuse = false")


def free_matches_nothing(case):
    edited(case / "case.toml", "[tests.stand]", '[calibration]\nfree = ["link.winding-yok"]\n[tests.stand]')


def model_of_another_network(case):
    (case / "model.toml").write_text(
        '[[revision]]\nnumber = 1\naction = "calibrate"\neffects = []\nvalues = { "link.wrong" = 1.0 }\n'
    )


WRONG = {
    unknown_key: ["case.toml", "sample_sec", "sample_s"],
    unknown_key_in_sheet: ["road.toml", "columns.T_yoke", "place"],
    unit_forgotten: ["stand.toml", "columns.current", "unit", "A"],
    unit_unknown: ["stand.toml", "columns.wind", "kmh", "km/h"],
    place_unknown: ["stand.toml", "columns.T_flange", "flnge", "'flange'"],
    column_absent: ["stand.csv", "T_joke", "T_yoke"],
    recording_missing: ["town.csv", "no such file"],
    sheet_missing: ["town.toml", "no such file"],
    network_missing: ["network.toml", "no such file"],
    not_toml: ["case.toml", "TOML"],
    no_role: ["tests.road", "training", "validate"],
    empty_recording: ["stand.csv", "empty"],
    only_a_header: ["stand.csv", "rows"],
    word_in_cell: ["stand.csv", "T_yoke", "line 12", "hot"],
    infinite_cell: ["stand.csv", "T_yoke", "line 12"],
    no_time: ["stand.csv", "time_s", "line 12"],
    shuffled_times: ["stand.csv", "line 22", "sort"],
    repeated_time: ["stand.csv", "line 31", "twice"],
    long_hole_in_input: ["stand.csv", "current"],
    long_gap_in_time: ["stand.csv", "from 975 s to 1995 s"],
    no_reading: ["stand.csv", "T_flange"],
    below_absolute_zero: ["stand.csv", "T_flange", "line 12"],
    input_missing: ["stand.toml", "current_A"],
    boundary_missing: ["stand.toml", "ambient"],
    free_matches_nothing: ["case.toml", "link.winding-yok", "link.winding-yoke"],
    model_of_another_network: ["model.toml", "link.wrong"],
}


@pytest.mark.parametrize("spoil", WRONG, ids=lambda spoil: spoil.__name__)
def test_one_message_exit_2_nothing_written(case, contents, spoil):
    spoil(case)
    before = contents(case)
    code, out, err = answered("calibrate", case, "--json", case / "result.json")
    told = [line for line in err.splitlines() if line.startswith("error: ")]
    assert code == 2
    assert out == ""
    assert len(told) == 1
    assert "Traceback" not in err
    assert [word for word in WRONG[spoil] if word not in told[0]] == []
    assert contents(case) == before


def test_unknown_effect_names_the_kinds(case, contents):
    before = contents(case)
    code, _, err = answered("add", case, "convektion@flange")
    assert code == 2
    assert "convektion" in err
    assert "convection" in err
    assert contents(case) == before


def test_effect_where_it_cannot_sit_names_the_places(case):
    code, _, err = answered("add", case, "convection@flnge")
    assert code == 2
    assert "flange" in err


def test_removing_what_is_not_there(case):
    code, _, err = answered("remove", case, "convection@flange")
    assert code == 2
    assert "not in the model" in err


def test_no_such_case_lists_those_that_come_along():
    code, _, err = answered("compare", "no-such-case")
    assert code == 2
    assert "hust-ipmsm" in err


def test_result_that_cannot_be_written(case):
    code, _, err = answered("compare", case, "--json", case / "case.toml" / "x.json")
    assert code == 2
    assert "x.json" in err


@pytest.mark.parametrize(
    "arguments", [["compre"], ["compare"], ["compare", "x", "--jsn", "-"], ["improve", "x", "--most", "0"]]
)
def test_wrong_command_line(thermoscope, arguments):
    done = thermoscope(*arguments)
    assert done.code == 2
    assert done.out == ""
    assert "Traceback" not in done.err


def test_debug_shows_where_it_came_from(thermoscope, tmp_path):
    """The error goes through, and Python prints where it was raised."""
    with pytest.raises(InputError):
        thermoscope("compare", tmp_path, "--debug")


def test_gzipped_recording_reads_the_same(case):
    code, plain, _ = answered("compare", case, "--json", "-")
    recording = case / "tests" / "stand.csv"
    recording.with_name("stand.csv.gz").write_bytes(gzip.compress(recording.read_bytes()))
    recording.unlink()
    again, zipped, _ = answered("compare", case, "--json", "-")
    assert (code, plain) == (again, zipped)


def test_gap_in_time_is_told_and_not_compared(case):
    rows = lines(case)
    rewritten(case, [*rows[:100], *rows[108:]])
    _, out, err = answered("compare", case, "--json", "-")
    assert json.loads(out)["tests"][0]["channels"][0]["n"] == 200 - 5  # 8 rows of 10 s on a grid of 15 s
    assert "no rows from 980 s to 1070 s" in err


def test_missing_reading_is_told(case):
    cell(case, 50, "T_yoke", "NaN")
    code, _, err = answered("compare", case)
    assert code == 1
    assert "T_yoke" in err
    assert "line 50" in err
