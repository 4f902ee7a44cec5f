"""A network on which every effect of the catalogue finds a place: a declared motor with faces, streams and coolant."""

from dataclasses import replace
from functools import cache

import numpy as np
from playground import SENSORS, network, row, stand

from lumped.correlations.oil import sprayed_face
from lumped.correlations.streams import streamed
from lumped.model.network import NOTHING, Link, Place, Row
from lumped.transfer.coolant import ATF
from lumped.transfer.laws import Fixed
from measured.case import Channel, Test
from validation.effects import Scene


def machine():
    """The playground's motor with a coolant, a bench, an end space with its stream, and a flange that has faces."""
    base = network(feedback=False)
    n = len(base.states)
    boundaries = ("ambient", "coolant", "bench")
    base = replace(base, states=(*base.states, "air.right"), C=np.append(base.C, 60.0), boundaries=boundaries)
    base = replace(base, links=tuple(moved(x, n) for x in base.links), capacity_group=base.states)
    flange = np.array([base.column("flange.right")])

    def face(side, area, beside):
        name = f"flange.right.{side}"
        at = (flange, area * np.eye(1), np.array([area]), area, beside)
        return {name: Place(name, "surface", "flange.right", *at)}

    faces = face("outer", 0.2, "ambient") | face("inner", 0.1, "air.right")
    faces["air.right"] = Place("air.right", "fluid", "air.right", np.array([n]), np.eye(1), np.ones(1))
    base = replace(base, places={**base.places, **faces})
    coolant = base.surface_link("film:housing:jacket", "film", "housing", "coolant", Fixed(20.0))
    inner = base.surface_link("film:flange.right.inner", "film", "flange.right.inner", "air.right", Fixed(15.0))
    air = Row(np.array([n]), np.ones(1)), row(base.column("ambient"))
    at = np.array([n, n]), np.array([n, base.column("ambient")]), np.array([1.0, -1.0])
    stream = Link("stream:fan", "stream", ("ambient", "air.right"), *at, Fixed(30.0), *air)
    parts = ("winding.field", "yoke")
    wet = [base.surface_link(f"film:{part}:spray", "film", part, "coolant", spray()) for part in parts]
    return base.extended(links=[coolant, inner, stream, *(replace(x, hot=x.cold, cold=NOTHING) for x in wet)])


@cache
def spray():
    """Film of six nozzles at 4 l/min of ATF."""

    def film(flow, fluid):
        return sprayed_face(flow, 6, 0.002, 0.02, 0.06, fluid)

    return streamed(None, 4.0 / 6e4, film, ATF, 40.0, True, value=0.02)


def moved(link, n):
    """The link with its boundary column behind one state more."""

    def shift(index):
        return np.where(index >= n, index + 1, index)

    hot, cold = (Row(shift(r.index), r.weights) for r in (link.hot, link.cold))
    return replace(link, cols=shift(link.cols), hot=hot, cold=cold)


def scene(net):
    inputs = frozenset({"current_A", "speed_rpm", "vehicle_speed_mps", "switching_Hz", "time_s"})
    return Scene(net, inputs, SENSORS, ("warm",))


def warm_test(net):
    """Twenty minutes of heating with everything moving; channels at the sensors."""
    time = np.arange(0.0, 1200.0, 10.0)
    inputs = stand(200.0, 1000.0)(time, np.random.default_rng(0))
    inputs["vehicle_speed_mps"] = 5.0 + 5.0 * np.sin(time / 100.0)
    inputs["switching_Hz"] = np.where(time > 300.0, 8000.0, 0.0)
    boundaries = {b: np.full_like(time, t) for b, t in zip(net.boundaries, (20.0, 15.0, 18.0))}
    channels = tuple(Channel(s, s, row(net.column(s)), np.zeros_like(time), 0.5, 10.0) for s in SENSORS)
    return Test("warm", "calibrate", time, inputs, boundaries, channels, 25.0)
