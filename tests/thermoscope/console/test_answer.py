"""The answer first: a sentence, at most 25 lines of at most 80 columns, then where the rest is; no number is broken."""

import ast

import pytest
from hypothesis import given, settings, strategies as st
from small_case import small_case

from geom.table import Table
from thermoscope.console import summary
from thermoscope.console.summary import LINES, Summary, folded, lay_out
from thermoscope.console.terminal import notes, notes_once

WORDS = st.text("abcdefgh ", min_size=1, max_size=60).map(str.strip).filter(bool)
CELLS = st.one_of(WORDS, st.floats(-1e6, 1e6), st.integers(-(10**6), 10**6), st.none())


@st.composite
def grids(draw):
    n = draw(st.integers(1, 12))
    headers = [f"h{i} {draw(WORDS)[:12]}" for i in range(n)]
    rows = draw(st.lists(st.lists(CELLS, min_size=n, max_size=n), max_size=60))
    return Table(draw(WORDS), headers, rows, keep=headers[: n // 2])


ANSWERS = st.builds(Summary, WORDS, st.lists(st.one_of(grids(), WORDS.map(lambda w: f"{w} " * 9)), max_size=6), WORDS)


def after_the_sentence(answer, width, most):
    lines = [line for line, _ in lay_out(answer, width, most)]
    head = folded(answer.sentence, width)
    assert lines[: len(head)] == head
    return lines[len(head) :]


@settings(deadline=None)  # a shared computer may be slow
@given(ANSWERS)
def test_what_follows_the_sentence_fits_on_a_screen(answer):
    lines = after_the_sentence(answer, 80, LINES)
    assert len(lines) <= LINES
    assert lines[-1].endswith(folded(answer.more, 80)[-1])


def test_wide_tables_lose_columns_by_priority_and_no_number():
    headers = ["sensor", "test", "a", "b", "c", "verdict"]
    rows = [["T_winding", "a long name of a test", 1234.5678, -0.000123456, 98765.4321, "over"]] * 3
    table = Table("", headers, rows, keep=["verdict", "a"])
    wide, small = (after_the_sentence(Summary("x", [table]), width, LINES) for width in (80, 36))
    assert wide[0].split() == headers
    assert small[0].split() == ["sensor", "a", "verdict"]
    assert small[1].split() == ["T_winding", "1235", "over"]
    assert max(map(len, small)) <= 36


@settings(deadline=None)
@given(st.lists(st.floats(-1e9, 1e9), min_size=2, max_size=9), st.integers(20, 80))
def test_a_number_is_shown_whole_or_not_at_all(values, width):
    headers = [f"column {i}" for i in range(len(values))]
    head, body = after_the_sentence(Summary("x", [Table("", ["name", *headers], [["w", *values]])]), width, LINES)
    assert "…" not in body
    assert len(body.split()) - 1 == head.count("column")


def test_rows_that_do_not_fit_are_counted_and_all_shows_them():
    answer = Summary("many", [Table("t", ["n"], [[i] for i in range(100)])], "report")
    lines = after_the_sentence(answer, 80, LINES)
    assert lines[-2:] == ["  ... and 79 more", "More: --all; report"]
    assert len(after_the_sentence(answer, 80, None)) == 103


def test_commands_print_through_answers_alone(root):
    """None of them prints by itself, so that the rule above holds for each; a question is on stderr."""
    for file in (root / "thermoscope/commands").rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("print", "table"):
                assert any(k.arg == "file" for k in node.keywords), f"{file.name} line {node.lineno}"


CHEAP = [
    "test compare CASE",
    "test doctor CASE",
    "explain effects CASE",
    "model machines",
    "use simulate CASE",
    "model calibrate CASE",
    "check",
    "compare CASE --all",
]


@pytest.fixture(scope="module")
def three(tmp_path_factory):
    return small_case(tmp_path_factory.mktemp("three"))


@pytest.mark.parametrize("words", CHEAP)
def test_every_command_at_80_columns(thermoscope, three, words, monkeypatch, tmp_path):
    """At most two lines of sentence, no line wider than the terminal but for a path; --all is longer."""
    monkeypatch.setenv("COLUMNS", "80")
    done = thermoscope(*(three if w == "CASE" else w for w in words.split()), cwd=tmp_path)
    lines = done.out.splitlines()
    assert done.code in (0, 1)
    if "--all" in words:
        assert len(lines) > LINES
        return
    assert 1 <= len(lines) <= LINES + 2
    assert [line for line in lines if len(line) > 80 and "/" not in line] == []


def test_commands_in_a_row_say_each_note_once(capsys):
    notes(["a"])
    with notes_once():
        notes(["a", "b"])
        notes(["b", "a", "c"])
    notes(["a"])
    assert capsys.readouterr().err.split() == ["note:", "a", "note:", "a", "note:", "b", "note:", "c", "note:", "a"]


def test_a_table_of_thousands_of_rows_is_laid_out_a_few_times(monkeypatch):
    """Row by row it took most of a minute to shorten 1600 rows to twenty."""
    usual, calls = summary.grid, []
    monkeypatch.setattr(summary, "grid", lambda *given: calls.append(1) or usual(*given))
    table = Table("", ["sensor", "rms (K)"], [[f"T{i}", 1.0 * i] for i in range(5000)])
    lines = lay_out(Summary("All.", [table], "more"), 80, 20)
    assert len(calls) < 10
    assert len(lines) == 21
    assert "and 4983 more" in lines[-2][0]


def test_names_that_begin_with_a_digit_are_broken_and_never_cut_and_numbers_are_neither():
    words = [f"{k} winding of the motor under test, end {k}" for k in (101, 102)]
    table = Table("t", ["sensor", "size", "where it is"], [[w, "17.3 (9.28 ... 25.3) W/m2/K", w] for w in words])
    text = summary.grid(table, table.rows, 80)
    assert max(len(line) for line, _ in text) <= 80
    assert sum("17.3 (9.28 ... 25.3) W/m2/K" in line for line, _ in text) == 2
    names = " ".join(line[: line.index("  ") if "  " in line else None] for line, _ in text[2:])
    assert " ".join(names.split()) == " ".join(words)
