"""What is asked of a rating, and the model and operating point that answer it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from extras.rating.loss_grid import SPEED, TORQUE, loss_grid, with_losses
from extras.rating.operation import Operation, air_boundaries, coolant_boundaries, operation
from extras.rating.points import MEAN, Model, hot_spots
from thermoscope import InputError, Network, plugin as th

AMBIENT_C = 40.0  # IEC 60034-1: what a machine is rated in where nothing else is said
INLET_C = 20.0  # what [cooling] takes where it does not say


@dataclass(frozen=True)
class RatingRequest:
    """limits : place -> degC;  at : input or boundary -> value;  loads : inputs that carry the load, if not the usual

    start : of the input that carries the load, from whose rest S2 begins; None: cold
    losses : a map, at a voltage;  overload : of S1;  cycle : a file or a name;  mapped : whether a map is wanted
    """

    limits: Mapping[str, float]
    at: Mapping[str, float]
    loads: tuple[str, ...] = ()
    losses: Path | None = None
    voltage: float | None = None
    overload: float = 1.5
    top_rpm: float | None = None
    cycle: str | None = None
    mapped: bool = False
    start: float | None = None


@dataclass(frozen=True)
class Rated:
    """A model at the point where load counts as 1.  limits : place -> degC, groups taken apart"""

    model: Model
    op: Operation
    limits: Mapping[str, float]


def rated_model(folder: th.Folder, request: RatingRequest) -> Rated:
    """Of a case as it stands, or of a machine at its rated point."""
    network, values = th.model_of(folder)
    rows = th.named_rows(network, folder)
    limits = places(request.limits, rows, network.identities)
    point = usual_point(folder, network)
    if request.losses is not None:
        grid = loss_grid(columns_of(request.losses), str(request.losses), request.voltage)
        network = with_losses(network, grid, str(request.losses))
        usual = {name: th.USUAL_QUANTITIES[name] for name in (TORQUE, SPEED)}
        network = replace(network, quantities={**usual, **network.quantities})
        around = {n: u for n, u in point.items() if n in network.boundaries}
        point = {**rated_point(folder, network), **around}
        point |= {TORQUE: float(grid.torque.max()), SPEED: float(np.median(grid.speed))}
    op = operation(network, point, request.at, request.loads)
    mine = {p.name for p in network.parameters}
    model = Model(network, {k: v for k, v in values.items() if k in mine}, hot_spots(network, rows, limits))
    return Rated(model, op if request.start is None else begun(model, op, limits, request.start), limits)


def begun(model: Model, op: Operation, limits: Mapping[str, float], start: float) -> Operation:
    """The operating point with short times from rest under a load `start`, in the unit of its main input.

    Raises InputError where a limit is exceeded there already.
    """
    warm = start / abs(op.inputs[op.main])
    for (place, most), T in zip(limits.items(), model.rest(op, warm, None), strict=True):
        if most <= T:
            what = f"at rest under {op.main} = {start:g} '{place}' is {T:.4g} degC already, its limit is {most:g} degC"
            raise InputError(what, "--start", "a lower load, or cold")
    return replace(op, warm=warm)


def places(
    limits: Mapping[str, float], rows: Mapping[str, th.Row], what: Mapping[str, th.Identity]
) -> dict[str, float]:
    """Every place by its name; a role (winding, magnet, bearing, ...) stands for all places that have it.

    what : name -> its role. "winding" limits the ends of a winding beside the place of that name: they may be hotter.
    A limit holds at the hottest point of a place; "NAME.mean" limits its mean.
    """
    roles = {n: i.role.value for n, i in what.items() if i.role is not None}
    out: dict[str, float] = {}
    for name in sorted(limits, key=lambda n: n.removesuffix(MEAN) not in roles.values()):  # a place has the last word
        of = name if name in rows else name.removesuffix(MEAN)
        mine = [n for n in rows if n == of or roles.get(n) == of]
        if not mine:
            raise InputError(f"no temperature '{name}' to limit", "--limit", th.suggestion(name, rows))
        out |= dict.fromkeys((f"{n}{name[len(of) :]}" for n in mine), limits[name])
    return out


def usual_point(folder: th.Folder, network: Network) -> dict[str, float]:
    """Where load counts as 1: where the largest load of the fitted tests was, and what they leave open as rated."""
    return {**rated_point(folder, network), **th.standing_reference(folder.case).load_point}


def rated_point(folder: th.Folder, network: Network) -> dict[str, float]:
    """Inputs and boundaries of a machine without tests: its ratings, 40 degC around it, its coolant's inlet."""
    if folder.built is None:
        return {}

    machine: th.MachineDescription = folder.built.machine
    cooling = machine.sections.get("cooling", {})
    wet = dict.fromkeys(coolant_boundaries(network), float(cooling.get("inlet_C", INLET_C)))
    return {**th.rated_inputs(machine), **dict.fromkeys(air_boundaries(network), AMBIENT_C), **wet}


def columns_of(file: Path) -> dict[str, np.ndarray]:
    """The columns of a loss map as numbers."""
    if not file.is_file():
        raise InputError("no such file", f"--losses {file}", "a CSV file with a row per torque and speed")
    table = th.read_csv(file)
    out = {}
    for name in table.columns:
        values = [th.as_number(cell) for cell in table[name]]
        if (row := next((i for i, v in enumerate(values) if v is None or not np.isfinite(v)), None)) is not None:
            raise InputError(f"column '{name}' has no number in row {row + 2}", str(file), "numbers in every row")
        out[name] = np.array(values, float)
    return out
