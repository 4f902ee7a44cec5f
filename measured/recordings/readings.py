"""One test: CSV and sheet -> time grid, inputs, boundaries and channels on the places of a network."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from geom.arrays import Array
from geom.description.roles import Role as BodyRole
from geom.errors import InputError
from lumped.model.network import Link, Network, Row, Source
from lumped.schemas.reader import suggestion
from lumped.transfer.laws import CLOCK
from measured.case import Channel, Recorded, Role, Test
from measured.recordings.consistency import checked_heat, checked_sheet
from measured.recordings.grid import ROUNDING, averaged, bridged, grid_of, read, rms
from measured.recordings.sheet import Column, Sheet
from measured.recordings.tables import Samples, standing_still
from measured.sensors.sampling import SampleStep, sample_step

NONE = np.empty(0)
ALTERNATING = 0.25  # share of the samples at which the sign changes: no machine is reversed that often
COOL = (BodyRole.BEARING, BodyRole.SHAFT, BodyRole.FOOT, BodyRole.BASE, BodyRole.TEST_BED)  # little heat arises there
UNSEEN = "no reading says how warm the winding is"
START_S = 10.0  # the first readings are the mean over this time


class Reading(NamedTuple):
    """A test, the doubts about its data, and the step at which it is looked at."""

    test: Test
    notes: list[str]
    step: SampleStep


def read_test(
    name: str, role: Role, samples: Samples, sheet: Sheet, network: Network, wished: float | None = None
) -> Reading:
    """wished : the coarsest step (s) that is wanted; by default as coarse as the sensors do not feel."""
    inside = [c for c in sheet.columns if c.place not in network.boundaries]  # a room may stand still
    notes = [*samples.notes, *standing_still(inside, samples).values(), *checked_sheet(sheet, network)]
    usual = float(np.median(np.diff(samples.time)))
    notes += grid_of(samples, wished or usual, sheet.where)[1]
    fine = _recorded(sheet, samples)
    air = {c.place: c.name for c in sheet.columns if c.is_temperature and c.place in network.boundaries}
    _complete(network, fine, {**air, **sheet.boundaries}, sheet)
    fine, doubts = checked_heat(sheet, samples, fine, network)
    notes += doubts
    sensors = _sensors(sheet, samples, network)
    if not sensors:
        raise InputError(
            "no measured temperature of the machine", sheet.where, "a temperature column with a place on it"
        )
    notes += _far_from_heat(name, sensors, network)
    step = _step(network, samples, fine, sheet.boundaries, air, sensors, wished)
    grid, _ = grid_of(samples, step.step_s, sheet.where)
    inputs, boundaries, doubts = _on_grid(sheet, samples, network, grid, fine)
    channels = tuple(replace(s.channel, y=_sensor_readings(s, samples, grid)) for s in sensors)
    start = _initial(sheet, channels, samples, network)
    test = Test(name, role, grid, inputs, boundaries, channels, start, (), _finer(sheet, samples, grid, fine, inputs))
    return Reading(test, [*notes, *doubts], step)


def _far_from_heat(name: str, sensors: Sequence[Sensor], network: Network) -> list[str]:
    """A note where a machine would be judged by what hardly feels its heat."""
    places, identities = network.places, network.identities
    kinds = [identities.get(s.channel.place) or identities.get(places[s.channel.place].part) for s in sensors]
    if any(kind is None or kind.role not in COOL for kind in kinds):
        return []
    of = ", ".join(dict.fromkeys(s.channel.place for s in sensors))
    return [f"{name} is measured at {of} alone: {UNSEEN}, where most of the heat is"]


@dataclass(frozen=True)
class Sensor:
    """A channel without its readings, and the columns whose mean it shows.  at_switch_off : it ends there"""

    channel: Channel
    columns: tuple[str, ...]
    at_switch_off: bool = False


def _recorded(sheet: Sheet, samples: Samples) -> dict[str, Array]:
    """Inputs in the record's own steps; straight across what is missing."""
    out = {n: np.full(samples.time.size, v) for n, v in sheet.inputs.items()}
    out |= {n: events.mean(samples.time, samples.start_s) for n, events in sheet.events.items()}
    for c in sheet.columns:
        if not c.is_temperature:
            finite = np.isfinite(samples.values[c.name])
            out[c.feeds] = np.interp(samples.time, samples.time[finite], samples.values[c.name][finite])
    return out | {name: _root_sum_square(name, of, sheet, out) for name, of in sheet.squares.items()}


