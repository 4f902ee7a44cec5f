"""A drive cycle, cycles/NAME.toml: what the machine is to do, by columns, by a standard duty, or by a vehicle."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np

from geom.arrays import Array
from geom.constants import ALPHA_CU
from geom.description.toml_file import read_toml
from geom.errors import InputError
from geom.limits import INSTANTS
from lumped.drives.coupled import Drive, induction_drive, pm_drive, series_drive
from lumped.drives.drive import Controller, SeriesMachine, Vehicle
from lumped.drives.duty import s1, s2, s3, s6
from lumped.drives.induction import ALPHA_AL, InductionMachine
from lumped.drives.permanent_magnet import PMMachine
from lumped.integration.signals import Signals
from lumped.integration.simulate import Record
from lumped.model.network import Network
from lumped.schemas.reader import Table, suggestion
from lumped.sources.loss_laws import CopperLoss
from lumped.transfer.laws import Law
from measured.recordings.consistency import is_amount
from measured.recordings.grid import LEAST, bridged
from measured.recordings.sheet import read_sheet
from measured.recordings.tables import load_table

WINDING, MAGNET, CAGE = "winding", "magnet", "cage"
INDUCTION = "induction-machine"


@dataclass(frozen=True)
class Cycle:
    """record : what is known beforehand;  drive : gives the rest from the temperatures of the places it watches

    series : what a vehicle with a series machine is, where the cycle has one
    laws : source -> the loss that the drive's equivalent circuit has in place of the network's own
    notes : doubts about its file
    """

    name: str
    record: Record
    drive: Drive | None = None
    watched: Mapping[str, str] = field(default_factory=dict)
    series: "Series | None" = None
    laws: Mapping[str, Law] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def on(self, network: Network) -> Network:
        """The network with the losses that the drive brings."""
        sources = (replace(s, law=self.laws.get(s.name, s.law)) for s in network.sources)
        return replace(network, sources=tuple(sources)) if self.laws else network


@dataclass(frozen=True)
class Series:
    """target_mps (nt,), slope (nt,) rise over run;  reference_degC : of the machine's resistance"""

    machine: SeriesMachine
    vehicle: Vehicle
    controller: Controller
    target_mps: Array
    slope: Array
    reference_degC: float


def find_cycle(case: Path, name: str) -> Path:
    """A cycle by its file, or by its name in the case's folder cycles/."""
    if Path(name).is_file():
        return Path(name)
    here = {p.stem: p for p in sorted((case / "cycles").glob("*.toml"))}
    if name not in here:
        raise InputError("no such cycle", name, suggestion(name, here or ["a file, or cycles/NAME.toml in the case"]))
    return here[name]


def load_cycle(path: Path, network: Network, ratings: Mapping[str, float]) -> Cycle:
    """A cycle for a network; ratings: of the machine file, for what the cycle does not say of a series machine."""
    top = Table(read_toml(path, "a cycle: [cycle], and [columns.NAME] or [duty]"), str(path))
    head = top.table("cycle")
    head.word("description", "")
    step = head.number("step_s", 1.0)
    columns = None if "duty" in top else _columns(path, top, head)
    time, inputs, boundaries = _duty(top) if columns is None else columns.every(step, str(path))
    inputs |= _constants(top, "inputs", time, inputs)
    boundaries |= _constants(top, "boundaries", time, boundaries)
    for name in boundaries:
        if name not in network.boundaries:
            raise top.error(f"no boundary is called '{name}'", suggestion(name, network.boundaries))
    start = head.number("initial_degC", _usual(network, boundaries, str(path)))
    drive, places, series, laws = _drive(top, network, ratings, time, inputs)
    head.close()
    top.close()
    if columns is not None and drive is None:
        inputs = columns.signals(inputs, time)
    notes = (*(columns.notes if columns is not None else ()), *_unread(network, inputs, drive, str(path)))
    cycle = Cycle(path.stem, Record(time, inputs, boundaries, start), drive, places, series, laws, notes)
    _complete(cycle.on(network), cycle, str(path))
    return cycle


