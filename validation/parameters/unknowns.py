"""The unknowns of a fit: their coordinates, priors and bounds, and the nuisances every measurement brings along."""

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase

import numpy as np

from geom.arrays import Array
from lumped.model.network import Network, Parameter
from lumped.model.once import once
from lumped.transfer.laws import Law
from measured.case import Case, Channel, Model, Reference, Test
from measured.doubt import USUAL, Doubt, boundary_doubt
from measured.sensors.operators import of_measurement, start_target
from validation.effects.base import Effect, Scene
from validation.effects.registry import READ, effect, kinds, with_effects
from validation.effects.sensors.input_fault import Shift
from validation.effects.time_window import IN
from validation.parameters.model_form import with_model_form
from validation.parameters.reference import effect_sizes, reference_of, value_counts

LARGER = 10.0  # times the largest size that the catalogue looks for: a film of water where it looks for air
LARGE_NUISANCE = 2.0  # deviations: one nuisance in twenty goes so far by chance
NAMES = 2  # in a sentence
POWER_AT = re.compile(r"[-+.\de]+ at ")
POSSIBLE = 20.0  # deviations: what a thermometer is off by beyond them is not a reading, but another place
UNEVEN = 4.0  # deviations between the largest and the least of some ten that are equal
KINDS = {"capacity": "heat capacity of", "h": "film of", "loss": "loss of", "k": "conduction of"}
KINDS |= {"contact": "contact", "link": "link"}
POWERS = {"dT": "exponent of its difference", "T": "slope with temperature"}
FREE = 30.0  # prior deviations of what the data alone shall say: wide enough to leave no trace


@dataclass(frozen=True)
class Unknowns:
    """Free parameters in fitting coordinates: log(value / prior median) for "log", else value minus neutral.

    prior mean 0, prior sd `sd`, hard bounds `low`, `high`, all (p,)
    """

    parameters: tuple[Parameter, ...]

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(p.name for p in self.parameters)

    @property
    def sd(self) -> Array:
        return np.array([p.prior_sd for p in self.parameters])

    @property
    def bounds(self) -> tuple[Array, Array]:
        low = np.array([to_coordinate(p, p.low) for p in self.parameters])
        high = np.array([to_coordinate(p, p.high) for p in self.parameters])
        return low, high

    def coordinates(self, values: Mapping[str, float]) -> Array:
        return np.array([to_coordinate(p, values.get(p.name, p.value)) for p in self.parameters])

    def values(self, theta: Array) -> dict[str, float]:
        return {p.name: to_value(p, float(t)) for p, t in zip(self.parameters, theta, strict=True)}


def to_coordinate(p: Parameter, value: float) -> float:
    return float(np.log(max(value, 1e-300) / p.value)) if p.mapping == "log" else value - p.neutral


def to_value(p: Parameter, theta: float) -> float:
    return p.value * float(np.exp(theta)) if p.mapping == "log" else p.neutral + theta


def nuisances(network: Network, tests: Sequence[Test], doubt: Doubt = USUAL) -> list[Parameter]:
    """What no measurement is free of: bias, slope and lag of sensors, bias of boundary sensors, start, clock."""
    channels: dict[str, list[Channel]] = {}
    for c in (c for test in tests for c in test.channels):
        channels.setdefault(c.name, []).append(c)
    boundaries = dict.fromkeys(b for test in tests for b in test.boundaries)
    sensors = [p for same in channels.values() for p in _sensor(network, same, doubt)]
    air = [
        _offset(f"bias of {b}", f"boundary:{b}", boundary_doubt(doubt, b), "sensor of the boundary") for b in boundaries
    ]
    start = [_offset(f"start of {t.name}", f"initial:{t.name}", doubt["start"], "uneven start") for t in tests]
    clocks = [_offset(f"clock of {t.name}", f"delay:{t.name}", clock(t, doubt), "logger's clock", "s") for t in tests]
    return [*sensors, *air, *start, *clocks, *(p for t in tests for p in hidden_starts(network, t, doubt))]


