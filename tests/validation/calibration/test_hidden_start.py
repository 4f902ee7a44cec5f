"""Where a body without a sensor began: a room that is read, walls that are not, two days of memory."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from lumped.integration.record import Record
from lumped.integration.simulate import simulate
from lumped.model.network import Link, Network, Parameter, Place, Row, Source
from lumped.transfer.laws import Fixed
from measured.case import Case, Channel, Model, Test
from validation.comparison.compare import errors
from validation.comparison.linearisation import segments
from validation.parameters.unknowns import hidden_starts, with_model, working
from validation.revision.revise import calibrate

BEGAN = {"one": 11.0, "two": 16.0}  # degC of the walls; the room begins at 20


def place(i):
    return Row(np.array([i]), np.ones(1))


@cache
def network():
    names = ("room", "walls", "air")
    ends = [("room", "walls", 250.0), ("room", "air", 40.0), ("walls", "air", 60.0)]
    links = []
    for a, b, G in ends:
        i, j = names.index(a), names.index(b)
        both = (np.array([i, i, j, j]), np.array([i, j, j, i])) if j < 2 else (np.array([i, i]), np.array([i, j]))
        weight = np.array([1.0, -1.0, 1.0, -1.0][: both[0].size])
        links.append(Link(f"{a}-{b}", "solid", (a, b), *both, weight, Fixed(G), place(i), place(j)))
    heat = Source("heat", "measured", "room", np.array([0]), np.ones(1), Fixed(1000.0), place(0))
    places = {n: Place(n, "node", n, np.array([i]), np.eye(2)[[i]], np.ones(1)) for i, n in enumerate(names[:2])}
    free = tuple(Parameter(x.name, ((x.name, 1.0),), prior_sd=0.3) for x in links)
    C = np.array([4e6, 3e7])
    return Network("house", names[:2], C, names[2:], tuple(links), (heat,), places, names[:2], free)


def measured(name, role="calibrate", begun=None, air=4.0, seed=0):
    time = 900.0 * np.arange(400)
    boundary = {"air": air + 4.0 * np.sin(2 * np.pi * time / 86400)}
    start = {"room": 20.0, "walls": BEGAN.get(name, 11.0) if begun is None else begun}
    y = simulate(network(), Record(time, {}, boundary, start), {}, [place(0)]).y[:, 0]
    y = y + 0.05 * np.random.default_rng(seed).standard_normal(y.size)
    return Test(name, role, time, {}, boundary, (Channel("T", "room", place(0), y, 0.2),), {"room": float(y[0])})


@cache
def case():
    return Case("house", Model(network()), tuple(measured(name) for name in BEGAN))


def test_the_start_of_the_walls_is_found_and_nothing_else_bends():
    done = calibrate(case())
    rows = {p.name: p for p in done.parameters}
    for name, began in BEGAN.items():
        assert rows[f"start of walls in {name}"].value == pytest.approx(began - 20.0, abs=0.6)
    assert all(rows[p.name].value == pytest.approx(1.0, abs=0.1) for p in network().parameters)
    assert all(t.after < 0.1 for t in done.tests), "compare begins there, too"
    assert all(t.before > 1.0 for t in done.tests)


def test_a_test_that_was_not_fitted_begins_as_those_did_on_average():
    """13.5 degC: nothing else is known of walls in the middle of a day."""
    model, average = calibrate(case()).model, float(np.mean(list(BEGAN.values())))
    further = replace(case(), tests=(*case().tests, measured("next", "hold-out", begun=average)))
    (error,) = [t for t in errors(with_model(further, model)).tests if t.name == "next"]
    assert error.rmse_K < 0.1


def test_at_rest_nothing_is_open():
    still = measured("still", begun=20.0, air=19.0)
    still = replace(still, boundaries={"air": np.full(400, 19.0)})
    assert hidden_starts(network(), still) == []
    assert [p.name for p in hidden_starts(network(), measured("one"))] == ["start of walls in one"]
    assert hidden_starts(network(), replace(measured("one"), initial={"room": 20.0, "walls": 12.0})) == []


def test_tangents_of_a_start_are_those_of_two_runs():
    whole, unknowns = working(case())
    name = "start of walls in one"
    k, (test, other) = unknowns.names.index(name), case().tests
    J = segments(whole, [test, other], {}, unknowns.parameters)
    up, down = (segments(whole, [test, other], {name: x}) for x in (0.5, -0.5))
    for s, a, b in zip(J, up, down, strict=True):
        assert s.J[:, k] == pytest.approx(b.r - a.r, abs=1e-3)
    assert np.max(np.abs(J[0].J[:, k])) > 0.5
    assert not J[1].J[:, k].any()