def _step(
    network: Network,
    samples: Samples,
    fine: Mapping[str, Array],
    start: Mapping[str, float],
    air: Mapping[str, str],
    sensors: Sequence[Sensor],
    wished: float | None,
) -> SampleStep:
    """The step that the sensors do not feel."""
    around = {**start, **{place: float(np.nanmean(samples.values[column])) for place, column in air.items()}}
    level = max(float(np.nanmax(samples.values[c])) for s in sensors for c in s.columns)
    channels = [(s.channel.name, s.channel.row, s.channel.sigma_K, s.channel.lag_s) for s in sensors]
    return sample_step(network, samples.time, {**fine, CLOCK: samples.time}, around, channels, level, wished)


def _on_grid(
    sheet: Sheet, samples: Samples, network: Network, grid: Array, fine: Mapping[str, Array]
) -> tuple[dict[str, Array], dict[str, Array], list[str]]:
    """Inputs and boundaries, averaged; a current by its heat."""
    inputs = {n: np.full(grid.size, v) for n, v in sheet.inputs.items()}
    inputs |= {n: events.mean(grid, samples.start_s) for n, events in sheet.events.items()}
    boundaries, gaps = {n: np.full(grid.size, v) for n, v in sheet.boundaries.items()}, dict[str, int]()
    for column in sheet.columns:
        if column.is_temperature and column.place not in network.boundaries:
            continue
        mean = rms if column.quantity == "current" else averaged
        values = samples.values[column.name]
        if not column.is_temperature:
            values = np.where(np.isfinite(values), fine[column.feeds], np.nan)
        average, where = mean(samples.time, values, grid), f"{samples.file} column '{column.name}'"
        whole = bridged(grid, average, sheet.max_gap_s, where)
        gaps[column.name] = int(np.sum(~np.isfinite(average)))
        (boundaries if column.is_temperature else inputs)[column.feeds or column.place] = whole
    inputs |= {name: _root_sum_square(name, of, sheet, inputs) for name, of in sheet.squares.items()}
    most = max(gaps, key=lambda name: gaps[name], default="")
    words = [f"{samples.file} column '{most}': {gaps[most]} instants interpolated"] if gaps.get(most) else []
    return inputs, boundaries, words


def _finer(
    sheet: Sheet, samples: Samples, grid: Array, fine: Mapping[str, Array], inputs: Mapping[str, Array]
) -> Recorded | None:
    """The inputs as recorded, where that is finer than the grid. Alternating currents are known by their heat alone."""
    if samples.time.size == grid.size and np.allclose(samples.time, grid):
        return None
    currents = {c.feeds for c in sheet.columns if c.quantity == "current"}
    swinging = {n for n in currents if np.mean(fine[n][1:] * fine[n][:-1] < 0.0) > ALTERNATING}
    smooth = {n: u for n, u in inputs.items() if n not in swinging}
    return Recorded(samples.time, {n: fine[n] for n in smooth}, grid, smooth)


def _root_sum_square(name: str, of: tuple[str, ...], sheet: Sheet, inputs: Mapping[str, Array]) -> Array:
    feeds = {c.name: c.feeds for c in sheet.columns if c.feeds}
    for column in of:
        if column not in feeds:
            raise InputError(
                f"unknown column '{column}'", f"{sheet.where} [root_sum_square] {name}", suggestion(column, feeds)
            )
    return np.asarray(np.sqrt(np.sum([inputs[feeds[column]] ** 2 for column in of], axis=0)))


