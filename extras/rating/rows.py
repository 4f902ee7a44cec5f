"""Rows of a rating's document: each load with its 95 % band, here and in other surroundings, beside the model before.

Surroundings are warmer, higher, with warmer or less coolant.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from extras.rating.envelope import TIMES, LimitError, Rating, rated
from extras.rating.operation import Operation, air_boundaries, at_altitude, coolant_boundaries, flows
from extras.rating.points import Model, hot_spots
from extras.rating.request import Rated
from thermoscope import InputError, Network, Record, plugin as th, simulate, steady

AMBIENTS = (-20.0, 0.0, 20.0, 40.0, 60.0)  # degC
ALTITUDES = (0.0, 1000.0, 2000.0, 4000.0)  # m: IEC 60034-1 rates to 1000 m
COOLANTS = (20.0, 40.0, 65.0, 80.0)  # degC
FLOWS = (0.5, 0.75, 1.0, 1.25)  # of the reference flow


@dataclass(frozen=True)
class Surroundings:
    """One thing about a machine's place that is not as at the reference.

    of : "ambient", "altitude", "coolant" or an input;  value : its degC, m or own unit;  op : the operating point there
    """

    of: str
    value: float
    unit: str
    op: Operation

    def network(self, network: Network) -> Network:
        """A network that is there."""
        return at_altitude(network, self.value) if self.of == "altitude" else network


@dataclass(frozen=True)
class Derated:
    """rating : the continuous one; None where the limit is exceeded without any load"""

    where: Surroundings
    rating: Rating | None

    @property
    def load(self) -> float:
        return 0.0 if self.rating is None else self.rating.load


def deratings(model: Model, op: Operation, limits: Mapping[str, float]) -> list[Derated]:
    """The continuous rating over each of them, the others at the reference."""
    return [Derated(s, _rated(model, s, limits)) for s in surroundings(model.network, op)]


def _rated(model: Model, s: Surroundings, limits: Mapping[str, float]) -> Rating | None:
    try:
        return rated(replace(model, network=s.network(model.network)), s.op, limits, "S1", None)
    except InputError:
        return None


def surroundings(network: Network, op: Operation) -> Iterator[Surroundings]:
    """All that a network of this kind feels: air, thin air, coolant, flows."""
    air, coolant = air_boundaries(network), coolant_boundaries(network)
    for T in AMBIENTS if air else ():
        yield Surroundings("ambient", T, "degC", op.moved(boundaries=dict.fromkeys(air, T)))
    for height in ALTITUDES if air else ():
        yield Surroundings("altitude", height, "m", op)
    for T in COOLANTS if coolant else ():
        yield Surroundings("coolant", T, "degC", op.moved(boundaries=dict.fromkeys(coolant, T)))
    for name in flows(network, op.inputs):
        for share in FLOWS:
            flow = share * op.inputs[name]
            yield Surroundings(name, flow, "as recorded", op.moved({name: flow}))


STEADY_TIME_CONSTANTS = 20.0  # time constants


def load_of(old: Rated, form: str, speed: float | None) -> float:
    """What an earlier model says of a form (load): 0 where it exceeds a limit without any."""
    try:
        return rated(old.model, old.op, old.limits, form, speed).load
    except LimitError:
        return 0.0


def point(
    folder: th.Folder, op: Operation, r: Rating, old: Rated | None, of: th.ParameterPosterior | None
) -> dict[str, Any]:
    """A point of the envelope as a rating has it."""
    rated_row = row(folder, op, r, None if old is None else load_of(old, r.form, r.speed), of)
    return {"form": r.form, "speed_rpm": r.speed, **{k: v for k, v in rated_row.items() if k != "form"}}


def derated(
    folder: th.Folder, it: Rated, old: Rated | None, load: float, of: th.ParameterPosterior | None
) -> list[dict[str, Any]]:
    """Shares of the continuous rating `load` in other surroundings; before: of the same, by the earlier model."""
    earlier = {}
    if old is not None:
        for d in deratings(old.model, old.op, old.limits):
            earlier[d.where.of, d.where.value] = d.load * old.op.inputs[old.op.main]
    whole, out = load * it.op.inputs[it.op.main], []
    for d in deratings(it.model, it.op, it.limits):
        there = None if of is None else replace(of, network=d.where.network(of.network))
        half = None if d.rating is None else _half_band(folder, d.where.op, d.rating, there)
        before = earlier.get((d.where.of, d.where.value))
        ci95 = None if half is None else [max(d.load - half, 0.0) / load, (d.load + half) / load]
        share = {"share": d.load / load, "share_ci95": ci95, "share_before": before and before / whole}
        out.append({"of": d.where.of, "value": d.where.value, "unit": d.where.unit, **share})
    return out


def row(
    folder: th.Folder, op: Operation, r: Rating, before: float | None, of: th.ParameterPosterior | None
) -> dict[str, Any]:
    """One rating."""
    main = op.inputs[op.main]
    half = _half_band(folder, op, r, of)
    ci95 = None if half is None else [(r.load - half) * main, (r.load + half) * main]
    change = None if not before or not np.isfinite(before) else 100.0 * (r.load / before - 1.0)
    was = None if before is None else before * main
    rating = {"form": r.form, "value": r.load * main, "ci95": ci95, "at": r.at}
    return {**rating, "before": was, "change_percent": change}


def _half_band(folder: th.Folder, op: Operation, r: Rating, of: th.ParameterPosterior | None) -> float | None:
    """Half the 95 % band of a load; none where bands are not wanted or no load reaches a limit.

    Duties take that of rest: their mean heat is what counts.
    """
    if of is None or not (np.isfinite(r.load) and r.slope > 0.0):
        return None
    network, bare = of.network, th.thermal(of.network)
    (spot,) = hot_spots(network, th.named_rows(network, folder), {r.at: 0.0})
    values = th.parameter_values(bare, of.values)
    if r.form == "S1":
        at = {n: float(u) for n, u in op.at(r.load, r.speed).items()}
        place_row = spot.hottest(steady(bare, at, op.boundaries, values).z)[1]
        return th.NORMAL_95 * th.AtRest(of, bare).sd(values, at, op.boundaries, place_row) / r.slope
    span = TIMES.get(r.form, STEADY_TIME_CONSTANTS * network.settles_s)
    time = np.concatenate([[0.0], span * np.geomspace(1e-3, 1.0, 40)])
    load = r.load if r.form in TIMES else r.load * 0.4**0.5
    inputs = {n: np.full(time.size, u) for n, u in op.at(load, r.speed).items()}
    if r.form in TIMES and op.warm is not None:  # the run comes to rest there first
        before = np.linspace(0.0, STEADY_TIME_CONSTANTS * network.settles_s, time.size)
        inputs = {n: np.append(np.full(time.size, u), inputs[n]) for n, u in op.at(op.warm).items()}
        time = np.append(before, before[-1] + time)
    air = {b: np.full(time.size, T) for b, T in op.boundaries.items()}
    record = Record(time, inputs, air, float(np.mean(list(op.boundaries.values()))))
    end = np.asarray(simulate(bare, record, values, keep_states=True).z)[-1]
    bands = th.predicted_bands(of, "rating", record, {r.at: spot.hottest(end)[1]})
    return float(bands.half95[-1, 0] / r.slope)
