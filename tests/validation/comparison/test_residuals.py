"""Residuals of long records: looked at in stretches, the same numbers in bounded memory."""

import tracemalloc

import numpy as np
import pytest
from one_body import FILM, LOSS, MASS, measured, one_node

from measured.sensors.blocks import Blocks, groups
from validation.comparison import linearisation

FREE = (LOSS, FILM, MASS)


@pytest.mark.parametrize("samples", [2, 7, 199])
def test_stretches_change_nothing(samples, monkeypatch):
    (whole,) = linearisation.segments(one_node(*FREE), [measured()], {}, FREE)
    monkeypatch.setattr(linearisation, "stretch", lambda channels, tangents, numbers: samples)
    (part,) = linearisation.segments(one_node(*FREE), [measured()], {}, FREE)
    np.testing.assert_allclose(part.J, whole.J, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(part.r, whole.r, atol=1e-9)
    np.testing.assert_array_equal(part.time, whole.time)


def test_a_long_record_takes_no_more_memory_than_a_short_one():
    """Besides the record itself: 4 times as long, at most a quarter more."""

    def peak(samples):
        test = measured(samples=samples)
        linearisation.segments(one_node(*FREE), [test], {}, FREE, numbers=2**17)
        tracemalloc.start()
        linearisation.segments(one_node(*FREE), [test], {}, FREE, numbers=2**17)
        high = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return high

    assert peak(160_000) < 1.25 * peak(40_000)


def test_blocks_average_what_was_read():
    y = np.array([1.0, 3.0, np.nan, 5.0, np.nan, np.nan])
    for cut in ([6], [1, 6], [3, 4, 6]):
        blocks, first = Blocks(np.array([0, 2, 4]), 1), 0
        for stop in cut:
            part = y[first:stop, None]
            blocks.add(first, np.nan_to_num(part), np.isfinite(part[:, 0]).astype(float))
            first = stop
        np.testing.assert_allclose(blocks.means()[:, 0], [2.0, 5.0])


def test_a_million_samples_make_no_more_blocks_than_wanted():
    assert len(groups(1_000_000)) <= 180


def test_a_sensor_slower_than_the_inputs_keeps_all_that_it_reads():
    """One row of ten, blocks of three: no block is half read, and those that are read are alike."""
    y, read = np.arange(60.0), np.arange(60) % 10 == 0
    blocks = Blocks(np.arange(0, 60, 3), 1)
    blocks.add(0, y[:, None], read.astype(float))
    np.testing.assert_allclose(blocks.means()[:, 0], y[read])