def _complete(network: Network, inputs: Mapping[str, Array], boundaries: Mapping[str, object], sheet: Sheet) -> None:
    """Every boundary and input that the network needs is there."""
    for boundary in network.boundaries:
        if boundary not in boundaries:
            right = f'a temperature column with place = "{boundary}", or [boundaries] {boundary} = ...'
            raise InputError(f"nothing gives the boundary '{boundary}'", sheet.where, right)
    items: list[Link | Source] = [*network.links, *network.sources]
    for item in items:
        for name in item.law.reads:
            if name not in inputs and name != "time_s":
                right = f'a column with input = "{name}", [events.{name}], or [inputs] {name} = ...'
                what = f"nothing gives the input '{name}', which '{item.name}' of {network.title} needs"
                raise InputError(what, sheet.where, right)


def row_of(network: Network, place: str, position_mm: tuple[float, ...], where: str) -> Row:
    """Where a sensor looks: a point of a part when its position is known, else the mean of its place."""
    if place in network.boundaries:
        raise InputError(f"'{place}' is a boundary", where, f"a place of the machine: {', '.join(network.places)}")
    if place not in network.places:
        raise InputError(f"unknown place '{place}'", where, suggestion(place, [*network.places, *network.boundaries]))
    if not position_mm or network.recovery is None:
        return network.places[place].mean
    try:
        return network.recovery.row(network.places[place].part, 1e-3 * np.array(position_mm))
    except InputError as fault:
        raise InputError(fault.what, f"{where} position_mm", fault.right) from None


def rows_of(sheet: Sheet, samples: Samples, network: Network) -> dict[str, Row]:
    """Channel -> where its sensor looks in a network."""
    return {s.channel.name: s.channel.row for s in _sensors(sheet, samples, network)}


def _sensors(sheet: Sheet, samples: Samples, network: Network) -> list[Sensor]:
    return [*_channels(sheet, samples, network), *_means(sheet, network)]


def _channels(sheet: Sheet, samples: Samples, network: Network) -> list[Sensor]:
    inside = {name for mean in sheet.means for name in mean.of}
    return [
        Sensor(
            Channel(
                c.name,
                c.place,
                row_of(network, c.place, c.position_mm, c.where),
                NONE,
                samples.sigma_K.get(c.name, c.sigma_K),
                c.lag_s,
            ),
            (c.name,),
            c.electrical is not None and c.electrical.after is not None,
        )
        for c in sheet.columns
        if c.is_temperature and c.place not in network.boundaries and c.name not in inside
    ]


def _means(sheet: Sheet, network: Network) -> list[Sensor]:
    column_of: dict[str, Column] = {
        c.name: c for c in sheet.columns if c.is_temperature and c.place not in network.boundaries
    }
    for mean in sheet.means:
        for name in mean.of:
            if name not in column_of:
                what = f"averages '{name}', which is not a temperature column of the machine"
                raise InputError(what, mean.where, suggestion(name, column_of))
    return [
        Sensor(Channel(m.name, m.place, row_of(network, m.place, (), m.where), NONE, m.sigma_K, m.lag_s), m.of)
        for m in sheet.means
    ]


def _sensor_readings(sensor: Sensor, samples: Samples, grid: Array) -> Array:
    """Readings on the grid; a value carried back to the instant of switching off stands at its end."""
    y = np.mean([read(samples.time, samples.values[name], grid) for name in sensor.columns], axis=0)
    if sensor.at_switch_off:
        y[-1] = samples.values[sensor.columns[0]][-1]
    return np.asarray(y)


def _initial(
    sheet: Sheet, channels: tuple[Channel, ...], samples: Samples, network: Network
) -> float | Mapping[str, float]:
    """degC everywhere, per place as declared, or the first readings place by place."""
    if not isinstance(sheet.initial, str):
        return sheet.initial
    first: dict[str, list[float]] = {}
    early = samples.time <= START_S * (1.0 + ROUNDING)
    for c in channels:
        of = next((m.of for m in sheet.means if m.name == c.name), (c.name,))
        raw = np.concatenate([samples.values[name][early] for name in of])
        if np.isfinite(raw).any():
            first.setdefault(c.place, []).append(float(np.nanmean(raw)))
    if not first:
        raise InputError("no channel reads at the start", f"{sheet.where} [test]", "initial = 20.0 (degC)")
    return {place: float(np.mean(values)) for place, values in first.items()}