def hidden_starts(network: Network, test: Test, doubt: Doubt = USUAL) -> list[Parameter]:
    """The temperature at which each state without a sensor begins a test, above the mean of those with one (K).

    Where these and the boundaries agree, the machine was at rest and nothing is open. Where not, something went before:
    what nobody sees may lie anywhere between them, and as far outside.
    """
    if not isinstance(test.initial, Mapping):
        return []
    first = [*test.initial.values(), *(float(np.ravel(u)[0]) for u in test.boundaries.values())]
    spread, sigma = max(first) - min(first), max((c.sigma_K for c in test.channels), default=0.0)
    if spread <= UNEVEN * float(np.hypot(doubt["start"], sigma)):
        return []
    read = {int(i) for c in test.channels for i in c.row.index[c.row.weights != 0.0]}
    read |= {network.column(network.places[n].part if n in network.places else n) for n in test.initial}
    return [
        _offset(start_name(n, test.name), start_target(test.name, n), spread, "what went before")
        for i, n in enumerate(network.states)
        if i not in read and "#" not in n and network.C[i] > 0.0
    ]


def start_name(state: str, test: str) -> str:
    """What the start of a state in a test is called among the parameters."""
    return f"start of {state} in {test}"


def of_hidden_start(p: Parameter) -> bool:
    """Does it say where a state without a sensor began a test? No reading does."""
    target, whole = p.targets[0][0], f"initial:{p.name.removeprefix('start of ')}"
    return target.startswith("initial:") and target != whole


OF_MEASUREMENT = ("bias", "slope", "lag", "start", "clock")  # first words of the names that `nuisances` gives


def measured(name: str) -> bool:
    """Is it the name of a parameter of a sensor, boundary, start or clock, whether or not its test is there?"""
    kind, separator, _ = name.partition(" of ")
    return bool(separator) and kind in OF_MEASUREMENT


def sorted_unknowns(unknowns: Unknowns, effects: Collection[str]) -> tuple[Unknowns, Unknowns, Unknowns]:
    """Sizes and exponents of effects; the machine's own, with where began what no sensor sees; and what belongs to its
    sensors, boundaries and clocks."""
    names = tuple(f"{name}^" for name in effects)
    causes = [p for p in unknowns.parameters if p.name in effects or p.name.startswith(names)]
    others = [p for p in unknowns.parameters if measured(p.name) and not of_hidden_start(p)]
    machine = [p for p in unknowns.parameters if p not in causes and p not in others]
    return Unknowns(tuple(causes)), Unknowns(tuple(machine)), Unknowns(tuple(others))


def clock(test: Test, doubt: Doubt) -> float:
    """Standard deviation (s) of a test's clock: the recorder's, and of steps that lie anywhere between two samples."""
    return float(np.hypot(doubt["clock"], doubt["step in sample"] * test.step_s))


def _sensor(network: Network, same: Sequence[Channel], doubt: Doubt) -> list[Parameter]:
    """Of one sensor, as it is declared in each of its tests. Its lag is below zero in none of them."""
    c, lags = same[0], [c.lag_s for c in same]
    sigma = min(max(c.sigma_K for c in same), doubt.get(f"bias:{c.name}", np.inf))
    bias = _offset(f"bias of {c.name}", f"bias:{c.name}", sigma, "calibration of the sensor")
    place = network.places.get(c.place)
    of = " of stream" if place and place.kind == "fluid" else " of reading" if place and place.reading else ""
    sd = doubt[f"gain{of}"]
    gain = _offset(f"slope of {c.name}", f"gain:{c.name}", sd, "placement of the sensor")
    lag = _offset(f"lag of {c.name}", f"lag:{c.name}", max(doubt["lag"], 0.3 * max(lags)), "mounting of the sensor")
    return [bias, replace(gain, unit="1"), replace(lag, unit="s", low=-min(lags))]


def _offset(name: str, target: str, sd: float, source: str, unit: str = "K") -> Parameter:
    return Parameter(
        name,
        ((target, 1.0),),
        value=0.0,
        unit=unit,
        low=-POSSIBLE * sd,
        high=POSSIBLE * sd,
        prior_sd=sd,
        mapping="offset",
        neutral=0.0,
        source=source,
    )


def scene_of(case: Case) -> Scene:
    """What the case's tests record; an input counts when every test that is fitted or chosen with has it."""
    tests = case.usable or case.tests
    inputs = frozenset().union(*(frozenset(t.inputs) for t in tests)) | {"time_s"}
    channels = tuple(dict.fromkeys(c.name for t in tests for c in t.channels))
    return Scene(case.model.network, inputs, channels, tuple(t.name for t in tests))


def effects_of(case: Case) -> tuple[Effect, ...]:
    return tuple(effect(e.name) for e in case.model.effects)


