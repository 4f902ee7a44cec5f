"""Loss maps from electromagnetic tools, as losses of a network: a complete grid of torque and speed.

Heat follows the map at its temperature and grows with the place's temperature as the map's slices say, or as the
network's own law does where there is one slice.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from thermoscope import InputError, Network, plugin as th

BALANCED = 0.02  # of the input power: what losses and powers may disagree by
TORQUE, SPEED = "torque_Nm", "speed_rpm"


@dataclass(frozen=True)
class LossGrid:
    """torque (nt,) N m, speed (ns,) 1/min;  watts : loss -> (n_temperature, ns, nt) W;  temperatures (degC)"""

    torque: th.Array
    speed: th.Array
    temperatures: th.Array
    watts: Mapping[str, th.Array]


def loss_grid(columns: Mapping[str, th.Array], where: str, voltage: float | None = None) -> LossGrid:
    """From columns torque_Nm, speed_rpm, NAME_W, optionally temperature_degC, voltage_V, input_W; a row per point.

    Raises InputError for missing columns, holes, points given twice, and a balance that does not close.
    """
    for name in (TORQUE, SPEED):
        if name not in columns:
            right = f"columns {TORQUE}, {SPEED} and NAME_W for each loss"
            raise InputError(f"column '{name}' is missing", where, right)
    columns = _at_voltage(dict(columns), where, voltage)
    ones = np.zeros_like(columns[TORQUE])
    points = columns.get("temperature_degC", ones), columns[SPEED], columns[TORQUE]
    axes = [np.unique(c) for c in points]
    if min(axes[1].size, axes[2].size) < 2:
        raise InputError(f"the map has {axes[2].size} torques and {axes[1].size} speeds", where, "two or more of each")
    index = [np.searchsorted(axis, c) for axis, c in zip(axes, points, strict=True)]
    count = np.zeros([a.size for a in axes], int)
    np.add.at(count, tuple(index), 1)
    _complete(count, axes, where)
    names = [n.removesuffix("_W") for n in columns if n.endswith("_W") and n != "input_W"]
    if not names:
        raise InputError("no losses", where, "a column NAME_W for each loss of the network, in watts")
    watts = {n: np.zeros(count.shape) for n in names}
    for n in names:
        watts[n][tuple(index)] = columns[f"{n}_W"]
        if not np.all((watts[n] >= 0.0) & (watts[n] <= th.KEY_UNITS["W"].high)):
            right = f"watts that become heat, {th.KEY_UNITS['W'].words}"
            raise InputError(f"'{n}_W' has negative, missing or impossible values", where, right)
    _balanced(columns, names, where)
    return LossGrid(axes[2], axes[1], axes[0], watts)


def _at_voltage(columns: dict[str, th.Array], where: str, voltage: float | None) -> dict[str, th.Array]:
    if "voltage_V" not in columns:
        return columns
    voltages = np.unique(columns["voltage_V"])
    level = voltages[0] if voltage is None and voltages.size == 1 else voltage
    if level not in voltages:
        right = f"--voltage one of {', '.join(f'{v:g}' for v in voltages)}"
        raise InputError(f"the map has {voltages.size} voltages", where, right)
    return {n: c[columns["voltage_V"] == level] for n, c in columns.items()}


def _complete(count: th.Ints, axes: list[th.Array], where: str) -> None:
    if np.all(count == 1):
        return
    bad = [at for at in product(*(range(a.size) for a in axes)) if count[at] != 1]
    T, n, M = (axis[i] for axis, i in zip(axes, bad[0], strict=True))
    holes = [at for at in bad if count[at] == 0]
    what = f"{len(holes)} of {count.size} points are missing" if holes else f"{len(bad)} points are given twice"
    what = f"the map has holes or doubles: {what}, the first at {M:g} Nm, {n:g} 1/min, {T:g} degC"
    right = "every torque at every speed, once; fill what the machine cannot reach with the nearest point"
    raise InputError(what, where, right)


def _balanced(columns: Mapping[str, th.Array], names: list[str], where: str) -> None:
    """Input less shaft power is what becomes heat."""
    if "input_W" not in columns:
        return
    shaft = columns[TORQUE] * columns[SPEED] * th.RPM
    heat = np.sum([columns[f"{n}_W"] for n in names], axis=0)
    off = np.abs(columns["input_W"] - shaft - heat)
    tolerance = BALANCED * np.maximum(np.abs(columns["input_W"]), np.abs(shaft))
    if np.any(off > tolerance + 1e-9):
        k = int(np.argmax(off - tolerance))
        raise InputError(
            f"the powers do not balance: at {columns[TORQUE][k]:g} Nm, {columns[SPEED][k]:g} 1/min input less shaft is "
            f"{columns['input_W'][k] - shaft[k]:.4g} W, the losses are {heat[k]:.4g} W",
            where,
            f"within {100 * BALANCED:g} % of the power: is a loss missing, or a unit wrong?",
        )


def with_losses(network: Network, grid: LossGrid, where: str) -> Network:
    """The network with the map in place of its losses; every column is one of its losses, by name or by kind.

    A loss of the network that the map lacks is taken out: the map says all of them.
    """
    kinds = {s.kind for s in network.sources} | {s.name for s in network.sources} | {_bare(s) for s in network.sources}
    for name in grid.watts:
        if name not in kinds:
            choices = ", ".join(sorted({_bare(s) for s in network.sources} | {s.kind for s in network.sources}))
            raise InputError(f"'{name}_W' is not a loss of the network", where, f"known: {choices}")
    sources = []
    for s in (s for s in network.sources if not s.name.endswith(th.EDDY)):  # a map says the whole of a copper loss
        for name in [n for n in (s.name, _bare(s), s.kind) if n in grid.watts][:1]:
            alike = [x for x in network.sources if name in (x.name, _bare(x), x.kind) and not x.name.endswith(th.EDDY)]
            # Of one slice with the network's own temperature law, else linear between first and last slice
            watts = grid.watts[name] * _share(s, alike)
            law = s.law.temperature
            first, T = watts[0], float(grid.temperatures[0])
            if grid.temperatures.size > 1:
                rise = float(grid.temperatures[-1]) - T
                alpha = float(np.sum(watts[-1] - first) / max(float(np.sum(first)), 1e-300) / rise)
                law = th.Linear(alpha, T)
            elif isinstance(law, th.Linear):
                law = th.Linear(law.alpha / (1.0 + law.alpha * (T - law.reference)), T)
            rows = tuple(tuple(float(v) for v in row) for row in first)
            sources.append(replace(s, law=th.MapLoss(tuple(grid.speed), tuple(grid.torque), rows, SPEED, TORQUE, law)))
    gone = {s.name for s in network.sources} - {s.name for s in sources}
    parameters = tuple(replace(p, targets=tuple(t for t in p.targets if t[0] not in gone)) for p in network.parameters)
    return replace(network, sources=tuple(sources), parameters=parameters)


def _share(s: th.Source, alike: list[th.Source]) -> float:
    """Of a column's watts: as much for each loss; of a copper loss in parts by their resistance."""
    parts = [x.law for x in alike if th.declared_name(x.name) == th.declared_name(s.name)]
    losses = len({th.declared_name(x.name) for x in alike})
    if len(parts) == 1 or not isinstance(s.law, th.CopperLoss):
        return 1.0 / losses / len(parts)
    return s.law.resistance / sum(x.resistance for x in parts if isinstance(x, th.CopperLoss)) / losses


def _bare(s: th.Source) -> str:
    return s.name.rpartition(":")[2]
