"""Two bodies under a lid in three tests: a bench on which something may hold for a while."""

from dataclasses import replace
from functools import cache

import numpy as np

from lumped.integration.simulate import Record, simulate
from measured.case import Case, Channel, Model, Test
from validation.effects import effect
from validation.effects.time_window import Event

LID, OPEN = (2000.0, 2600.0), 3.0  # s, W/K


@cache
def bench(held=(("noon", (LID,)),), size=OPEN, seed=0):
    """Two bodies in three tests; while a lid is open one cools more."""
    lid = f"convection.constant@body in {Event.of(dict(held)).name}" if held else None
    return three_tests("bench", lid, size, seed, np.arange(0.0, 6000.0, 20.0), 1000.0, 6)


def three_tests(name, hidden, size, seed, time, level_s, levels):
    """Two bodies whose load has another of its levels every `level_s`.  hidden, size : an effect that is there"""
    rng, net, tests = np.random.default_rng(seed), two_bodies(), []
    truth = effect(hidden).extend(net) if hidden else net
    values, rows = {truth.parameters[-1].name: size} if hidden else {}, [net.places[p].mean for p in ("body", "core")]
    for day in ("noon", "dawn", "dusk"):
        load = rng.uniform(0.2, 1.0, levels)[(time / level_s).astype(int)]
        test = Test(day, "calibrate", time, {"load": load}, {"ambient": np.full_like(time, 20.0)}, (), 20.0)
        y = simulate(truth, Record(time, test.signals, test.boundaries, 20.0), values, rows).y
        y = y + 0.05 * rng.standard_normal(y.shape)
        channels = tuple(Channel(p, p, r, y[:, i], 0.3) for i, (p, r) in enumerate(zip(("body", "core"), rows)))
        tests.append(replace(test, channels=channels))
    return Case(name, Model(net), tuple(tests))


def two_bodies():
    from lumped.declarations.network import read_network

    load = {"input": "load", "at": 1.0, "exponent": 1.0}
    return read_network(
        {
            "network": {"name": "two", "boundaries": ["ambient"], "settles_s": 2000},
            "nodes": {"body": {"C_J_K": 4000, "prior_sd": 0.1}, "core": {"C_J_K": 1500, "prior_sd": 0.1}},
            "links": {
                "joint": {"between": ["body", "core"], "G_W_K": 4.0, "prior_sd": 0.3},
                "film": {"between": ["body", "ambient"], "G_W_K": 2.0, "prior_sd": 0.3},
            },
            "losses": {"heat": {"kind": "constant", "at": "core", "P_W": 80.0, "prior_sd": 0.1, "of": load}},
        }
    )
