"""A further sensor that is said to tell rivals apart does so when it is there; where none would, none is said to."""

from functools import cache

import numpy as np
import pytest
from playground import SENSORS, Truth, network

from validation.apart import DECISIVE
from validation.case import Case, Model
from validation.effects import effect
from validation.evidence import calibrated_case, scored
from validation.rivals import race
from validation.sensors import access, free_places, next_sensors

PLACES = ("winding.armature", "rotor")
RIVALS = tuple(f"loss.constant@{place}" for place in PLACES)


def heated(T, u, t):
    return {"winding.armature": 800.0}


@cache
def raced(*more):
    """Heat in the armature's winding, or in the iron around it? more: places of further sensors."""
    tests = Truth(10, heated, sensors=(*SENSORS, *more)).case().tests[:2]
    case = Case("heated", Model(network()), tests)
    evidence = scored(case, [effect(name) for name in RIVALS], calibrated_case(case))
    return evidence, race(evidence, np.ones(2), 0.0)


@cache
def said(kappa=1.0):
    evidence, found = raced()
    amplitude = {k: fit.values[RIVALS[k]] for k, fit in zip(found.index, found.fits, strict=True)}
    return {s.place: s for s in next_sensors(evidence, found, amplitude, np.full(2, kappa))}


def test_without_a_sensor_on_either_they_cannot_be_told_apart():
    assert len(raced()[1].group) == 2


def test_every_free_place_is_ranked_by_gain_per_hour():
    evidence = raced()[0]
    assert set(said()) == {p.name for p in free_places(network(), evidence.tests)}
    worth = [s.predicted_gain / s.hours for s in said().values()]
    assert worth == sorted(worth, reverse=True)


def test_a_sensor_on_one_of_the_two_is_said_to_decide():
    assert max(said()[place].predicted_gain for place in PLACES) > DECISIVE


def test_mounted_it_decides():
    best = max(PLACES, key=lambda place: said()[place].predicted_gain)
    evidence, found = raced(best)
    assert [evidence.names[k] for k in found.group] == ["loss.constant@winding.armature"]


def test_against_a_larger_error_of_the_model_a_sensor_promises_less():
    assert all(said(4.0)[place].predicted_gain < s.predicted_gain for place, s in said().items() if s.predicted_gain)


@pytest.mark.parametrize("place", ["shaft", "rotor", "commutator"])
def test_what_turns_costs_most(place):
    assert access(network(), network().places[place]) == "turning"
