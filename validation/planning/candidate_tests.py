"""Candidate tests: those an engineer can be asked for, each made from a test at hand."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

from geom.arrays import Array
from geom.description.roles import Role
from lumped.model.network import Network
from lumped.model.sites import role
from measured.case import Test

OVERLOAD = 1.3  # of the root mean square current, for as long as a winding takes to follow
Inputs = dict[str, Array]
Change = Callable[[Array, Inputs, Inputs, Network], tuple[Inputs, Inputs]]


@dataclass(frozen=True)
class Experiment:
    """A change of a test's inputs and boundaries.

    needs : quantities it makes no sense without;  hours : time on the bench, for which the test at hand is repeated
    current_factor : of all currents, up to 1, so that nothing gets too hot: see permissible_current
    """

    name: str
    change: Change
    needs: tuple[str, ...] = ()
    hours: float = 4.0
    current_factor: float = 1.0

    def modified(self, test: Test, network: Network) -> Test:
        """The planned test; its channels have no readings yet."""
        base = repeated(test, self.hours)
        inputs, boundaries = self.change(base.time, dict(base.inputs), dict(base.boundaries), network)
        planned = replace(base, name=f"planned: {self.name}", inputs=inputs, boundaries=boundaries)
        return planned.scaled(dict.fromkeys(inputs_measuring(network, inputs, "current"), self.current_factor))


def repeated(test: Test, hours: float) -> Test:
    """A test driven again and again until the hours are over, once at least; nothing is read."""
    time = test.time - test.time[0]
    period = float(time[-1] + np.mean(np.diff(time)))
    n = max(time.size, round(3600.0 * hours / period * time.size))
    turn, at = np.divmod(np.arange(n), time.size)
    inputs = {k: np.asarray(v, float)[at] for k, v in test.inputs.items()}
    boundaries = {k: np.broadcast_to(np.asarray(v, float), time.shape)[at] for k, v in test.boundaries.items()}
    still = tuple(replace(c, y=np.zeros(n)) for c in test.channels)
    return replace(test, time=time[at] + period * turn, inputs=inputs, boundaries=boundaries, channels=still)


def inputs_measuring(network: Network, names: Iterable[str], quantity: str) -> list[str]:
    """The inputs of a quantity."""
    return [name for name in names if network.measures(name) == quantity]


def _set(**levels: float | Callable[[Array], Array]) -> Change:
    """Inputs of a quantity held at a number, or given as a function of time; those the machine lacks are left out."""

    def change(time: Array, inputs: Inputs, boundaries: Inputs, network: Network) -> tuple[Inputs, Inputs]:
        levels_in_time = {q: (v(time) if callable(v) else np.full_like(time, v)) for q, v in levels.items()}
        new = {name: v for q, v in levels_in_time.items() for name in inputs_measuring(network, inputs, q)}
        return {**inputs, **new}, boundaries

    return change


def _turning(speed: Callable[[Array], Array]) -> Change:
    """Speeds (rpm) given as a function of time, all lowered to what the record reaches, unless it only stands still."""

    def change(time: Array, inputs: Inputs, boundaries: Inputs, network: Network) -> tuple[Inputs, Inputs]:
        levels = speed(time)
        tops = {name: np.max(np.abs(inputs[name])) for name in inputs_measuring(network, inputs, "speed")}
        share = {name: min(top / levels.max(), 1.0) if top else 1.0 for name, top in tops.items()}
        return {**inputs, **{name: share[name] * levels for name in tops}}, boundaries

    return change


def _bars_off(time: Array, inputs: Inputs, boundaries: Inputs, network: Network) -> tuple[Inputs, Inputs]:
    """The currents of cages: bars that stand still under direct current carry none."""
    read = [(n, role(network, s.place)) for s in network.sources if s.kind == "copper" for n in s.law.reads]
    elsewhere = {n for n, of in read if of is not Role.CAGE}
    bars = [n for n in inputs_measuring(network, inputs, "current") if (n, Role.CAGE) in read and n not in elsewhere]
    return {**inputs, **{n: np.zeros_like(time) for n in bars}}, boundaries


def _even(factor: float) -> Change:
    """Currents held at a multiple of the root mean square of their records."""

    def change(time: Array, inputs: Inputs, boundaries: Inputs, network: Network) -> tuple[Inputs, Inputs]:
        currents = inputs_measuring(network, inputs, "current")
        rms = {k: np.full_like(time, factor * np.sqrt(np.mean(inputs[k] ** 2))) for k in currents}
        return {**inputs, **rms}, boundaries

    return change


def _then(*changes: Change) -> Change:
    def change(time: Array, inputs: Inputs, boundaries: Inputs, network: Network) -> tuple[Inputs, Inputs]:
        for one in changes:
            inputs, boundaries = one(time, inputs, boundaries, network)
        return inputs, boundaries

    return change


def _boundary_step(what: Role, rise: float) -> Change:
    def change(time: Array, inputs: Inputs, boundaries: Inputs, network: Network) -> tuple[Inputs, Inputs]:
        late = time > 0.4 * time[-1]
        return inputs, {k: v + rise * late if role(network, k) is what else v for k, v in boundaries.items()}

    return change


def _on_off(level: float, periods: int = 3) -> Callable[[Array], Array]:
    return lambda time: np.where((time * 2 * periods / (time[-1] + 1.0)).astype(int) % 2 == 0, level, 0.0)


def _half_time(time: Array, inputs: Inputs, boundaries: Inputs, network: Network) -> tuple[Inputs, Inputs]:
    """Currents switched off midway."""
    early, currents = time < 0.5 * time[-1], inputs_measuring(network, inputs, "current")
    return {k: v * early if k in currents else v for k, v in inputs.items()}, boundaries


def _fast_and_slow(time: Array, inputs: Inputs, boundaries: Inputs, network: Network) -> tuple[Inputs, Inputs]:
    """The highest speed of the record and a third of it in turn."""
    name = network.signal("speed")
    top = np.max(np.abs(inputs[name]))
    return {**inputs, name: top / 3.0 + _on_off(2.0 * top / 3.0, 2)(time)}, boundaries


def _half(quantity: str) -> Change:
    def change(time: Array, inputs: Inputs, boundaries: Inputs, network: Network) -> tuple[Inputs, Inputs]:
        halved = np.where(time > 0.5 * time[-1], 0.5, 1.0)
        return {**inputs, **{k: inputs[k] * halved for k in inputs_measuring(network, inputs, quantity)}}, boundaries

    return change


STILL = _then(_set(speed=0.0), _bars_off)
STANDING = _then(STILL, _set(vehicle_speed=0.0))
IDLE = _set(current=0.0, torque=0.0, vehicle_speed=0.0)
SPINNING = _then(IDLE, _turning(lambda time: np.full_like(time, 1000.0)))
COOLING = _then(STILL, _set(vehicle_speed=_on_off(12.0)))
BLOWN = _then(STILL, _set(vehicle_speed=_on_off(8.0)))
TWO_SPEEDS = _turning(_on_off(1500.0, 2))
EVEN, HEAVY = _even(1.0), _even(OVERLOAD)
CANDIDATE_TESTS = (
    Experiment("DC heating at standstill", _then(EVEN, STANDING), ("current",)),
    Experiment("spin without current", SPINNING, ("speed",)),
    Experiment("heating at standstill, then cooling down", _then(HEAVY, STANDING, _half_time), ("current",)),
    Experiment("no load, fast and slow", _then(IDLE, _fast_and_slow), ("speed",)),
    Experiment("same current at two speeds", _then(EVEN, TWO_SPEEDS), ("speed", "current")),
    Experiment("cool-down with wind on and off", COOLING, ("vehicle_speed",)),
    Experiment("blower on the machine at standstill", _then(EVEN, BLOWN), ("vehicle_speed", "current")),
    Experiment("fan flow halved midway", _half("air_flow"), ("air_flow",)),
    Experiment("ambient raised by 20 K", _boundary_step(Role.AMBIENT, 20.0), (), 8.0),
    Experiment("coolant inlet raised by 20 K", _boundary_step(Role.COOLANT, 20.0), (), 4.0),
    Experiment("bench plate heated by 20 K", _boundary_step(Role.TEST_BED, 20.0), (), 6.0),
)


def candidate_tests(test: Test, network: Network) -> list[tuple[Experiment, Test]]:
    """Experiments that change something on this machine, and the tests made from the one at hand."""
    measured = {network.measures(name) for name in test.inputs}
    possible = [(e, e.modified(test, network)) for e in CANDIDATE_TESTS if set(e.needs) <= measured]
    return [(e, new) for e, new in possible if _differ(new, repeated(test, e.hours))]


def _differ(new: Test, old: Test) -> bool:
    pairs = [(new.inputs, old.inputs), (new.boundaries, old.boundaries)]
    return any(not np.array_equal(a[k], b[k]) for a, b in pairs for k in b)
