"""Recordings in every format: what is not a recording is refused in one line, what is one is read as its CSV is."""

import gzip
import os
import zipfile

import numpy as np
import pandas as pd
import pytest
from command_line import answered, refusal
from input_cases import case_of, cell, changed, edited

from thermoscope.case_folder.folder import load_case
from validation.comparison.compare import compare

UNITS = ("A", "km/h", "degC", "degC", "K", "degC")  # of its columns
STAND, START = "tests/stand.csv", pd.Timestamp("2024-03-31 00:30:00")


def text(make):
    """Another text of the recording."""
    return lambda case: (case / STAND).write_text(make((case / STAND).read_text()))


def lines(make):
    return text(lambda content: "\n".join(make(content.splitlines())) + "\n")


def packed(make):
    def write(case):
        content = (case / STAND).read_bytes()
        (case / STAND).unlink()
        (case / f"{STAND}.gz").write_bytes(make(content))

    return write


def other(suffix, content):
    def write(case):
        (case / STAND).unlink()
        (case / f"tests/stand.{suffix}").write_bytes(content)

    return write


def excel(change=lambda table: table):
    def write(case):
        change(pd.read_csv(case / STAND)).to_excel(case / "tests/stand.xlsx", index=False)
        (case / STAND).unlink()

    return write


def parquet(change=lambda table: table, **options):
    def write(case):
        change(pd.read_csv(case / STAND)).to_parquet(case / "tests/stand.parquet", **options)
        (case / STAND).unlink()

    return write


def link(case):
    (case / STAND).unlink()
    (case / STAND).symlink_to(case / "nowhere.csv")


def document(case):
    (case / STAND).unlink()
    with zipfile.ZipFile(case / "tests/stand.xlsx", "w") as file:
        file.writestr("word/document.xml", "x")


def worksheet(case):
    edited(case / "tests/stand.toml", 'time = "time_s"', 'time = "time_s"\nworksheet = "data"')


def instants(table):
    return table.assign(time_s=START + pd.to_timedelta(table.time_s, unit="s"))


NO_NUMBERS = {
    "overload": "OVERLOAD",
    "formula": "=A1+2",
    "true": "TRUE",
    "underscore": "2_0.5",
    "thousands": "1,234.5",
    "decimal comma": "20,5",
    "unit": "20.5 degC",
    "other digits": "\u0663\u0660",
}
ENDLESS = {"beyond a double": "1e400", "infinite": "inf"}
SOME = {name: NO_NUMBERS[name] for name in ("overload", "true", "decimal comma")}
REFUSED = {
    **{f"a cell: {k}": (cell("T_flange", 10, v), "line 12 | T_flange | not a number") for k, v in NO_NUMBERS.items()},
    **{f"a cell: {k}": (cell("T_flange", 10, v), "line 12 | T_flange | infinite") for k, v in ENDLESS.items()},
    **{f"a time: {k}": (cell("time_s", 10, v), "line 12 | time_s | test new") for k, v in SOME.items()},
    **{f"a current: {k}": (cell("current", 10, v), "line 12 | current") for k, v in SOME.items()},
    "times in words": (
        lambda case: changed(case, "stand", lambda t: t.__setitem__("time_s", instants(t).time_s)),
        "line 2 | time_s | test new",
    ),
    "a trailer": (lines(lambda rows: [*rows, "# end"]), "line 302 | cut off"),
    "a line of commas": (lines(lambda rows: [*rows, ",,,,,,"]), "line 302 | a time is missing"),
    "a value too many": (lines(lambda rows: [*rows[:50], f"{rows[50]},7", *rows[51:]]), "line 51 | 8 values"),
    "no header": (lines(lambda rows: rows[1:]), "stands twice in the header"),
    "one row": (lines(lambda rows: rows[:2]), "1 rows | at least 3"),
    "a quotation without end": (text(lambda t: t.replace("20.0", '"20.0', 1)), "quotation marks in pairs"),
    "tabs": (text(lambda t: t.replace(",", "\t")), "separated by tabs"),
    "line ends of old": (text(lambda t: t.replace("\n", "\r")), "CR alone"),
    "a header in other letters": (text(lambda t: t.replace("T_flange", "t_flange", 1)), "did you mean 't_flange'"),
    "a column without a name": (text(lambda t: t.replace("wind", "", 1)), "'wind' is not in the file"),
    "a header with an escape code": (text(lambda t: t.replace("T_flange", "\x1b[31mT", 1)), "\\x1b[31mT"),
    "a link to nowhere": (link, "leads nowhere"),
    "a gzip with a tail": (packed(lambda c: gzip.compress(c) + b"junk"), "not readable as gzip"),
    "a gzip of commas": (packed(lambda c: gzip.compress(b"," * 10**5)), "100,001 columns | at most"),
    "an old workbook": (other("xls", b"\xd0\xcf\x11\xe0" + bytes(500)), "found there | stand.xls"),
    "a workbook that is a letter": (document, "stand.xlsx | Excel"),
    "an empty workbook": (excel(lambda t: t.iloc[:0]), "0 rows"),
    "a workbook with an error": (excel(lambda t: t.assign(T_flange=["#BUSY!", *t.T_flange[1:]])), "line 2 | #BUSY!"),
    "a Parquet cut off": (other("parquet", b"PAR1" + bytes(90)), "stand.parquet | really Parquet"),
    "lists in a Parquet": (parquet(lambda t: t.assign(T_flange=[[1, 2]] * len(t))), "T_flange | not a number"),
    "true and false as a current": (parquet(lambda t: t.assign(current=True)), "current | true and false"),
    "instants as a temperature": (parquet(lambda t: t.assign(T_flange=instants(t).time_s)), "T_flange | instants"),
    "times too coarse": (parquet(lambda t: t.assign(time_s=(t.time_s + 1.7e9).astype("float32"))), "given twice"),
    "a TDMS of noise": (other("tdms", b"TDSm" + bytes(500)), "stand.tdms"),
    "an MF4 of noise": (other("mf4", b"MDF     4.10" + bytes(500)), "stand.mf4"),
    "a worksheet of a CSV": (worksheet, "stand.csv | no worksheets"),
    "a worksheet that is not there": (lambda case: (excel()(case), worksheet(case)), "no worksheet 'data' | Sheet1"),
    "nothing but a code": (
        lambda case: changed(case, "stand", lambda t: t.__setitem__("T_flange", -127.0)),
        "T_flange | holds no number",
    ),
}


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    return compare(load_case(case_of(tmp_path_factory.mktemp("plain"))).case).rmse_K


