"""A further sensor that is said to tell rivals apart does so when it is there; where none would, none is said to."""

from functools import cache

import numpy as np
import pytest
from playground import SENSORS, Truth, network
from validation.apart import DECISIVE, separation
from validation.evidence import calibrated_case, scored
from validation.rivals import race
from validation.sensors import access, free_places, next_sensors, with_sensors

from validation.case import Case, Model
from validation.effects import effect

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
    return {s.place: s for s in next_sensors(evidence, found, np.full(2, kappa))}


def test_without_a_sensor_on_either_they_cannot_be_told_apart():
    assert len(raced()[1].group) == 2


def test_every_free_place_is_ranked_by_gain_per_hour():
    evidence = raced()[0]
    assert set(said()) == {p.name for p in free_places(network(), evidence.tests)}
    worth = [s.predicted_gain / s.hours for s in said().values()]
    assert worth == sorted(worth, reverse=True)


def test_a_sensor_on_one_of_the_two_is_said_to_decide():
    best = max(said().values(), key=lambda s: s.predicted_gain)
    assert best.place in PLACES
    assert best.predicted_gain > DECISIVE


def test_a_further_sensor_never_takes_separation_away():
    """In the tangents: with it, every pair is at least as far apart as without."""
    evidence, found = raced()
    size = np.array([found.fit(k).values[name] for k, name in enumerate(evidence.names)])
    now = min(size**2 * np.diag(evidence.score.V)) * (1.0 - evidence.score.cosine[0, 1] ** 2)
    places = free_places(network(), evidence.tests)
    more = [gram for _, gram in with_sensors(evidence, places, found.group)]
    with_one = [separation(evidence, found, gram, np.ones(2)) for gram in more]
    assert len(with_one) == len(places)
    assert all(gap >= now * (1 - 1e-9) for gaps in with_one for gap in gaps.values())


def test_mounted_it_decides():
    best = max(PLACES, key=lambda place: said()[place].predicted_gain)
    evidence, found = raced(best)
    assert [evidence.names[k] for k in found.group] == ["loss.constant@winding.armature"]


def test_against_a_larger_error_of_the_model_a_sensor_promises_less():
    assert all(said(4.0)[place].predicted_gain < s.predicted_gain for place, s in said().items() if s.predicted_gain)


@pytest.mark.parametrize("place", ["shaft", "rotor", "commutator"])
def test_what_turns_costs_most(place):
    assert access(network(), network().places[place]) == "turning"
