"""Which of two effects that explain the readings is the one: what each still adds beside the other."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from playground import Truth, wind
from validation.evidence import calibrated_case, scored
from validation.rivals import GAP, Race, each_beside, needed, race, sorted_out

from validation import rivals
from validation.effects import effect

WIND, STILL = "convection@flange.right", "convection.constant@flange.right"
FITS = {0: SimpleNamespace(objective=100.0), 1: SimpleNamespace(objective=103.0), 2: SimpleNamespace(objective=300.0)}


@cache
def raced():
    case = Truth(10, wind("flange.right", 12.0)).case()
    evidence = scored(case, [effect(WIND), effect(STILL)], calibrated_case(case))
    return evidence, race(evidence, np.ones(2), 0.0)


def test_the_true_one_adds_beside_the_other_and_not_the_other_beside_it():
    """Films by road wind and by still air at one place, all tests together."""
    evidence, found = raced()
    fits = dict(zip(found.index, found.fits, strict=True))
    of_wind, of_still = each_beside(evidence, fits, 0, 1, found.noise, np.ones(2))
    assert of_wind > GAP > of_still


def test_neither_adds_less_than_nothing():
    evidence, found = raced()
    fits = dict(zip(found.index, found.fits, strict=True))
    assert min(each_beside(evidence, fits, 0, 1, found.noise, np.ones(2))) > -1.0  # what a fit leaves undone


def test_a_small_prior_does_not_hold_a_large_effect_back():
    """Fifteen of its own prior deviations: as large as with a prior as wide as the effect, and as far ahead."""
    evidence, found = raced()
    small = [replace(p, prior_sd=0.8) for p in evidence.parameters]
    held = race(replace(evidence, parameters=tuple(small)), np.ones(2), 0.0)
    assert held.fit(0).values[WIND] == pytest.approx(found.fit(0).values[WIND], rel=0.05)
    assert held.gap[1] == pytest.approx(found.gap[1], rel=0.2)


def told(monkeypatch, beside):
    """Leader and its distances, where each pair has been fitted side by side with these gains."""

    def gains(evidence, fits, one, other, noise, kappa):
        return beside[one, other] if (one, other) in beside else beside[other, one][::-1]

    monkeypatch.setattr(rivals, "each_beside", gains)
    return sorted_out(None, FITS, (0, 1, 2), 0, None, np.ones(3))


@pytest.mark.parametrize(
    ("gains", "leader", "alike"),
    [
        ((0.5, 1.0), 0, {0, 1}),  # neither beside the other
        ((30.0, 1.0), 0, {0}),  # the leader beside its rival
        ((1.0, 30.0), 1, {1}),  # the rival beside the leader, which only fitted best
        ((30.0, 30.0), 0, {0, 1}),  # both are wanted: told apart by no more than before
    ],
)
def test_who_leads_and_who_is_alike(monkeypatch, gains, leader, alike):
    """Candidate 2 is far behind and never asked; 1 is 6 behind alone."""
    found, gap = told(monkeypatch, {(0, 1): gains})
    assert found == leader
    assert {k for k, g in gap.items() if g < GAP} == alike


@pytest.mark.parametrize(
    ("leader", "size", "rival", "kept"),
    [
        ("sensor.gain@flange.right", -0.5, STILL, True),  # half the rise: no thermometer does that
        ("sensor.gain@flange.right", -0.1, STILL, False),  # ten percent: some do
        ("sensor.gain@flange.right", -0.5, "sensor.bias@flange.right", False),  # both are faults
        (WIND, 500.0, STILL, False),  # physics
    ],
)
def test_physics_is_not_dismissed_for_a_fault_that_would_be_unusual(leader, size, rival, kept):
    """One that explains the readings worse by a deviance of 14."""
    best, other = effect(leader), effect(rival)
    limit = tuple(needed(best, SimpleNamespace(values={leader: size}), e) for e in (best, other))
    assert (1 in Race((0, 1), (FITS[0], FITS[1]), (0.0, 14.0), limit, None).group) == kept
