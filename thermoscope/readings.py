"""One test: CSV and sheet -> time grid, inputs, boundaries and channels on the places of a network."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from lumped.network import Link, Network, Row, Source
from lumped.reader import known
from thermoscope.consistency import checked_heat, checked_sheet
from thermoscope.grid import averaged, bridged, grid_of, rms
from thermoscope.sheet import Column, Mean, Sheet
from thermoscope.tables import Samples
from validation.case import Channel, Role, Test

Array = NDArray[np.float64]
START_S = 10.0  # the first readings are the mean over this time


def read_test(
    name: str, role: Role, samples: Samples, sheet: Sheet, network: Network, step: float
) -> tuple[Test, list[str]]:
    """The test and the doubts about its data."""
    notes = [*samples.notes, *checked_sheet(sheet, network)]
    grid, doubts = grid_of(samples, step, sheet.where)
    notes += doubts
    inputs = {n: np.full(grid.size, v) for n, v in sheet.inputs.items()}
    inputs |= {n: events.mean(grid, samples.start_s) for n, events in sheet.events.items()}
    boundaries = {n: np.full(grid.size, v) for n, v in sheet.boundaries.items()}
    for column in sheet.columns:
        if column.is_temperature and column.place not in network.boundaries:
            continue
        mean = rms if column.quantity == "current" else averaged
        values = mean(samples.time, samples.values[column.name], grid)
        whole, doubts = bridged(grid, values, sheet.max_gap_s, f"{samples.file} column '{column.name}'")
        notes += doubts
        (boundaries if column.is_temperature else inputs)[column.feeds or column.place] = whole
    inputs |= {name: _root_sum_square(name, of, sheet, inputs) for name, of in sheet.squares.items()}
    _complete(network, inputs, boundaries, sheet)
    inputs, doubts = checked_heat(sheet, samples, inputs, network)
    notes += doubts
    channels = (
        *_channels(sheet, samples, grid, network),
        *(_mean(m, sheet, samples, grid, network) for m in sheet.means),
    )
    if not channels:
        raise InputError(
            "no measured temperature of the machine", sheet.where, "a temperature column with a place on it"
        )
    return Test(name, role, grid, inputs, boundaries, channels, _initial(sheet, channels, samples, network)), notes


def _root_sum_square(name: str, of: tuple[str, ...], sheet: Sheet, inputs: Mapping[str, Array]) -> Array:
    feeds = {c.name: c.feeds for c in sheet.columns if c.feeds}
    for column in of:
        if column not in feeds:
            raise InputError(
                f"unknown column '{column}'", f"{sheet.where} [root_sum_square] {name}", known(column, feeds)
            )
    return np.asarray(np.sqrt(np.sum([inputs[feeds[column]] ** 2 for column in of], axis=0)))


def _complete(network: Network, inputs: Mapping[str, Array], boundaries: Mapping[str, Array], sheet: Sheet) -> None:
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
                raise InputError(f"nothing gives the input '{name}', which '{item.name}' needs", sheet.where, right)


def row_of(network: Network, place: str, position_mm: tuple[float, ...], where: str) -> Row:
    """Where a sensor looks: a point of a part when its position is known, else the mean of its place."""
    if place not in network.places:
        raise InputError(f"unknown place '{place}'", where, known(place, [*network.places, *network.boundaries]))
    if not position_mm or network.recovery is None:
        return network.places[place].mean
    try:
        return network.recovery.row(network.places[place].part, 1e-3 * np.array(position_mm))
    except InputError as fault:
        raise InputError(fault.what, f"{where} position_mm", fault.right) from None


def _channels(sheet: Sheet, samples: Samples, grid: Array, network: Network) -> list[Channel]:
    inside = {name for mean in sheet.means for name in mean.of}
    return [
        Channel(c.name, c.place, row_of(network, c.place, c.position_mm, c.where),
                _seen(c, samples, grid), samples.sigma_K.get(c.name, c.sigma_K), c.lag_s)
        for c in sheet.columns
        if c.is_temperature and c.place not in network.boundaries and c.name not in inside
    ]  # fmt: skip


def _seen(column: Column, samples: Samples, grid: Array) -> Array:
    """Readings on the grid; a value carried back to the instant of switching off stands at its end."""
    y = averaged(samples.time, samples.values[column.name], grid)
    if column.electrical is not None and column.electrical.after is not None:
        y[-1] = samples.values[column.name][-1]
    return y


def _mean(mean: Mean, sheet: Sheet, samples: Samples, grid: Array, network: Network) -> Channel:
    named: dict[str, Column] = {c.name: c for c in sheet.columns if c.is_temperature}
    for name in mean.of:
        if name not in named:
            raise InputError(f"averages unknown temperature column '{name}'", mean.where, known(name, named))
    y = np.mean([averaged(samples.time, samples.values[name], grid) for name in mean.of], axis=0)
    return Channel(mean.name, mean.place, row_of(network, mean.place, (), mean.where), y, mean.sigma_K, mean.lag_s)


def _initial(
    sheet: Sheet, channels: tuple[Channel, ...], samples: Samples, network: Network
) -> float | Mapping[str, float]:
    """degC everywhere, per place as declared, or the first readings place by place."""
    if not isinstance(sheet.initial, str):
        return sheet.initial
    first: dict[str, list[float]] = {}
    early = samples.time <= START_S
    for c in channels:
        of = next((m.of for m in sheet.means if m.name == c.name), (c.name,))
        raw = np.concatenate([samples.values[name][early] for name in of])
        if np.isfinite(raw).any():
            first.setdefault(c.place, []).append(float(np.nanmean(raw)))
    if not first:
        raise InputError("no channel reads at the start", f"{sheet.where} [test]", "initial = 20.0 (degC)")
    return {place: float(np.mean(values)) for place, values in first.items()}
