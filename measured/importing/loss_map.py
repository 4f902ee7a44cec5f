"""Losses over speed and torque, or over id and iq, as electromagnetic tools write them: tables and MATLAB files."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from geom.arrays import Array
from geom.constants import RPM
from geom.description.roles import Role
from geom.errors import InputError
from measured.headers.cells import number, split_unit, unit_of
from measured.headers.words import LOSS, WORDS, axis_of, is_within, quantities_of, roles_of, tokens
from measured.importing.source import read_source
from measured.recordings.formats import guarded, matlab_variables
from measured.recordings.units import QUANTITIES, converted

AXES = {"speed_rpm": "speed", "torque_Nm": "torque", "id_A": "current", "iq_A": "current"}
ALIKE = 1e-6  # of the largest: values of an axis nearer than this are one
MOST_POINTS = (
    41  # of an axis where rows have points of their own: straight lines follow a square law to 0.02 % of its end
)
SAME = 0.01  # of the largest: a column that is the sum of others; tools round to three digits
LEAST_LOSS = 5e-4  # of the largest shaft power: no machine is as good, the losses are in kW
SLOW = 0.5  # of the rated speed: a map goes further, or its speeds are in rad/s
IN_FILE, BY_OPTION = "by the file", "by --units"
FAMILIES = {"copper-ac": "copper", "rotor-iron": "iron", "windage": "mechanical"}


@dataclass(frozen=True)
class Column:
    """Values in the unit of memory.  unit : of the file;  why : IN_FILE, BY_OPTION, or by what it is a guess"""

    name: str
    unit: str
    why: str
    values: Array


@dataclass(frozen=True)
class LossMap:
    """axes : inputs -> column, rising;  losses : kind -> columns that add up, and watts (n_first, n_second)

    speed_rpm, winding_degC : at which it holds, where the file says it;  notes : columns left out, and why
    """

    axes: Mapping[str, Column]
    losses: Mapping[str, tuple[tuple[Column, ...], Array]]
    speed_rpm: float | None
    winding_degC: float | None
    notes: Mapping[str, str]


def read_loss_map(file: Path, units: Mapping[str, str], rated_rpm: float) -> LossMap:
    """A grid, or a row per point.

    units : quantity (speed, torque, current, power) -> unit, where the file has none
    rated_rpm : of the machine: by it the unit of speeds is guessed
    Raises InputError for a file without axes or losses, for points that form no rows, and for negative losses.
    """
    for quantity, unit in units.items():
        if quantity not in (*AXES.values(), "power") or unit not in QUANTITIES[quantity].units:
            right = "speed=rad/s, torque=kN*m, current=mA, power=kW and the like"
            raise InputError(f"'{quantity}={unit}' is not a unit of a loss map", "--units", right)
    columns = _columns(file)
    names = _axis_names(columns, file)
    filled = [name for name, (_, x) in columns.items() if np.isfinite(x).any() and name not in names.values()]
    kinds = {name: kind for name in filled if (kind := _kind(name))}
    notes = {name: "no loss of a part" for name in columns if name not in kinds and name not in names.values()}
    axes = {i: _axis(i, name, *columns[name], units, rated_rpm) for i, name in names.items()}
    losses = _losses(columns, kinds, axes, units)
    for name in _sums(losses, kinds):
        notes[name] = "the sum of others"
        del losses[name]
    if not losses:
        raise InputError("no column is of a loss", str(file), "such as Stator_Copper_Loss, Iron_Loss, Magnet_Loss")
    keep = _one_sign(axes, list(losses.values()), notes)
    values = [abs(axis.values[keep]) for axis in axes.values()]
    grid, watts = _grid(values, [column.values[keep] for column in losses.values()], file, notes)
    out: dict[str, tuple[tuple[Column, ...], Array]] = {}
    for (name, column), P in zip(losses.items(), watts, strict=True):
        before, total = out.get(kinds[name], ((), np.zeros(P.shape)))
        out[kinds[name]] = ((*before, column), total + P)
    rising = {i: Column(a.name, a.unit, a.why, values) for (i, a), values in zip(axes.items(), grid, strict=True)}
    speed = next((n for n in columns if "speed" in quantities_of(n)), "") if "id_A" in axes else ""
    hot = next((n for n in columns if quantities_of(n)[:1] == ["temperature"] and Role.WINDING in roles_of(n)), "")
    turns = _axis("speed_rpm", speed, *columns[speed], units, rated_rpm).values if speed else np.zeros(0)
    degC = converted(columns[hot][1], "temperature", columns[hot][0] or "degC") if hot else np.zeros(0)
    return LossMap(rising, out, _constant(turns), _constant(degC), notes)


def _constant(values: Array) -> float | None:
    """What all have, None where they differ or are none."""
    return float(values[0]) if values.size and np.ptp(values) <= ALIKE * abs(values[0]) else None


def _columns(file: Path) -> dict[str, tuple[str, Array]]:
    """Name -> unit as far as the file has it, and a value per point."""
    if file.suffix.lower() == ".mat":
        return _of_matrices(
            guarded(file, "a MATLAB file", "scipy", lambda: dict(_arrays(matlab_variables(file)))), file
        )
    source = read_source(file)
    numbers = {column: source.numbers(column) for column in source.cells}
    corner, *heads = source.cells
    table = np.column_stack([*numbers.values()])
    if source.unnamed:  # the first row is one of numbers, but for its corner
        corner, heads, table = str(source.cells[corner][0] or ""), [*table[0, 1:]], table[1:]
    along = np.array([number(head) for head in heads])
    if min(table.shape) > 1 and (np.diff(along) > 0).all() and (np.diff(table[:, 0]) > 0).all():
        return _of_grid(corner, table[:, 0], along, table[:, 1:], file)
    units = {column: unit_of(source.units[column]) for column in numbers}
    return {source.labels[column]: (units[column], values) for column, values in numbers.items()}


def _of_grid(corner: str, down: Array, along: Array, watts: Array, file: Path) -> dict[str, tuple[str, Array]]:
    """One loss, whose part the file's name says.  corner : what stands down | along, "" for speed and torque"""
    names = re.split(r"[\\|]", corner) if re.search(r"[\\|]", corner) else ["speed", "torque"]
    axes = zip(names, np.meshgrid(down, along, indexing="ij"))
    columns = {name: (unit_of(unit), x.ravel()) for text, x in axes for name, unit in [split_unit(text.strip())]}
    return columns | {file.stem: ("", watts.ravel())}


