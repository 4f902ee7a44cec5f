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

    rng = np.random.default_rng(seed)
    case_tests, net = [], two_bodies()
    open_lid = effect(f"convection.constant@body in {Event.of(dict(held)).name}") if held else None
    truth = open_lid.extend(net) if open_lid else net
    values = {truth.parameters[-1].name: size} if open_lid else {}
    for name in ("noon", "dawn", "dusk"):
        time = np.arange(0.0, 6000.0, 20.0)
        load = rng.uniform(0.2, 1.0, 6)[(time / 1000.0).astype(int)]
        around = {"ambient": np.full_like(time, 20.0)}
        test = Test(name, "calibrate", time, {"load": load}, around, (), 20.0)
        rows = [net.places[p].mean for p in ("body", "core")]
        y = simulate(truth, Record(time, test.signals, around, 20.0), values, rows).y
        y = y + 0.05 * rng.standard_normal(y.shape)
        channels = tuple(Channel(p, p, r, y[:, i], 0.3) for i, (p, r) in enumerate(zip(("body", "core"), rows)))
        case_tests.append(replace(test, channels=channels))
    return Case("bench", Model(net), tuple(case_tests))


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
