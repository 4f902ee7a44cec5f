"""A kind of machine with its tests and thermometers, and what its logger would have written."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from hidden.truth.body import Array, Body, Joint, Skeleton, skeleton
from hidden.truth.change import NOTHING, Change
from hidden.truth.draw import Draw, Listing
from hidden.truth.machine import Machine, Term
from hidden.truth.profile import air, between, fine_times, log_times
from hidden.truth.readings import Logger, Sensor, read, recorded, with_gaps

Edit = tuple[tuple[str, ...], float]


@dataclass(frozen=True)
class Plan:
    """A test: inputs (rng, times) -> name -> (n,) at the logging times. role as in a case."""

    name: str
    role: str
    minutes: float
    inputs: Callable[[np.random.Generator, Array], dict[str, Array]]


@dataclass(frozen=True)
class Spot:
    """Where on which body, 0 to 1."""

    body: str
    position: float


@dataclass(frozen=True)
class Hidden:
    """Something that can be hidden. name : in the generator's words;  make : the machine's change at amplitude a;
    largest : amplitude that nature allows;  least : what instruments of a bench may be off by without a fault

    declared : what the user's network has instead, (keys of the TOML file, value); then the machine is as it was drawn,
    `make` says what the network lacks, and its amplitude is the largest
    """

    name: str
    make: Callable[[float], Change]
    largest: float
    declared: tuple[Edit, ...] = ()
    least: float = 0.0


# A kind in our words -> what the catalogue calls it; a kind that is not here has the catalogue's own.
CATALOGUE = {
    "ac copper": ("copper.ac",),
    "blocked nozzles": ("nozzles",),
    "cover": ("blockage",),
    "draught": ("convection.constant",),
    "dust": ("fouling",),
    "friction": ("bearing.friction",),
    "harmonics": ("loss.winding",),
    "heat": ("loss.constant",),
    "inverter iron": ("iron.pwm",),
    "lamp": ("loss.constant",),
    "load loss": ("loss.rotor.load",),
    "meter": ("input.factor",),
    "road wind": ("convection",),
    "shaft fan": ("convection.fan", "convection.rotation"),
}


def no_tempco(loss: str) -> tuple[Edit, ...]:
    """The user's network has a loss of copper that does not follow its temperature."""
    return ((("losses", loss, "alpha_1_K"), 0.0),)


@dataclass(frozen=True, kw_only=True)
class Archetype:
    """A kind. bodies, joints, terms : of a machine, drawn around its drawing
    thermometers : where they really are, by the internal name of the place;  baths : measured boundaries

    missing : effects that can be hidden;  passing : those that can hold in one test or for a while
    foreign, faults, absorbed : (label, change from a seed) of the other classes
    tense : drawn parameters whose priors can be wrong;  doubted : sd of those that a user doubts otherwise than drawn
    parts : the user's nodes and the bodies they stand for;  called : internal name of a place or input -> the user's
    words : a hidden name of ours -> the names in the catalogue that are right, where CATALOGUE does not say so
    spans : the user's nodes that stand for a piece of their body, and from where to where (0 to 1) it reaches
    """

    name: str
    bodies: Callable[[Draw], Sequence[Body]]
    joints: Callable[[Draw], Sequence[Joint]]
    terms: Sequence[Callable[[Skeleton, Draw], Sequence[Term]]]
    plans: tuple[Plan, ...]
    thermometers: Mapping[str, Spot]
    missing: tuple[Hidden, ...]
    faults: Mapping[str, Callable[[int], Change]]
    foreign: Mapping[str, Callable[[int], Change]]
    absorbed: Mapping[str, Callable[[int], Change]]
    tense: tuple[str, ...]
    parts: Mapping[str, str]
    baths: Mapping[str, Spot] = field(default_factory=dict)
    doubted: Mapping[str, float] = field(default_factory=dict)
    passing: tuple[Hidden, ...] = ()
    logger: Logger = field(default_factory=Logger)
    called: Mapping[str, str] = field(default_factory=dict)
    words: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    spans: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def right(self, name: str) -> tuple[str, ...]:
        """The catalogue's names of a hidden effect, at the user's name of its place."""
        kind, _, place = name.partition("@")
        usual = tuple(f"{word}@{self.called.get(place, place)}" for word in CATALOGUE.get(kind, ()))
        return self.words.get(name) or usual or (name,)

    def spreads(self) -> dict[str, float]:
        """Every drawn parameter -> the sd of its logarithm."""
        listing = Listing(0)
        self.build(listing, NOTHING)
        return listing.asked

    def build(self, d: Draw, change: Change) -> Machine:
        """The machine of one draw with what is hidden in it."""
        s = skeleton([*self.bodies(d), *change.bodies], [*self.joints(d), *change.joints])
        return Machine(s, (*(term for part in self.terms for term in part(s, d)), *change.terms(s)))


@dataclass(frozen=True)
class Record:
    """One logged test. time (n,) s;  inputs, boundaries, readings : name -> (n,);  start : degC at the first instant"""

    name: str
    role: str
    time: Array
    inputs: Mapping[str, Array]
    boundaries: Mapping[str, Array]
    readings: Mapping[str, Array]
    start: float


