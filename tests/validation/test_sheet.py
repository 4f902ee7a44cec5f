"""Residuals of long records: made in portions of tangents, the same numbers in bounded memory."""

import numpy as np
import pytest
from one_body import FILM, LOSS, MASS, measured, one_node

from validation import sheet


@pytest.mark.parametrize("numbers", [1, 2 * 200, 10**6])
def test_portions_change_nothing(numbers, monkeypatch):
    """One, two or all tangents at a time."""
    (whole,) = sheet.segments(one_node(LOSS, FILM, MASS), [measured()], {}, (LOSS, FILM, MASS))
    monkeypatch.setattr(sheet, "NUMBERS", numbers)
    (part,) = sheet.segments(one_node(LOSS, FILM, MASS), [measured()], {}, (LOSS, FILM, MASS))
    np.testing.assert_array_equal(part.J, whole.J)
    np.testing.assert_array_equal(part.r, whole.r)
    np.testing.assert_array_equal(part.time, whole.time)


def test_portions_of_a_million_samples_fit_into_memory():
    """12 channels: two tangents of a million samples at a time, 400 of a thousand all at once."""
    assert {len(p) for p in sheet.portions([FILM] * 8, 12 * 10**6)} == {2}
    assert [len(p) for p in sheet.portions([FILM] * 400, 12 * 10**3)] == [400]
    assert sheet.portions([], 10) == [()]