def _constants(top: Table, key: str, time: Array, columns: Mapping[str, Array]) -> dict[str, Array]:
    """What stays as it is; InputError for what the columns or the duty give already."""
    constants = top.table(key).constants(key)
    for name in constants:
        if name in columns:
            raise top.error(f"'{name}' is given twice", f"[{key}] {name}, or a column or [load] of that name")
    return {name: np.full(time.size, value) for name, value in constants.items()}


def _unread(network: Network, inputs: Mapping[str, Array], drive: Drive | None, where: str) -> Iterator[str]:
    """Notes on inputs that no law reads; InputError for a negative power that a loss would take the amount of."""
    for name, values in inputs.items():
        if drive is None and name not in network.inputs:
            yield f"{where}: no law of the model reads '{name}'"
        if values.min() < 0.0 and is_amount(network, name):
            what = f"{values.min():g} is negative, and the loss that reads '{name}' would heat by it"
            raise InputError(what, where, "a power that is not negative")


def _usual(network: Network, boundaries: Mapping[str, Array], where: str) -> float:
    for name in network.boundaries:
        if name not in boundaries:
            right = f'[boundaries] {name} = ..., or a temperature column with place = "{name}"'
            raise InputError(f"nothing gives the boundary '{name}'", where, right)
    return float(np.mean([boundaries[name][0] for name in network.boundaries]))


@dataclass(frozen=True)
class Columns:
    """A cycle's table as recorded: time (n,) s, inputs and boundaries (n,).  notes : doubts about it"""

    time: Array
    inputs: dict[str, Array]
    boundaries: dict[str, Array]
    notes: tuple[str, ...]

    def every(self, step: float, where: str) -> tuple[Array, dict[str, Array], dict[str, Array]]:
        """Time, inputs and boundaries at steps (s)."""
        _counted(float(self.time[-1]) / step + 1.0, where)
        time = np.arange(0.0, self.time[-1] + 1e-9, step)

        def at(of: dict[str, Array]) -> dict[str, Array]:
            return {n: np.interp(time, self.time, u) for n, u in of.items()}

        return time, at(self.inputs), at(self.boundaries)

    def signals(self, inputs: Mapping[str, Array], time: Array) -> Signals:
        """Inputs at some times that keep what was recorded between these; those that were not recorded are constant."""
        fine = {n: self.inputs.get(n, np.full(self.time.size, u[0])) for n, u in inputs.items()}
        return Signals.recorded(fine, self.time, time)


def _columns(path: Path, top: Table, head: Table) -> Columns:
    """Inputs and boundaries of the cycle's table."""
    keys = {key: head.raw(key) for key in ("time", "time_unit", "period_s", "worksheet") if key in head}
    sheet = read_sheet({"cycle": keys, "columns": top.raw("columns", {})}, str(path), path.parent, "cycle")
    samples = load_table(path.parent / head.word("file", f"{path.stem}.csv"), sheet)
    inputs: dict[str, Array] = {}
    boundaries: dict[str, Array] = {}
    for c in sheet.columns:
        where = f"{samples.file} column '{c.header}'"
        values = bridged(samples.time, samples.values[c.name], sheet.max_gap_s, where)
        (boundaries if c.is_temperature else inputs)[c.place if c.is_temperature else c.feeds] = values
    return Columns(samples.time, inputs, boundaries, samples.notes)


def _counted(instants: float, where: str) -> None:
    """A cycle has so many instants that a run of it makes sense and fits into memory."""
    if not LEAST <= instants <= INSTANTS.most:
        right = f"{LEAST} to {INSTANTS.most:,} ({INSTANTS.variable}): check step_s and time_unit"
        raise InputError(f"the cycle has {instants:.3g} instants", where, right)