@pytest.mark.parametrize(("spoil", "words"), REFUSED.values(), ids=REFUSED)
def test_refused_in_one_line_with_its_place(tmp_path, spoil, words):
    case = case_of(tmp_path)
    spoil(case)
    message = refusal(tmp_path, "test", "compare", case)
    assert "tests" + os.sep + "stand" in message
    assert [word for word in words.split(" | ") if word not in message] == []


SAME = {
    "a workbook": excel(),
    "a line of units": lines(lambda rows: [rows[0], ",".join(["s", *UNITS]), *rows[1:]]),
    "a preamble": lines(lambda rows: ["# logger 3", "Started,2026-03-28", "", *rows]),
    "numbers in words": excel(lambda t: t.astype(str)),
    "instants in Excel": excel(instants),
    "a Parquet": parquet(index=False),
    "a Parquet of instants": parquet(instants),
    "a Parquet of spans": parquet(lambda t: t.assign(time_s=pd.to_timedelta(t.time_s, unit="s"))),
    "times as the index": parquet(lambda t: t.set_index("time_s")),
    "a gzip in pieces": packed(lambda c: gzip.compress(c[:500]) + gzip.compress(c[500:])),
    "an ending in capitals": lambda case: (case / STAND).rename(case / "tests/stand.CSV"),
    "empty lines": lines(lambda rows: [*rows, "", "", ""]),
    "times of the day": lambda case: changed(case, "stand", lambda t: t.__setitem__("time_s", t.time_s + 1.7e9)),
}


@pytest.mark.parametrize("change", SAME.values(), ids=SAME)
def test_read_as_its_plain_file_is(tmp_path, plain, change):
    case = case_of(tmp_path)
    change(case)
    assert compare(load_case(case).case).rmse_K == pytest.approx(plain, abs=1e-6)


def test_a_unit_that_the_file_says_and_the_sheet_does_not_is_said(tmp_path):
    case = case_of(tmp_path)
    lines(lambda rows: [rows[0], "s,A,m/s,degC,degC,K,degC", *rows[1:]])(case)
    (note,) = [note for note in load_case(case).notes if "its file says" in note]
    assert note == "stand.csv column 'wind': its file says m/s; km/h is taken, as the sheet says"


def test_an_empty_cell_is_a_missing_reading_with_its_line(tmp_path):
    case = case_of(tmp_path)
    for row, value in enumerate(["", "   ", "NaN", "#N/A", "null"]):
        cell("T_flange", 10 + row, value)(case)
    code, _, err = answered("test", "compare", case)
    assert code == 1
    assert "5 missing readings, first in line 12" in err
    assert np.isfinite(compare(load_case(case).case).rmse_K)
