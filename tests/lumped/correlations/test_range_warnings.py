"""What lies outside a range is said, in every thread that is not told to be silent."""

import threading
import warnings

import pytest

from lumped.correlations import RangeWarning
from lumped.transfer.ranges import Domain, out_of_range, within_silence


def test_silence_ends_with_its_block():
    with within_silence(), warnings.catch_warnings():
        warnings.simplefilter("error")
        out_of_range("Re = 5 outside 10 to 20")
    with pytest.warns(RangeWarning, match="Re = 5 outside 10 to 20"):
        out_of_range("Re = 5 outside 10 to 20")


def test_silence_within_silence_lasts():
    with within_silence(), warnings.catch_warnings():
        warnings.simplefilter("error")
        with within_silence():
            out_of_range("Re = 5 outside 10 to 20")
        out_of_range("Re = 5 outside 10 to 20")


def test_one_silent_thread_silences_no_other():
    inside, done = threading.Event(), threading.Event()

    def silent():
        with within_silence():
            inside.set()
            done.wait(10)

    other = threading.Thread(target=silent)
    other.start()
    assert inside.wait(10)
    try:
        with pytest.warns(RangeWarning, match="v = 30"):
            out_of_range("v = 30 outside 0 to 20")
    finally:
        done.set()
        other.join()


def test_limits_go_between_temperatures_as_viscosities_do():
    """A thousandth and one, 20 K apart: their geometric mean half way; from nothing there is a straight line."""
    domain = Domain("a film", (-20.0, 0.0), (1e-3, 1.0), (4.0, 9.0))
    assert domain.ends(-10.0) == (pytest.approx(1e-3**0.5), pytest.approx(6.0))
    assert Domain("a film", (0.0, 20.0), (0.0, 1.0), (4.0, 9.0)).ends(10.0)[0] == pytest.approx(0.5)