def _duty(top: Table) -> tuple[Array, dict[str, Array], dict[str, Array]]:
    """IEC 60034-1 duty types: every input of [load] times the load."""
    t, load = top.table("duty"), top.table("load")
    kind, step = t.word("type", None, ("S1", "S2", "S3", "S6")), t.number("step_s", 10.0)
    if kind == "S1":
        of: tuple[float, ...] = (t.number("duration_s"),)
        duty: Callable[..., tuple[Array, Array]] = partial(s1, *of)
    elif kind == "S2":
        of = t.number("on_s"), t.number("rest_s")
        duty = partial(s2, *of)
    else:
        period, part, cycles = t.number("period_s"), t.number("duty_percent") / 100, int(t.number("cycles"))
        of = (period * cycles,)
        duty = partial(s3, period, part, cycles)
        if kind != "S3":
            duty = partial(s6, period, part, cycles, t.number("no_load"))
        _counted(4.0 * cycles, t.where)
    _counted(max(sum(of) / step, LEAST), t.where)
    time, share = duty(step=step)
    inputs = {name: share * full for name, full in load.constants("load").items()}
    if not inputs:
        raise load.error("no input follows the duty", "[load] current_A = ... at full load")
    t.close()
    return time, inputs, {}


def _drive(
    top: Table, network: Network, ratings: Mapping[str, float], time: Array, inputs: dict[str, Array]
) -> tuple[Drive | None, dict[str, str], Series | None, dict[str, Law]]:
    kinds = [key for key in ("vehicle", "pm-machine", INDUCTION) if key in top]
    if len(kinds) > 1:
        raise top.error(f"[{kinds[0]}] and [{kinds[1]}] are two drives", "one of them")
    if "vehicle" in top:
        return (*_series(top, network, ratings, time, inputs), {})
    if INDUCTION in top:
        drive, places, laws = _induction(top, network, inputs)
        return drive, places, None, laws
    return (*_permanent(top, network, inputs), None, {}) if "pm-machine" in top else (None, {}, None, {})


def _numbers(table: Table, **usual: float | None) -> list[float]:
    """Numbers of a table in this order, each what it usually is; None has to be given."""
    return [table.number(key, value) for key, value in usual.items()]


def _series(
    top: Table, network: Network, ratings: Mapping[str, float], time: Array, inputs: dict[str, Array]
) -> tuple[Drive, dict[str, str], Series]:
    m, v, c = top.table("series-machine"), top.table("vehicle"), top.table("controller")
    rated = [m.number(k, ratings.get(k)) for k in ("power_W", "speed_rpm", "voltage_V", "current_A")]
    values = _numbers(m, inductance_H=2e-3, inertia_kg_m2=2.0, friction_Nms=0.0)
    machine = SeriesMachine.from_ratings(*rated, L=values[0], J=values[1], B=values[2])
    body = _numbers(v, mass_kg=None, wheel_radius_m=None, gear=None, efficiency=0.95, rolling=0.01)
    vehicle = Vehicle(*body, *_numbers(v, drag_area_m2=3.0, air_density_kg_m3=1.2, brakes_m_s2=3.0, regeneration=0.0))
    control = Controller(
        *_numbers(c, Kp=40.0, Ki=4.0, current_limit_A=rated[3], voltage_limit_V=rated[2], current_lag_s=0.02)
    )
    places = _places(m, network, "winding", WINDING)
    reference = m.number("reference_degC", 20.0)
    for t in (m, v, c):
        t.close()
    for name in ("vehicle_speed_mps", "slope_percent"):
        if name not in inputs:
            raise v.error(f"nothing gives '{name}'", f'a column with input = "{name}", or [inputs] {name} = ...')
    slope = inputs["slope_percent"] / 100
    target_mps = inputs.pop("vehicle_speed_mps")
    drive = series_drive(machine, vehicle, control, time, target_mps, slope, reference)
    series = Series(machine, vehicle, control, np.asarray(target_mps, float), np.asarray(slope, float), reference)
    return _mixed(drive, {WINDING: places}), {p: p for p in places}, series


def _permanent(top: Table, network: Network, inputs: dict[str, Array]) -> tuple[Drive, dict[str, str]]:
    m = top.table("pm-machine")
    limits = dict.fromkeys(("R20_ohm", "Ld_H", "Lq_H", "psi_Vs", "current_limit_A", "voltage_limit_V"))
    poles, slope = int(m.number("pole_pairs")), m.number("alpha_B_1_K", -1.1e-3)
    machine = replace(PMMachine(poles, *_numbers(m, **limits)), alpha_B=slope)
    places = {WINDING: _places(m, network, "winding", WINDING), MAGNET: _places(m, network, "magnet", "rotor")}
    rms = m.word("current_A", "rms" if network.recovery is not None else "peak", ("rms", "peak")) == "rms"
    m.close()
    drive = pm_drive(machine, *_torque_and_speed(m, inputs), rms)
    return _mixed(drive, places), {p: p for shares in places.values() for p in shares}


