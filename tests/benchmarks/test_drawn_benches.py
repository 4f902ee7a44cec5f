"""What was drawn is found and judged: benches with a fault, laws of steady tests, pairs of equal and drifted tests."""

import numpy as np
import pytest
from drawn import drawn_benches as bench, repeated_tests, steady_laws
from steadiness import thinned_case

from validation.revision.improvement import Supervisor, improve, singletons


@pytest.mark.parametrize("kind", steady_laws.KINDS)
def test_drawn_laws(kind):
    """All of four; of tests that scatter one table in twenty may have a law by chance."""
    right = sum(steady_laws.judged(seed, kind)["right"] for seed in range(4))
    assert right >= (3 if kind == "scatter" else 4)


@pytest.mark.parametrize("kind", repeated_tests.DRIFTS)
def test_drawn_drifts(kind):
    """Of four pairs: with 5 % false alarms two or more come once in 70 seeds; a drift of five uncertainties is seen."""
    changed = sum(repeated_tests.pair(seed, kind).verdict == "changed" for seed in range(4))
    assert changed <= 1 if kind == "nothing" else changed == 4


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
