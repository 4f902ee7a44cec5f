"""CSV of any size and kind is read as pandas reads it, cell by cell, and foreign dates as pandas reads them."""

import re

import numpy as np
import pandas as pd
import pytest

from geom.errors import InputError
from measured.importing.clock import clock_of
from measured.importing.source import read_source
from measured.recordings.csv_file import BLOCK
from measured.recordings.data_table import csv_text, numbers
from measured.recordings.formats import read_csv
from measured.recordings.sheet import read_sheet
from measured.recordings.tables import load_table

ROWS = 3 * BLOCK // 24  # three blocks and more


def readings():
    rng = np.random.default_rng(3)
    T = np.round(20.0 + 80.0 * rng.random((ROWS, 2)), 3)
    return pd.DataFrame({"time_s": 0.5 * np.arange(ROWS), "T_winding": T[:, 0], "T_yoke": T[:, 1]})


def gaps(table):
    table.loc[ROWS // 2 :: 2, "T_winding"] = np.nan
    table.loc[:: ROWS // 5, ["T_winding", "T_yoke"]] = np.nan


def words(table):
    table["state"] = np.where(np.arange(ROWS) % 7, "on", "off")


def late_word(table):
    table["T_yoke"] = table["T_yoke"].astype(object)
    table.loc[ROWS - 5, "T_yoke"] = "OVERLOAD"


def quoted(table):
    table["note"] = np.where(np.arange(ROWS) == ROWS // 2, 'a "mark", and a comma,\nover two lines', "plain")


CHANGES = {"plain": lambda table: None, "gaps": gaps, "words": words, "late word": late_word, "quoted": quoted}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_every_cell_is_that_of_pandas(tmp_path, change, end):
    table = readings()
    change(table)
    file = tmp_path / "a.csv"
    table.to_csv(file, index=False, lineterminator=end)
    read = read_csv(file)
    wanted = pd.read_csv(file, float_precision="round_trip", low_memory=False)
    assert read.columns == list(wanted.columns)
    for name in read.columns:
        expected = wanted[name].to_numpy()
        if expected.dtype.kind in "if":
            assert np.array_equal(read[name], expected, equal_nan=True)
        else:
            assert [str(cell) for cell in read[name]] == [str(cell) for cell in expected]


def test_all_cells_in_quotation_marks(tmp_path):
    table = readings()
    gaps(table)
    table.to_csv(tmp_path / "a.csv", index=False, quoting=1)  # QUOTE_ALL
    read = read_csv(tmp_path / "a.csv")
    assert all(np.array_equal(read[name], table[name], equal_nan=True) for name in table.columns)


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("1,2\n3\n", "line 3: 1 values under 2 names"),
        ("1,2\n3,4,5\n", "line 3: 3 values under 2 names"),
        ('"1",2\n3,4,5\n', "3 values under 2 names"),
        ('"1,2\n3,4\n', "quotation marks in pairs"),
    ],
)
def test_rows_that_are_no_rows_are_refused(tmp_path, rows, words):
    (tmp_path / "a.csv").write_text(f"a,b\n{rows}")
    with pytest.raises(InputError, match=words):
        read_csv(tmp_path / "a.csv")


@pytest.mark.parametrize("before", ["", "Logger 7,v1.2\n", "Logger 7,v1.2\n\nStarted,2026-03-28\n"])
@pytest.mark.parametrize("units", ["", "s,degC,A\n"])
def test_a_case_finds_the_header_where_a_new_one_does(tmp_path, before, units):
    """A preamble and a row of units: the same names as for `new`, and a fault keeps its line in the file."""
    (tmp_path / "a.csv").write_text(f"{before}time,T_coil,I\n{units}0,20.5,1\n1,21.5,\n2,x,3\n3,22.5,4\n4,23,5\n")
    table = read_csv(tmp_path / "a.csv")
    assert table.columns == list(read_source(tmp_path / "a.csv").cells) == ["time", "T_coil", "I"]
    assert np.array_equal(table["I"], [1.0, np.nan, 3.0, 4.0, 5.0], equal_nan=True)
    line = (before + units).count("\n") + 4
    with pytest.raises(InputError, match=f"line {line}: 'x' is not a number"):
        numbers(table, "T_coil", tmp_path / "a.csv")


def test_a_name_over_two_lines_hides_no_sign_between_columns(tmp_path):
    """Its first half has a digit and an open quotation mark, its second half neither a digit nor a cell."""
    rows = "".join(f"{k},{20 + k}.5,{1 + k % 3}\n" for k in range(40))
    (tmp_path / "a.csv").write_text(f'time_s,"winding 1\nhot side",load\n{rows}')
    assert [len(cells) for cells in read_source(tmp_path / "a.csv").cells.values()] == [40, 40, 40]


def test_no_row_under_a_header_is_taken_for_part_of_it(tmp_path):
    """A first row of words is refused by its line, and a header of words stays the header beside a row of them."""
    (tmp_path / "a.csv").write_text("time,T,x,y,z\nstart,OVER,OVER,OVER,OVER\n" + "1,2,3,4,5\n" * 5)
    table = read_csv(tmp_path / "a.csv")
    assert (table.columns, table.rows) == (["time", "T", "x", "y", "z"], 6)
    with pytest.raises(InputError, match="line 2: 'OVER' is not a number"):
        numbers(table, "T", tmp_path / "a.csv")


def test_a_row_cut_off_in_a_later_block_is_named_by_its_line(tmp_path):
    lines = readings().to_csv(index=False).splitlines()
    lines[ROWS - 1] = lines[ROWS - 1].rpartition(",")[0]
    (tmp_path / "a.csv").write_text("\n".join(lines))
    with pytest.raises(InputError, match=f"line {ROWS}: 2 values under 3 names: the row was cut off"):
        read_csv(tmp_path / "a.csv")


@pytest.mark.parametrize("cell", ["٣", "1_0", "0x1F", "1d3", "+", "on"])
def test_what_is_no_number(tmp_path, cell):
    (tmp_path / "a.csv").write_text(f"a,b\n1,.5\n2,NULL\n3,{cell}\n", encoding="utf-8")
    with pytest.raises(InputError, match=f"line 4: '{re.escape(cell)}' is not a number"):
        numbers(read_csv(tmp_path / "a.csv"), "b", tmp_path / "a.csv")


def test_numbers_are_written_so_that_they_read_back_the_same(tmp_path):
    values = np.array([0.1, np.nan, 1e-9, 12345678.9, np.nextafter(1.0, 2.0)])
    (tmp_path / "a.csv").write_text("".join(csv_text({"a": values, "b": np.arange(5.0)})))
    assert np.array_equal(read_csv(tmp_path / "a.csv")["a"], values, equal_nan=True)


DATES = ("2024-03-31", "2024/3/1", "2024.03.05", "31.12.2024", "05.03.2024", "3/25/2024", "25/3/24", "1.2.24")
CLOCKS = (" 00:30", "T00:30:00", " 10:00:02.5", " 10:00:02,25", " 1:05:09 PM", " 12:00:00 AM", "T23:59:59.123456")
ZONES = ("", "Z", "+02:00", "-0530", " UTC", "+02")


@pytest.mark.parametrize("date", DATES)
def test_dates_are_those_of_pandas(tmp_path, date):
    day_first = date.startswith(("31.", "05.", "25/", "1."))
    for clock, zone in [(c, z) for c in CLOCKS for z in ZONES if not (z and "M" in c)]:
        later = f"{date}{clock}{zone}"
        (tmp_path / "a.txt").write_text("Time;T\n" + f"{later};1.5\n" * 3)
        found = clock_of(read_source(tmp_path / "a.txt"))
        expected = pd.to_datetime(later.replace(",", "."), utc=True, dayfirst=day_first)
        assert found.start == pytest.approx(expected.timestamp(), abs=1e-6), later


def test_a_second_recorder_that_repeats_a_time_is_named(tmp_path):
    (tmp_path / "a.csv").write_text("time_s,T\n0,20\n1,21\n2,22\n")
    (tmp_path / "b.csv").write_text("t,I\n0,1\n1,2\n1,3\n")
    data = {
        "test": {"time": "time_s"},
        "recorders": {"power": {"file": "b.csv", "time": "t"}},
        "columns": {"T": {"quantity": "temperature", "unit": "degC", "place": "winding"}},
    }
    with pytest.raises(InputError, match=r"b\.csv column 't' line 4: time 1 is given twice"):
        load_table(tmp_path / "a.csv", read_sheet(data, "sheet.toml", tmp_path))