def _torque_and_speed(m: Table, inputs: dict[str, Array]) -> tuple[Array, Array]:
    for name in ("torque_Nm", "speed_rpm"):
        if name not in inputs:
            raise m.error(f"nothing gives '{name}'", f'a column with input = "{name}", or [inputs] {name} = ...')
    return inputs.pop("torque_Nm"), inputs.pop("speed_rpm")


def _induction(top: Table, network: Network, inputs: dict[str, Array]) -> tuple[Drive, dict[str, str], dict[str, Law]]:
    m = top.table(INDUCTION)
    needed = ("Rs20_ohm", "Rr20_ohm", "Ls_leakage_H", "Lr_leakage_H", "Lm_H", "magnetising_A")
    numbers = _numbers(m, **dict.fromkeys((*needed, "current_limit_A", "voltage_limit_V")))
    slopes = _numbers(m, alpha_stator_1_K=ALPHA_CU, alpha_cage_1_K=ALPHA_AL)
    machine = InductionMachine(int(m.number("pole_pairs")), *numbers, *slopes)
    if machine.magnetising > machine.current_limit:
        what = f"magnetising_A = {machine.magnetising:g} is above current_limit_A = {machine.current_limit:g}"
        raise m.error(what, "less: the rated flux has to be within the current")
    places = {WINDING: _places(m, network, "winding", WINDING), CAGE: _places(m, network, "cage", CAGE)}
    # The copper of the equivalent circuit stands in place of what the network has for stator and cage.
    laws: dict[str, Law] = {
        _loss(m, network, "stator_loss", "copper"): CopperLoss(machine.Rs, ("current_A",), 3.0, machine.alpha_s),
        _loss(m, network, "cage_loss", "cage"): CopperLoss(machine.Rr, ("cage_current_A",), 3.0, machine.alpha_r),
    }
    m.close()
    drive = induction_drive(machine, *_torque_and_speed(m, inputs))
    return _mixed(drive, places), {p: p for shares in places.values() for p in shares}, laws


def _loss(table: Table, network: Network, key: str, usual: str) -> str:
    """The source that a key names."""
    names = [s.name.removeprefix("loss:") for s in network.sources if s.name.startswith("loss:")]
    if (name := table.word(key, usual)) not in names:
        raise table.error(f"{key}: the model has no loss '{name}'", suggestion(name, names))
    return f"loss:{name}"


def _places(table: Table, network: Network, key: str, usual: str) -> dict[str, float]:
    shares = table.shares(key) if key in table else {usual: 1.0}
    for place in shares:
        if place not in network.places:
            raise table.error(f"{key} at unknown place '{place}'", suggestion(place, network.places))
    if abs(sum(shares.values()) - 1.0) > 1e-9:
        raise table.error(f"shares of {key} sum to {sum(shares.values()):g}", "shares that sum to 1")
    return shares


def _mixed(drive: Drive, groups: Mapping[str, Mapping[str, float]]) -> Drive:
    """The drive, fed with weighted means of places."""
    return lambda T: drive({g: np.asarray(sum(s * T[p] for p, s in shares.items())) for g, shares in groups.items()})


def _complete(network: Network, cycle: Cycle, where: str) -> None:
    """Every input that a law reads is there."""
    have = set(cycle.record.inputs) | {"time_s"}
    if cycle.drive is not None:
        steady = {p: np.full(cycle.record.time.size, 20.0) for p in cycle.watched}
        have |= set(cycle.drive(steady))
    for item in network.elements:
        for name in item.law.reads:
            if name not in have:
                right = f'a column with input = "{name}", or [inputs] {name} = ...'
                what = f"nothing gives the input '{name}', which '{item.name}' of {network.title} needs"
                raise InputError(what, where, right)
