"""A small network that stands for a large one: exact where it is corrected, the same answers, its error known."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose
from playground import Truth, network, wind

from lumped.condensation.error_budget import ErrorBudget, PlaceError
from lumped.transfer.laws import Fixed
from measured.case import LowFidelity
from validation import add, diagnose
from validation.calibration.calibrate import WORTH
from validation.comparison.linearisation import segments
from validation.comparison.reading_correction import corrected
from validation.diagnosis import infer
from validation.effects import extended
from validation.inference.evidence import with_members
from validation.inference.hypotheses import Weighed
from validation.inference.low_fidelity import fidelity_error, low_fidelity_case
from validation.parameters.unknowns import working

pytestmark = pytest.mark.heavy
WIND = 16.0  # W/K at 10 m/s
OFF = 1.15  # of every joint: more than a network of half the shapes is off


def coarse():
    """The playground's network with joints 15 % too good and heat capacities 5 % too large."""
    made = network()
    links = tuple(replace(x, law=Fixed(OFF * x.law.value)) if x.kind == "contact" else x for x in made.links)
    return replace(made, links=links, C=1.05 * made.C)


@cache
def case(hidden=True):
    found = Truth(10, wind("flange.right", WIND) if hidden else None).case()
    rows = {(t.name, c.name): c.row for t in found.tests for c in t.channels}
    return replace(found, low=LowFidelity(found.model.network, coarse(), rows))


def test_residuals_are_those_of_the_large_network_where_it_is_corrected():
    given, values = case(), {"fan.flow": 1.2, "contact.housing|yoke": 0.8}
    small = corrected(given, values)
    large = segments(working(given)[0], given.tests, values)
    for own, other in zip(segments(working(small)[0], small.tests, values), large, strict=True):
        assert_allclose(own.r, other.r, atol=0.02)  # two runs of a fit's precision


def test_the_uncorrected_small_network_is_far_off():
    """Else the tests here show nothing."""
    given = case()
    large = segments(working(given)[0], given.tests, {})
    raw = segments(coarse(), given.tests, {})
    assert max(np.abs(a.r - b.r).max() for a, b in zip(raw, large, strict=True)) > 1.0


def test_a_hidden_effect_is_named_as_by_the_large_network():
    """Which `test_diagnose` asks; with the error of the small one in the budget that is printed."""
    small = diagnose(case(), plan=False)
    assert (small.verdict, small.named) == ("named", ("convection@flange.right",))
    assert small.candidates[0].ci95[0] < WIND * 1.2
    assert small.candidates[0].ci95[1] > WIND / 1.2
    assert small.small_network_K.keys() == {c.name for t in case().training().tests for c in t.channels}
    budget = ErrorBudget((PlaceError("flange", 0.1, 0.2, 0.01), PlaceError("air", None, None, 0.02)))
    sums = budget.with_condensation({"flange": 0.5, "air": 0.3}).total_K
    assert sums == pytest.approx({"flange": 0.81, "air": 0.32})


def test_an_effect_is_added_with_the_size_and_error_of_the_large_network():
    """Fits run on the small network, 15 % off; what they end with is the large one's."""
    large, small = (add(one, "convection@flange.right") for one in (replace(case(), low=None), case()))
    assert small.accepted
    assert large.accepted
    own, other = (next(p for p in step.parameters if p.name == "convection@flange.right") for step in (small, large))
    sd = (other.ci95[1] - other.ci95[0]) / (2 * 1.96)
    assert own.value == pytest.approx(other.value, abs=np.sqrt(2 * WORTH) * sd)  # where a fit has no more to gain
    for own, other in zip(small.tests, large.tests, strict=True):
        assert own.after == pytest.approx(other.after, abs=0.03), own.name
    own, other = (next(c.value for c in step.checks if c.check == "no change") for step in (small, large))
    assert own == pytest.approx(other, rel=0.1)


def test_nothing_hidden_is_adequate():
    assert diagnose(case(False), plan=False).verdict == "adequate"


@cache
def judged():
    """The case on its small network, corrected where its values stand, and what follows from the readings there."""
    small = low_fidelity_case(case())
    return small, infer(small.training())


def missed(posterior):
    """Channel -> how far (K) the small network is from the large one at the most probable hypothesis."""
    small, e, h = judged()[0], posterior.evidence, posterior.best
    values = {**with_members(e, h.members)[2], **(h.fit or e.fit).values}
    large = extended(working(case())[0], [e.effects[k] for k in h.members])
    own = extended(working(small)[0], [e.effects[k] for k in h.members])
    off = {}
    for a, b in zip(segments(large, case().training().tests, values), segments(own, e.tests, values), strict=True):
        off[a.channel] = max(off.get(a.channel, 0.0), float(np.abs(a.r - b.r).max()))
    return off


def test_the_error_of_the_small_network_is_what_it_misses_of_the_large_one():
    small, posterior = judged()
    off = missed(posterior)
    found = fidelity_error(case(), small, posterior)
    assert_allclose([found[c] for c in off], list(off.values()), atol=0.03)
    assert max(found.values()) < 0.5


@pytest.mark.parametrize(
    "moved",
    [
        {"contact.housing|yoke": 5.0},
        {"fan.flow": 0.3, "contact.housing|yoke": 0.2},
        {"fan.flow": 10.0, "contact.housing|yoke": 5.0},
    ],
    ids=lambda moved: " ".join(f"{name.partition('.')[0]} x{value:g}" for name, value in moved.items()),
)
def test_all_that_the_small_network_misses_is_in_the_budget_where_contacts_and_films_are_others(moved):
    """Contacts x0.2 to x5, films x0.3 to x10: it is worked out anew at the values that are found."""
    small, posterior = judged()
    e = posterior.evidence
    theta = e.fit.unknowns.coordinates({**e.fit.values, **moved})
    there = replace(posterior, evidence=replace(e, fit=replace(e.fit, theta=theta)), hypotheses=(Weighed(),))
    off = missed(there)
    found = fidelity_error(case(), small, there)
    assert_allclose([found[c] for c in off], list(off.values()), atol=0.03)
    assert max(found.values()) > 0.3  # K: no error of rounding


def test_a_sensor_that_the_small_network_does_not_know_leaves_the_large_one():
    given = case()
    fewer = dict(list(given.low.rows.items())[1:])
    assert low_fidelity_case(replace(given, low=replace(given.low, rows=fewer))).model.network is given.model.network


def test_another_network_than_it_was_made_for_leaves_that_one():
    given = case()
    other = replace(given, model=replace(given.model, network=network()))
    assert low_fidelity_case(other) is other


def test_a_channel_that_stands_still_is_told_although_its_readings_are_corrected():
    given = case(False)
    first, *rest = given.tests
    c = first.channels[0]
    stuck = replace(c, y=np.where(first.time > 1200.0, c.y[200], c.y))
    broken = replace(given, tests=(replace(first, channels=(stuck, *first.channels[1:])), *rest))
    assert "check the measurement first" in diagnose(broken, plan=False).words
