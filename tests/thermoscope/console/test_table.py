"""One table for every medium: its rows come from records, and each medium shows the same cells."""

from dataclasses import dataclass

import pytest
from small_case import small_case

from geom.table import Table, cell, with_interval


@dataclass
class Error:
    name: str
    rmse_K: float


RECORDS = [Error("a", 1.0), {"name": "b", "rmse_K": {"before": 2.0}}, {"name": "c"}]


def test_records_are_objects_or_mappings_and_a_gap_is_none():
    table = Table.of("errors", RECORDS, "test=name | *rms (K)=rmse_K | *before=rmse_K.before | size", size=lambda r: 7)
    assert table.columns == ["test", "rms (K)", "before", "size"]
    assert table.keep == ["rms (K)", "before"]
    assert table.rows == [["a", 1.0, None, 7], ["b", {"before": 2.0}, 2.0, 7], ["c", None, None, 7]]


def test_the_page_and_the_terminal_show_the_same_words():
    from thermoscope.console.summary import Summary, lay_out
    from viz.pages import html

    table = Table("t", ["place", "verdict", "empty"], [["<yoke>", "over", ""]], ["over"])
    page, lines = html.table(table), [line for line, _ in lay_out(Summary("x", [table]), 80, 25)]
    assert "&lt;yoke&gt;" in page
    assert "class=strong" in page
    assert "empty" not in page
    assert lines[2].split() == ["place", "verdict"]
    assert lines[3].split() == ["<yoke>", "over"]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "-"),
        (float("nan"), "-"),
        (True, "yes"),
        (1234.5, "1234"),
        (0.00123, "0.00123"),
        (12.3456, "12.35"),
        (3, "3"),
    ],
)
def test_numbers_have_three_digits(value, text):
    assert cell(value) == text


def test_a_value_stands_with_its_interval():
    assert with_interval(1.0, -0.5, 2.51) == "1 (-0.5 ... 2.51)"
    assert with_interval(None, None, float("inf")) == "- (- ... -)"


def test_results_give_their_tables(tmp_path):
    import thermoscope as ts

    case = ts.open(small_case(tmp_path))
    tests, *sensors = case.compare().tables()
    assert {row[0] for row in tests.rows} == set(case.tests)
    assert {row[0] for table in sensors[: len(case.tests)] for row in table.rows} >= {"T_flange"}
    before_after, values = case.calibrate().steps[-1].tables()
    assert {row[0] for row in before_after.rows} == set(case.tests)
    assert all(row[3] <= row[1] <= row[4] for row in values.rows)


@pytest.mark.parametrize("width", [80, 60, 40])
def test_a_folded_column_is_wrapped_and_never_left_out(width):
    from thermoscope.console.summary import Summary, lay_out

    rows = [["PLC_PRG.rMotorCurrent", "current_A", "A", "no unit: A is assumed, and that is a guess"]]
    columns = ["column", "goes to", "unit", "doubt"]
    table = Table("", columns, rows, keep=columns, folded="doubt")
    lines = [line for line, _ in lay_out(Summary("x", [table]), width, 25)]
    assert max(map(len, lines)) <= width
    assert set(rows[0][3].split()) <= set(" ".join(lines).split())
