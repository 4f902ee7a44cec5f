"""Tables as text, and numbers of things."""

from geom.text import table


def test_words_stand_left_and_numbers_right():
    lines = table(["part", "degC"], [["winding", 123.4], ["shaft", 7.0]]).splitlines()
    assert lines == ["part     degC", "winding   123", "shaft       7"]


def test_the_numbers_of_a_column_have_the_same_decimals():
    lines = table(["test", "rms (K)"], [["a", 4.756], ["b", 0.6572]]).splitlines()
    assert [line.split()[-1] for line in lines[1:]] == ["4.76", "0.66"]
