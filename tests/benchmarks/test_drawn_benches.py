"""A bench with a fan, a lid or a probe that sat elsewhere is drawn, diagnosed and judged."""

import numpy as np
import pytest
from drawn import drawn_benches as bench


@pytest.mark.parametrize(("kind", "seed"), [("fan", 3), ("lid", 3), ("probe", 2)])
def test_what_was_drawn_is_found(kind, seed):
    assert bench.KINDS[kind](np.random.default_rng(seed)) == "right"
