"""An event of the model in a held-out test: found again to the sample, told with and without, and not invented."""

from dataclasses import replace

import numpy as np
import pytest
from two_bodies import bench

from measured.case import AddedEffect
from validation.comparison.compare import errors
from validation.revision.repeated_events import repeated_events
from validation.revision.revise import add

NAME = "convection.constant@body in noon:2000-2600s"


def opened(held, size):
    """A model that has the lid of noon at its true size; dawn and dusk are held out."""
    case = bench(held, size)
    tests = tuple(replace(t, role="calibrate" if t.name == "noon" else "hold-out") for t in case.tests)
    effects = (AddedEffect(*NAME.split("@", 1)),)
    return replace(case, tests=tests, model=replace(case.model, effects=effects, values={NAME: size}))


@pytest.mark.parametrize("size", [3.0, 40.0])  # W/K; by the larger one the body comes down to the room
def test_the_lid_of_noon_is_found_at_dusk_as_often_as_it_was_open(size):
    spans = ((1500.0, 2060.0), (4000.0, 4660.0))
    case = opened((("noon", ((2000.0, 2600.0),)), ("dusk", spans)), size)
    (found,) = repeated_events(case)
    assert found.test == "dusk"
    assert np.array(found.event.spans["dusk"]) == pytest.approx(np.array(spans), abs=20.0)
    (before,) = [t.rmse_K for t in errors(case).tests if t.name == "dusk"]
    assert found.rmse_K == pytest.approx(before)
    assert found.elsewhere_K == pytest.approx(0.05, abs=0.05), "the noise of the readings"
    assert f"{before:.2f} K without it, and within {found.elsewhere_K:.2f} K with it" in found.sentence
    assert found.document()["spans"][0]["test"] == "dusk"


def test_none_is_found_where_there_was_none():
    assert not repeated_events(opened((("noon", ((2000.0, 2600.0),)),), 3.0))


def test_what_lasted_far_longer_is_another_event():
    """Cooled all afternoon: no stretch of ten minutes explains that."""
    assert not repeated_events(opened((("noon", ((2000.0, 2600.0),)), ("dusk", ((1000.0, 5000.0),))), 3.0))


def test_what_add_accepts_is_told_of_the_held_out_tests():
    case = opened((("noon", ((2000.0, 2600.0),)), ("dusk", ((4000.0, 4600.0),))), 3.0)
    tests = tuple(replace(t, role="calibrate") if t.name == "dawn" else t for t in case.tests)
    done = add(replace(case, tests=tests, model=replace(case.model, effects=(), values={})), NAME)
    assert done.accepted
    assert "extra cooling to ambient at body from 66.7 to 76.7 min of dusk: dusk is predicted within " in done.why
