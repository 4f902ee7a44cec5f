"""The unknowns of a fit: their coordinates, priors and bounds, and the nuisances every measurement brings along."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase

import numpy as np
from numpy.typing import NDArray

from lumped.model.network import Network, Parameter
from lumped.model.once import once
from lumped.transfer.laws import Law
from validation.case import Case, Channel, Model, Test
from validation.doubt import USUAL, Doubt
from validation.effects import Effect, Scene, effect, extended
from validation.effects.sensors.input_offset import Shift
from validation.parameters.model_form import levels, with_model_form

Array = NDArray[np.float64]
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
    air = [_offset(f"bias of {b}", f"boundary:{b}", doubt["boundary"], "sensor of the boundary") for b in boundaries]
    start = [_offset(f"start of {t.name}", f"initial:{t.name}", doubt["start"], "uneven start") for t in tests]
    clocks = [_offset(f"clock of {t.name}", f"delay:{t.name}", clock(t, doubt), "logger's clock", "s") for t in tests]
    return [*sensors, *air, *start, *clocks]


def clock(test: Test, doubt: Doubt) -> float:
    """Standard deviation (s) of a test's clock: the recorder's, and of steps that lie anywhere between two samples."""
    return float(np.hypot(doubt["clock"], doubt["step in sample"] * test.step_s))


def _sensor(network: Network, same: Sequence[Channel], doubt: Doubt) -> list[Parameter]:
    """Of one sensor, as it is declared in each of its tests. Its lag is below zero in none of them."""
    c, lags = same[0], [c.lag_s for c in same]
    bias = _offset(f"bias of {c.name}", f"bias:{c.name}", max(c.sigma_K for c in same), "calibration of the sensor")
    stream = c.place in network.places and network.places[c.place].kind == "fluid"
    sd = doubt["gain of stream" if stream else "gain"]
    gain = _offset(f"slope of {c.name}", f"gain:{c.name}", sd, "placement of the sensor")
    lag = _offset(f"lag of {c.name}", f"lag:{c.name}", max(doubt["lag"], 0.3 * max(lags)), "mounting of the sensor")
    return [bias, replace(gain, unit="1"), replace(lag, unit="s", low=-min(lags))]


def _offset(name: str, target: str, sd: float, source: str, unit: str = "K") -> Parameter:
    return Parameter(
        name, ((target, 1.0),), value=0.0, unit=unit, low=-20 * sd, high=20 * sd, prior_sd=sd, mapping="offset",
        neutral=0.0, source=source,
    )  # fmt: skip


def scene_of(case: Case) -> Scene:
    """What the case's tests record; an input counts when every test that is fitted or chosen with has it."""
    tests = [t for t in case.tests if t.role != "hold-out"] or list(case.tests)
    inputs = frozenset.union(*(frozenset(t.inputs) for t in tests)) | {"time_s"}
    channels = tuple(dict.fromkeys(c.name for t in tests for c in t.channels))
    return Scene(case.model.network, inputs, channels, tuple(t.name for t in tests))


def effects_of(case: Case) -> tuple[Effect, ...]:
    return tuple(effect(e.name) for e in case.model.effects)


def at_level(network: Network, names: Collection[str], tests: Sequence[Test]) -> Network:
    """The network with the priors and upper bounds of losses that effects bring in for the heat in these tests.

    Declared for the loss's reference (1000 rpm, 100 A), they would be a hundred times too narrow on a motor of 10 A.
    Those of an input's offset are shares of its level. What is no power, such as a temperature coefficient, has a prior
    that no test changes.
    """
    network = _offsets_at_level(network, names, tests)
    laws = {s.name: s.law for s in network.sources}
    watts = [p for p in network.parameters if p.name in names and p.unit.split(" at ")[0] == "W"]
    mean = {p.name: _mean_factor([laws[t] for t, _ in p.targets if t in laws], tests) for p in watts}
    return replace(network, parameters=tuple(
        replace(p, prior_sd=p.prior_sd / f, high=p.high / f) if (f := mean.get(p.name, 0.0)) > 0 else p
        for p in network.parameters
    ))  # fmt: skip


def _offsets_at_level(network: Network, names: Collection[str], tests: Sequence[Test]) -> Network:
    laws: dict[str, Law] = {x.name: x.law for x in network.links}
    laws |= {s.name: s.law for s in network.sources}
    level = levels(tests)

    def scaled(p: Parameter) -> Parameter:
        law = laws.get(p.targets[0][0]) if p.name in names and p.targets else None
        f = level.get(law.input, 1.0) if isinstance(law, Shift) else 1.0
        return p if f == 1.0 else replace(p, prior_sd=f * p.prior_sd, low=f * p.low, high=f * p.high)

    return replace(network, parameters=tuple(scaled(p) for p in network.parameters))


def freed(network: Network, names: Collection[str]) -> Network:
    """The network with the data alone to say how large some effects are.

    The prior of an effect speaks of machines at large. For one that is in the model because the readings ask for it, it
    would press the rest of the effect into whatever else may move.
    """
    return replace(network, parameters=tuple(widened(p) if p.name in names else p for p in network.parameters))


def widened(parameter: Parameter) -> Parameter:
    """A parameter with so wide a prior that the data decide."""
    return replace(parameter, prior_sd=FREE * parameter.prior_sd)


def _mean_factor(laws: Sequence[Law], tests: Sequence[Test]) -> float:
    """Mean size of what the laws multiply an amplitude by; 0 where nothing is known."""
    factors = [np.abs(law.size(t.inputs)) for law in laws for t in tests if set(law.reads) <= set(t.inputs)]
    return float(np.mean([np.mean(f) for f in factors])) if factors else 0.0


def working(case: Case, more: Sequence[Effect] = ()) -> tuple[Network, Unknowns]:
    """The network with the model's effects, `more` effects and measurement nuisances, and what is free in it.

    Free are the case's nuisances (all declared parameters when it names none), the effects and the measurement's.
    Of a case alone it is one network, so what is known of it and of its laws serves again.
    """
    return _grown(case, more) if more else _as_it_stands(case)


@once
def _as_it_stands(case: Case) -> tuple[Network, Unknowns]:
    return _grown(case, ())


def _grown(case: Case, more: Sequence[Effect]) -> tuple[Network, Unknowns]:
    inside, extra = effects_of(case), nuisances(case.model.network, case.tests, case.doubt)
    network = extended(case.model.network, (*inside, *more))
    network = at_level(network, {e.name for e in (*inside, *more)}, case.tests)
    network = freed(network, {e.name for e in inside})
    network, forms = with_model_form(network, case.tests, {e.name for e in inside}, case.doubt)
    network = replace(network, parameters=(*network.parameters, *extra))
    names = {p.name for p in (case.nuisances or case.model.network.parameters)}
    names |= {e.name for e in (*inside, *more)} | {p.name for p in extra} | set(forms)
    return network, Unknowns(tuple(p for p in network.parameters if p.name in names))


def with_model(case: Case, model: Model) -> Case:
    return replace(case, model=model)


def matching(network: Network, patterns: Sequence[str]) -> tuple[Parameter, ...]:
    """Parameters whose names match any of the globs."""
    return tuple(p for p in network.parameters if any(fnmatchcase(p.name, g) for g in patterns))
