"""What must not move the odds: a test cut in two, the order of the tests, and half of the samples left out."""

from dataclasses import replace

import numpy as np
import pytest
from two_bodies import bench

from validation import diagnose
from validation.case import Case, Test


def cut(test: Test, at: int) -> tuple[Test, Test]:
    """A test as two; the later half begins at what the thermometers read."""

    def part(name: str, some: slice) -> Test:
        own = tuple(replace(c, y=c.y[some]) for c in test.channels)
        inputs = {n: u[some] for n, u in test.inputs.items()}
        around = {n: u[some] for n, u in test.boundaries.items()}
        return replace(test, name=name, time=test.time[some], inputs=inputs, boundaries=around, channels=own)

    later = part(f"{test.name} later", slice(at, None))
    start = {c.place: float(c.y[0]) for c in later.channels}
    return part(test.name, slice(0, at)), replace(later, initial=start)


def leading(case: Case) -> tuple[tuple[str, ...], float]:
    best = diagnose(case, plan=False).odds[0]
    return best.effects, best.probability


@pytest.mark.parametrize("lid", [True, False])
def test_a_test_cut_in_two_gives_the_same_odds(lid):
    whole = bench() if lid else bench(())
    *others, last = whole.tests
    effects, p = leading(whole)
    assert [e.split(" in ")[0] for e in effects] == (["convection.constant@body"] if lid else [])
    again, q = leading(replace(whole, tests=(*others, *cut(last, 150))))
    assert again == effects
    assert q == pytest.approx(p, abs=0.1)


def test_the_order_of_the_tests_gives_the_same_odds():
    whole = bench()
    turned = replace(whole, tests=tuple(whole.tests[i] for i in np.random.default_rng(3).permutation(3)))
    (effects, p), (again, q) = leading(whole), leading(turned)
    assert again == effects
    assert q == pytest.approx(p, abs=0.01)


def test_every_second_sample_leads_to_the_same_effect():
    whole = bench()

    def thinned(test: Test) -> Test:
        channels = tuple(replace(c, y=c.y[::2]) for c in test.channels)
        inputs = {n: u[::2] for n, u in test.inputs.items()}
        around = {n: u[::2] for n, u in test.boundaries.items()}
        return replace(test, time=test.time[::2], inputs=inputs, boundaries=around, channels=channels)

    (effects, p), (again, q) = leading(whole), leading(replace(whole, tests=tuple(map(thinned, whole.tests))))
    assert again == effects
    assert q == pytest.approx(p, abs=0.1)