def _arrays(one: Mapping[str, Any]) -> Iterator[tuple[str, Array]]:
    for variable, inside in one.items():
        if isinstance(inside, Mapping):
            yield from _arrays(inside)
            continue
        x = np.squeeze(np.asarray(inside))
        if not variable.startswith("__") and x.dtype.kind in "fiub" and x.ndim < 3:
            yield variable, x.astype(float)


def _of_matrices(arrays: Mapping[str, Array], file: Path) -> dict[str, tuple[str, Array]]:
    """Matrices of one shape point by point, vectors along their sides, single numbers everywhere."""
    shapes = Counter(x.shape for x in arrays.values() if x.ndim == 2) or Counter(
        x.shape for x in arrays.values() if x.size > 1
    )
    if not shapes:
        raise InputError(
            "holds no columns of numbers", str(file), "speed, torque and losses point by point, saved with -v7"
        )
    shape = shapes.most_common(1)[0][0]
    out = {}
    for label, x in arrays.items():
        name, unit = split_unit(label)
        if x.ndim == 1 and len(shape) == 2 and x.size == shape[0] == shape[1]:
            what = f"{name} may stand down or along {shape[0]} x {shape[1]} points"
            raise InputError(what, str(file), "a matrix of every axis, as large as those of the losses")
        if x.ndim == 1 and len(shape) == 2 and x.size == shape[0] and shape[0] != shape[1]:
            x = x[:, None]
        if x.shape == shape or x.ndim == 0 or (x.ndim + 1, x.size) == (2, shape[-1]) or x.shape == (shape[0], 1):
            out[name] = (unit_of(unit), np.broadcast_to(x, shape).ravel())
    return out


def _axis_names(columns: Mapping[str, tuple[str, Array]], file: Path) -> dict[str, str]:
    """Input -> column: speed and torque, at the shaft before others, or both currents where the speed is one."""
    speeds = [n for n in columns if quantities_of(n)[:1] == ["speed"] and np.ptp(columns[n][1]) > 0]
    torques = [n for n in columns if quantities_of(n)[:1] == ["torque"]]
    torques.sort(key=lambda n: Role.SHAFT not in roles_of(n))
    currents = {f"{axis}_A": n for n in [*columns][::-1] if (axis := axis_of(n)) in ("id", "iq")}
    if speeds and torques:
        return {"speed_rpm": speeds[0], "torque_Nm": torques[0]}
    if len(currents) == 2:
        return {name: currents[name] for name in sorted(currents)}
    listed = ", ".join([*columns][:9])
    raise InputError(
        "no map over speed and torque, or over id and iq", f"{file} columns {listed}", "a column of either"
    )


def _kind(name: str) -> str:
    """What part's loss a column is, "" for none."""
    if not (is_within(name, LOSS) or tokens(name)[:1] in (("p",), ("pv",))) or is_within(name, WORDS["total"]):
        return ""
    roles = roles_of(name)
    if is_within(name, WORDS["rubbing"]):
        return "windage" if is_within(name, WORDS["windage"]) else "mechanical"
    if Role.MAGNET in roles:
        return "magnet"
    if Role.CAGE in roles or {Role.WINDING, Role.ROTOR} <= {*roles}:
        return "cage"
    if Role.WINDING in roles:
        return "copper-ac" if WORDS["alternating"] & {*tokens(name)} else "copper"
    return "rotor-iron" if Role.ROTOR in roles else "iron" if Role.IRON in roles else ""


