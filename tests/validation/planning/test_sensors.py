"""A further sensor that is said to tell rivals apart does so when it is there; where none would, none is said to."""

from functools import cache

import numpy as np
import pytest
from playground import SENSORS, Truth, network

from measured.case import Case, Model
from validation.effects import effect
from validation.inference.evidence import calibrated_case, scored
from validation.inference.hypotheses import Weighed
from validation.inference.refit import laplace
from validation.planning.rivals import DECISIVE, GAP, CompetingModels, deviance_difference, separation
from validation.planning.sensors import access, free_places, next_sensors, with_sensors

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
    fits = tuple(laplace(evidence, Weighed((k,))).fit for k in (0, 1))
    return evidence, CompetingModels((0, 1), fits, evidence.fit.noise)


@cache
def said():
    evidence, found = raced()
    return {s.name: s for s in next_sensors(evidence, found)}


def test_without_a_sensor_on_either_they_cannot_be_told_apart():
    first, second = raced()[1].fits
    assert abs(deviance_difference(first, second)) < GAP


def test_every_free_place_is_ranked_by_gain_per_hour():
    evidence = raced()[0]
    assert set(said()) == {p.name for p in free_places(network(), evidence.tests)}
    worth = [s.predicted_gain / s.hours for s in said().values()]
    assert worth == sorted(worth, reverse=True)


def test_a_sensor_on_one_of_the_two_is_said_to_decide():
    best = max(said().values(), key=lambda s: s.predicted_gain)
    assert best.name in PLACES
    assert best.predicted_gain > DECISIVE


def test_a_further_sensor_never_takes_separation_away():
    """In the tangents: with it, every pair is at least as far apart as without."""
    evidence, found = raced()
    size = np.array([found.fit(k).values[name] for k, name in enumerate(evidence.names)])
    now = min(size**2 * np.diag(evidence.score.V)) * (1.0 - evidence.score.cosine[0, 1] ** 2)
    places = free_places(network(), evidence.tests)
    more = [gram for _, gram in with_sensors(evidence, places, found.group)]
    with_one = [separation(evidence, found, gram) for gram in more]
    assert len(with_one) == len(places)
    assert all(with_one)
    assert all(gap >= now * (1 - 1e-9) for gaps in with_one for gap in gaps.values())


def test_mounted_it_decides():
    best = max(PLACES, key=lambda place: said()[place].predicted_gain)
    _, found = raced(best)
    right, wrong = found.fits
    assert deviance_difference(wrong, right) > GAP


@pytest.mark.parametrize("place", ["shaft", "rotor", "commutator"])
def test_what_turns_costs_most(place):
    assert access(network(), network().places[place]) == "turning"


def test_where_every_place_has_a_sensor_none_is_proposed_and_nothing_is_run(monkeypatch):
    evidence, found = raced()
    monkeypatch.setattr("validation.planning.sensors.free_places", lambda *_: [])
    monkeypatch.setattr("validation.planning.sensors.with_sensors", None)
    assert next_sensors(evidence, found) == []
