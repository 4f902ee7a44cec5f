"""A bench with a fan, a lid, less air, or a sensor that slipped off or sat elsewhere is drawn, diagnosed and judged."""

import numpy as np
import pytest
from drawn import drawn_benches as bench
from steadiness import thinned_case

from validation.revision.improvement import Supervisor, improve, singletons


@pytest.mark.parametrize(
    ("kind", "seed"), [("fan", 3), ("lid", 3), ("lid", 7), ("lid", 63), ("probe", 2), ("starved", 3), ("loose", 3)]
)
def test_what_was_drawn_is_found(kind, seed):
    assert bench.KINDS[kind](np.random.default_rng(seed)) == "right"


def test_what_is_added_does_not_hang_on_the_number_of_rows():
    case, which, _ = bench.blocked_case(np.random.default_rng(101))
    for rows in (case, thinned_case(case, 2, "instants")):
        done = improve(rows, Supervisor(singletons, suggest=True))
        assert [e.name for e in done.case.model.effects][:2] == ["convection.fan@shell", f"blockage@shell in {which}"]
