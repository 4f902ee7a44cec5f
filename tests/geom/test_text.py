"""Tables as text, and numbers of things."""

from geom.text import counted, table


def test_words_stand_left_and_numbers_right():
    lines = table(["part", "degC"], [["winding", 123.4], ["shaft", 7.0]]).splitlines()
    assert lines == ["part     degC", "winding   123", "shaft       7"]


def test_the_numbers_of_a_column_have_the_same_decimals():
    lines = table(["test", "rms (K)"], [["a", 4.756], ["b", 0.6572]]).splitlines()
    assert [line.split()[-1] for line in lines[1:]] == ["4.76", "0.66"]


def test_whole_numbers_have_none():
    assert table(["n"], [[3], [12]]).splitlines() == [" n", " 3", "12"]


def test_a_table_without_rows_is_its_headers():
    assert table(["test", "role"], []) == "test  role"


def test_one_thing_is_singular():
    assert [counted(n, "test") for n in (0, 1, 2)] == ["0 tests", "1 test", "2 tests"]