def case_reference(case: Case) -> Reference:
    """What the model has stored, and of what it has not yet met what the tests that a fit may use say."""
    stored = case.model.reference or Reference()
    names = [e.name for e in case.model.effects]
    new = reference_of(with_effects(case.model.network, effects_of(case), ()), case.usable, names)
    levels = stored.levels
    signals = {n: replace(one, level=levels.get(n, one.level)) for n, one in new.signals.items()}
    sizes = {**new.sizes, **stored.sizes}
    return replace(new, signals={**stored.signals, **signals}, sizes=sizes, errors=stored.errors)


def standing_reference(case: Case) -> Reference:
    """What the model has stored; before the first fit, and where an old file lacks it, what a fit would store."""
    return case.model.reference or case_reference(case)


def at_level(network: Network, names: Collection[str], reference: Reference) -> Network:
    """The network with the priors and bounds of effects for the size that they have at a reference.

    Declared for a loss's own reference (1000 rpm, 100 A), they would be a hundred times too narrow on a motor of 10 A.
    Those of an input's offset are shares of its level. What is not a power, such as a temperature coefficient, has a
    prior that nothing changes.
    """
    laws: dict[str, Law] = {x.name: x.law for x in network.links}
    laws |= {s.name: s.law for s in network.sources}

    def scaled(p: Parameter) -> Parameter:
        law = laws.get(p.targets[0][0]) if p.name in names and p.targets else None
        if isinstance(law, Shift):
            f = reference.levels.get(law.input, 1.0)
            return p if f == 1.0 else replace(p, prior_sd=f * p.prior_sd, low=f * p.low, high=f * p.high)
        size = reference.sizes.get(p.name, 1.0) if p.name in names else 1.0
        return p if size == 1.0 else replace(p, prior_sd=p.prior_sd / size, high=p.high / size)

    return replace(network, parameters=tuple(map(scaled, network.parameters)))


def possible(network: Network, names: Collection[str], doubt: Doubt) -> Network:
    """The network with effects that put a boundary off no larger than its doubt allows.

    Declared for the usual doubt: where the case knows better, the prior narrows with it.
    """

    def within(p: Parameter) -> Parameter:
        kind, _, boundary = p.targets[0][0].partition(":") if p.targets else ("", "", "")
        if p.name not in names or kind != "boundary":
            return p
        sd = boundary_doubt(doubt, boundary.partition(IN)[0])
        most = POSSIBLE * sd
        prior = p.prior_sd * sd / doubt["boundary"]
        return replace(p, prior_sd=prior, low=max(p.low, -most), high=min(p.high, most))

    return replace(network, parameters=tuple(map(within, network.parameters)))


def freed(network: Network, names: Collection[str]) -> Network:
    """The network with the data alone to say how large some effects are.

    The prior of an effect speaks of machines at large. For one that is in the model because the readings ask for it, it
    would press the rest of the effect into whatever else may move.
    """
    return replace(network, parameters=tuple(unbound(p) if p.name in names else p for p in network.parameters))


def unbound(p: Parameter) -> Parameter:
    """A parameter that the data decide, beyond the bound of its usual size too, which no physics sets for what is
    counted in watts; shares and factors keep theirs."""
    return replace(widened(p), high=LARGER * p.high if p.unit.startswith("W") else p.high)


def widened(parameter: Parameter) -> Parameter:
    """A parameter with so wide a prior that the data decide."""
    return replace(parameter, prior_sd=FREE * parameter.prior_sd)


def working(case: Case, more: Sequence[Effect] = ()) -> tuple[Network, Unknowns]:
    """The network to fit with: the model's effects, `more` effects and measurement nuisances, and what is free in it.

    Free are the case's nuisances (all declared parameters when it names none), the effects and the measurement's.
    Exponents are those that the model has and those that the tests tell of. What a model says is asked of `standing`.
    Of a case alone it is one network, so what is known of it and of its laws serves again.
    """
    return _to_fit(case, more) if more else _to_fit_alone(case)


@once
def _to_fit_alone(case: Case) -> tuple[Network, Unknowns]:
    return _to_fit(case, ())


def _to_fit(case: Case, more: Sequence[Effect]) -> tuple[Network, Unknowns]:
    reference = case_reference(case)
    network, forms = _grown(case, reference, more, value_counts(case.usable))
    free = {p.name for p in (case.nuisances or case.model.network.parameters)} | set(forms)
    free |= {e.name for e in (*effects_of(case), *more)}
    return network, Unknowns(tuple(p for p in network.parameters if p.name in free or of_measurement(p)))