@dataclass(frozen=True)
class Heated:
    """What happened in one test.  at : logging times (s);  fine : those of T (n_fine, cells) degC;  rng : goes on

    inputs : at the logging times;  driving : all that drives the machine, at the fine ones
    """

    machine: Machine
    at: Array
    fine: Array
    inputs: Mapping[str, Array]
    driving: Mapping[str, Array]
    T: Array
    rng: np.random.Generator

    def at_spot(self, spot: Spot) -> Array:
        """Temperature (degC) at a spot at the logging times."""
        return np.interp(self.at, self.fine, self.T[:, self.machine.skeleton.cell(spot.body, spot.position)])

    def mean(self, body: str, span: tuple[float, float] = (0.0, 1.0)) -> Array:
        """Mean temperature (degC) of a body, or of a piece of it, at the logging times; its cells are equal."""
        cells = self.machine.skeleton.cells(body)
        low, high = (end * cells.size for end in span)
        share = np.clip(
            np.minimum(np.arange(cells.size) + 1.0, high) - np.maximum(np.arange(cells.size), low), 0.0, 1.0
        )
        return np.interp(self.at, self.fine, self.T[:, cells] @ (share / share.sum()))


def measured(kind: Archetype, seed: int, change: Change, plans: tuple[Plan, ...] | None = None) -> tuple[Record, ...]:
    """All tests of one true machine."""
    return tuple(_logged(kind, plan, seed, change.during(plan.name)) for plan in plans or kind.plans)


def sensors(kind: Archetype, machine: Machine, draw: Draw, change: Change) -> list[Sensor]:
    return [_sensor(kind.logger, machine, name, spot, draw, change) for name, spot in kind.thermometers.items()]


def _sensor(logger: Logger, machine: Machine, name: str, spot: Spot, draw: Draw, change: Change) -> Sensor:
    rng = draw.stream(f"sensor {name}")
    position = float(np.clip(spot.position + logger.placed * rng.standard_normal(), 0.0, 0.999))
    cell = machine.skeleton.cell(spot.body, position)
    happens = (change.readings[name],) if name in change.readings else ()
    return Sensor(name, cell, logger.bias_K * rng.uniform(-1, 1), float(rng.uniform(*logger.lag)), happens)


def truly(kind: Archetype, plan: Plan, seed: int, change: Change) -> tuple[Array, dict[str, Array], dict[str, Array]]:
    """Logging times, inputs at them, and what drives the machine on the fine grid."""
    rng = np.random.default_rng([seed, *plan.name.encode()])
    at = log_times(plan.minutes, kind.logger.step)
    inputs = {**plan.inputs(rng, at), "T_ambient": air(at, rng)}
    fine = fine_times(at, kind.logger.fine)
    driving = {k: between(fine, at, k, v) for k, v in inputs.items()}
    driving |= {k: true(fine, driving[k]) for k, true in change.driven.items()}
    return at, inputs, {**driving, **{k: signal(fine) for k, signal in change.signals.items()}}


def heated(kind: Archetype, plan: Plan, seed: int, change: Change) -> Heated:
    """A true machine through one test, from a start that is uneven by what a night leaves."""
    machine, rng = kind.build(Draw(seed, change.factors), change), np.random.default_rng([seed, 1, *plan.name.encode()])
    at, inputs, driving = truly(kind, plan, seed, change)
    fine = fine_times(at, kind.logger.fine)
    start = float(driving["T_ambient"][0] + rng.uniform(-0.5, 1.0))
    T = machine.run(fine, driving, start + 0.2 * rng.standard_normal(machine.skeleton.C.size))
    return Heated(machine, at, fine, inputs, driving, T, rng)


def _logged(kind: Archetype, plan: Plan, seed: int, change: Change) -> Record:
    true, draw = heated(kind, plan, seed, change), Draw(seed, change.factors)
    machine, at, fine, inputs, T, rng = true.machine, true.at, true.fine, true.inputs, true.T, true.rng
    room = true.driving["T_ambient"]
    readings = {
        s.name: read(s, kind.logger, fine, T[:, s.cell], room, at, rng) for s in sensors(kind, machine, draw, change)
    }
    readings |= {name: shows(readings[name]) for name, shows in change.shown.items()}
    readings = with_gaps(readings, rng, kind.logger.missing)
    for a, b in change.swaps:
        readings[a], readings[b] = readings[b], readings[a]
    baths = {
        f"T_{name}": np.interp(at, fine, T[:, machine.skeleton.cell(spot.body, spot.position)])
        for name, spot in kind.baths.items()
    }
    shown = {k: change.inputs[k](at, v) if k in change.inputs else v for k, v in {**inputs, **baths}.items()}
    written = recorded(shown, kind.logger, rng)
    boundaries = {k[2:]: v for k, v in written.items() if k.startswith("T_")}
    first = float(np.median([y[np.isfinite(y)][0] for y in readings.values()]))
    return Record(
        plan.name,
        plan.role,
        at,
        {k: v for k, v in written.items() if not k.startswith("T_")},
        boundaries,
        readings,
        first,
    )
