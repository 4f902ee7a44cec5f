"""What must not move the odds: a test cut in two, the order of the tests, and half of the samples left out."""

from dataclasses import replace

import numpy as np
import pytest
from two_bodies import bench

from measured.case import Case, Test
from validation import diagnose
from validation.effects import effect


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


@pytest.fixture(scope="module")
def whole():
    """The bench with its lid, and what its tests lead to as they are."""
    return bench(), *leading(bench())


@pytest.mark.parametrize("lid", [pytest.param(True, marks=pytest.mark.nightly), False])
def test_a_test_cut_in_two_gives_the_same_odds(request, lid):
    case, effects, p = request.getfixturevalue("whole") if lid else (bench(()), *leading(bench(())))
    *others, last = case.tests
    assert [e.split(" in ")[0] for e in effects] == (["convection.constant@body"] if lid else [])
    again, q = leading(replace(case, tests=(*others, *cut(last, 150))))
    assert again == effects
    assert q == pytest.approx(p, abs=0.1)


@pytest.mark.nightly
def test_the_order_of_the_tests_gives_the_same_odds(whole):
    case, effects, p = whole
    turned = replace(case, tests=tuple(case.tests[i] for i in np.random.default_rng(3).permutation(3)))
    again, q = leading(turned)
    assert again == effects
    assert q == pytest.approx(p, abs=0.01)


@pytest.mark.nightly
def test_every_second_sample_leads_to_the_same_effect(whole):
    case, effects, p = whole

    def thinned(test: Test) -> Test:
        channels = tuple(replace(c, y=c.y[::2]) for c in test.channels)
        inputs = {n: u[::2] for n, u in test.inputs.items()}
        around = {n: u[::2] for n, u in test.boundaries.items()}
        return replace(test, time=test.time[::2], inputs=inputs, boundaries=around, channels=channels)

    again, q = leading(replace(case, tests=tuple(map(thinned, case.tests))))
    (one,), (other,) = (tuple(effect(name) for name in names) for names in (effects, again))
    assert (one.base, one.tests) == (other.base, other.tests)
    np.testing.assert_allclose(other.event.every, one.event.every, atol=40.0)  # s, of a row
    assert q == pytest.approx(p, abs=0.1)