def _axis(i: str, name: str, unit: str, values: Array, units: Mapping[str, str], rated_rpm: float) -> Column:
    quantity, why = AXES[i], IN_FILE
    if unit not in QUANTITIES[quantity].units:
        unit, why = units.get(quantity, ""), BY_OPTION
    if not unit:
        most = float(np.nanmax(np.abs(values)))
        slow = quantity == "speed" and most < SLOW * rated_rpm
        unit = "rad/s" if slow else next(iter(QUANTITIES[quantity].units))
        reason = f"it reaches {most:g}, the machine is rated {rated_rpm:g} rpm" if quantity == "speed" else "as usual"
        why = f"{unit}: {reason}"
    return Column(name, unit, why, converted(values, quantity, unit))


def _losses(
    columns: Mapping[str, tuple[str, Array]],
    kinds: Mapping[str, str],
    axes: Mapping[str, Column],
    units: Mapping[str, str],
) -> dict[str, Column]:
    """In W. Where nobody says the unit, kW if they would be next to nothing beside the power at the shaft."""
    most = sum(float(np.nanmax(columns[name][1])) for name in kinds)
    power = (
        RPM * float(np.nanmax(np.abs(axes["speed_rpm"].values * axes["torque_Nm"].values)))
        if "torque_Nm" in axes
        else 0.0
    )
    usual = "kW" if most < LEAST_LOSS * power else "W"
    reason = f"{usual}: {most:.3g} beside {power:.3g} W at the shaft" if power else f"{usual}: as usual"
    out = {}
    for name in kinds:
        unit, values = columns[name]
        if unit in QUANTITIES["power"].units:
            out[name] = Column(name, unit, IN_FILE, converted(values, "power", unit))
        else:
            unit = units.get("power", usual)
            out[name] = Column(name, unit, BY_OPTION if "power" in units else reason, converted(values, "power", unit))
    return out


def _sums(losses: Mapping[str, Column], kinds: Mapping[str, str]) -> list[str]:
    """Columns that are the sum of some others of their family: those that name less first."""
    out: list[str] = []
    order = sorted(losses, key=lambda n: (-np.nanmax(losses[n].values), len(tokens(n))))
    for name in order:
        family = FAMILIES.get(kinds[name], kinds[name])
        others = [n for n in order if n not in (name, *out) and FAMILIES.get(kinds[n], kinds[n]) == family]
        x = losses[name].values
        sums = (
            np.sum([losses[n].values for n in some], axis=0) for k in range(2, 5) for some in combinations(others, k)
        )
        if any(np.nanmax(np.abs(x - total)) < SAME * np.nanmax(x) for total in sums):
            out.append(name)
    return out


def _one_sign(axes: Mapping[str, Column], losses: list[Column], notes: dict[str, str]) -> Any:
    """Which points count: with numbers, and of an axis with both signs those of the longer half."""
    keep = np.all([np.isfinite(c.values) for c in [*axes.values(), *losses]], axis=0)
    if not keep.all():
        notes["points"] = f"{np.sum(~keep)} of {keep.size} have no numbers and are left out"
    for axis in axes.values():
        low, high = np.min(axis.values, where=keep, initial=0.0), np.max(axis.values, where=keep, initial=0.0)
        if low < -ALIKE * high and high > -ALIKE * low:
            side = 1.0 if high >= -low else -1.0
            keep &= side * axis.values >= -ALIKE * max(high, -low)
            notes[axis.name] = (
                f"{'negative' if side > 0 else 'positive'} values are left out: a map is over |{axis.name}|"
            )
    return keep


def _grid(axes: list[Array], losses: list[Array], file: Path, notes: dict[str, str]) -> tuple[list[Array], list[Array]]:
    """Both axes, rising, and the losses on them; rows of one first value may have second values of their own."""
    (first, row), (second, _) = (_distinct(x) for x in axes)
    sizes = np.bincount(row)
    if first.size < 2 or first.size > sizes.sum() / 2:
        what = f"{sizes.sum()} points have {first.size} values of the first axis"
        raise InputError(what, str(file), "rows of points: some torques at each speed, or some iq at each id")
    whole = second.size * first.size == sizes.sum()
    if not whole:
        second = np.linspace(0.0, float(axes[1].max()), min(int(sizes.max()), MOST_POINTS))
    if second.size < 2:
        raise InputError("has one value of the second axis", str(file), "two torques at each speed, or more")
    if not whole:
        notes["grid"] = f"none: {second.size} values at each of {first.size}, nearest ones beyond the envelope"
    for P in losses:
        if P.min() < -ALIKE * P.max():
            raise InputError(f"a loss is {P.min():.4g} W", str(file), "watts that become heat")
    out = []
    for P in losses:
        rows = []
        for k in range(first.size):
            order = np.flatnonzero(row == k)[np.argsort(axes[1][row == k])]
            rows.append(np.interp(second, axes[1][order], np.maximum(P[order], 0.0)))
        out.append(np.array(rows))
    return [first, second], out


def _distinct(x: Array) -> tuple[Array, Any]:
    """Values that differ, rising, and which of them every value is."""
    step = ALIKE * max(float(x.max(initial=0.0)), 1e-12)
    _, index = np.unique(np.round(x / step), return_inverse=True)
    return np.bincount(index, x) / np.bincount(index), index