@once
def standing(case: Case) -> Network:
    """The network as the model stands, with the exponents that were fitted and at the reference stored with them.

    No test has a say in it; only sensors and clocks, which no temperature depends on, are those of the tests.
    """
    return _grown(case, standing_reference(case), (), {})[0]


def _grown(
    case: Case, reference: Reference, more: Sequence[Effect], counts: Mapping[str, int]
) -> tuple[Network, tuple[str, ...]]:
    """The network with effects, form and measurement nuisances; the names of what gives laws another form."""
    inside = effects_of(case)
    network, added = with_effects(case.model.network, inside, more), {e.name for e in inside}
    sizes = effect_sizes(network, {e.name for e in more} - added, case.usable)
    reference = replace(reference, sizes={**reference.sizes, **sizes})
    network = at_level(network, added.union(e.name for e in more), reference)
    network = freed(possible(network, added.union(e.name for e in more), case.doubt), added)
    network, forms = with_model_form(network, reference.levels, counts, case.model.values, added, case.doubt)
    sensors = nuisances(case.model.network, case.tests, case.doubt)
    return replace(network, parameters=(*network.parameters, *sensors)), forms


def large_nuisances(case: Case) -> list[tuple[str, float, str, float]]:
    """What a fit moved beyond two deviations that is not the machine's size, but sensor, boundary, start, clock or the
    exponent of a law: name, value, unit, deviations; most strained first."""
    unknowns = working(replace(case, tests=case.fitted or case.tests))[1] if case.model.values else Unknowns(())
    values = case.model.values
    rows = [
        (p.name, values[p.name], p.unit, float(z))
        for p, z in zip(unknowns.parameters, unknowns.coordinates(values) / unknowns.sd, strict=True)
        if p.name in values and abs(z) > LARGE_NUISANCE and (of_measurement(p) or "^" in p.name)
    ]
    return sorted(rows, key=lambda row: -abs(row[3]))


def strain_words(case: Case) -> str:
    """That, said before a verdict, which rests on it, and right after a finding; "" where nothing is strained."""
    rows, times = large_nuisances(case), " times the usual deviation"
    each = [
        f"{_value_words(name, value, unit)} ({abs(z):.1f}{times * (i == 0)})"
        for i, (name, value, unit, z) in enumerate(rows[:NAMES])
    ]
    more = f" and {len(rows) - NAMES} more" if len(rows) > NAMES else ""
    return f"The fit moved {', '.join(each)}{more}." if each else ""


def _value_words(name: str, value: float, unit: str) -> str:
    """How far a parameter moved."""
    law, power = parameter_words(name)
    shift = f"the {law} by {value:+.3g} {unit.removesuffix('1')}".strip()
    return f"the {power} in the {law} by {value:+.2g}" if power else shift


def parameter_words(name: str) -> tuple[str, str]:
    """What a value scales and what of it, if it is a power: ("loss of iron", "exponent of speed rpm"), ("film of gap",
    ""); an effect's statement; a name that was chosen freely as it is."""
    kind, at, _ = name.partition("@")
    law, powered, exponent = name.partition("^") if kind not in READ else name.rpartition("^")
    if kind in READ and (not powered or POWER_AT.match(exponent)):  # a power that belongs to its place
        law, powered = name, ""
    if at and kind in {**kinds(), **READ}:
        law = effect(law).statement
        return law, _power_words(exponent) if powered else ""
    kind, dot, place = law.partition(".")
    if dot and kind in KINDS:
        law = f"{KINDS[kind]} {place}".replace("|", " - ").replace(":", ", share of ")
    return law, _power_words(exponent) if powered else ""


def _power_words(exponent: str) -> str:
    return POWERS.get(exponent, f"exponent of {exponent}".replace("_", " "))


def value_words(name: str) -> str:
    """A value of the model as an engineer says it: "heat capacity of rotor"; of an effect its statement."""
    law, power = parameter_words(name)
    return f"{law}, {power}" if power else law


def with_model(case: Case, model: Model) -> Case:
    return replace(case, model=model)


def matching(network: Network, patterns: Sequence[str]) -> tuple[Parameter, ...]:
    """Parameters whose names match any of the globs."""
    return tuple(p for p in network.parameters if any(fnmatchcase(p.name, g) for g in patterns))
