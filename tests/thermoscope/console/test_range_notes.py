"""At the command line what lies outside a range is a note, once; other warnings are shown as ever."""

import warnings

import pytest

from lumped.transfer.ranges import out_of_range
from thermoscope.console.terminal import ranges_as_notes


def test_a_range_that_is_left_is_one_note(capsys):
    with ranges_as_notes():
        for number in (400.3, 410.0, 400.3):
            out_of_range(f"loss map: current_A = {number:g} outside 0 to 400")
    assert capsys.readouterr().err == "note: loss map: current_A = 400.3 outside 0 to 400\n"


def test_other_warnings_are_shown_as_ever(capsys):
    with pytest.warns(RuntimeWarning, match="a library says so"), ranges_as_notes():
        warnings.warn("a library says so", RuntimeWarning, stacklevel=1)
    assert capsys.readouterr().err == ""
