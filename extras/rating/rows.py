"""Rows of a rating's document: each load with its 95 % band, beside that of the model before its last step."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from extras.rating.derating import deratings
from extras.rating.envelope import TIMES, LimitError, Rating, rated
from extras.rating.hot_spots import hot_spots
from extras.rating.operation import Operation
from extras.rating.request import Rated
from thermoscope import Record, plugin as th, simulate, steady

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
        out.append(
            {
                "of": d.where.of,
                "value": d.where.value,
                "unit": d.where.unit,
                "share": d.load / load,
                "share_ci95": None if half is None else [max(d.load - half, 0.0) / load, (d.load + half) / load],
                "share_before": None if before is None else before / whole,
            }
        )
    return out


def row(
    folder: th.Folder, op: Operation, r: Rating, before: float | None, of: th.ParameterPosterior | None
) -> dict[str, Any]:
    """One rating."""
    main = op.inputs[op.main]
    half = _half_band(folder, op, r, of)
    ci95 = None if half is None else [(r.load - half) * main, (r.load + half) * main]
    change = None if not before or not np.isfinite(before) else 100.0 * (r.load / before - 1.0)
    return {
        "form": r.form,
        "value": r.load * main,
        "ci95": ci95,
        "at": r.at,
        "before": None if before is None else before * main,
        "change_percent": change,
    }


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
