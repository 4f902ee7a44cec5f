"""The engineer's menu of tests: each made from a test at hand, and how far it would set rivals apart."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from validation.case import Test
from validation.evidence import Evidence
from validation.findings import NextTest
from validation.score import gram, score, total
from validation.sheet import segments

Array = NDArray[np.float64]
DECISIVE = 20.0
Inputs = dict[str, Array]


@dataclass(frozen=True)
class Experiment:
    """A change of a test's inputs and boundaries.

    needs : inputs without which it makes no sense;  hours : time on the bench
    """

    name: str
    change: Callable[[Array, Inputs, Inputs], tuple[Inputs, Inputs]]
    needs: tuple[str, ...] = ()
    hours: float = 2.0

    def made_from(self, test: Test) -> Test:
        inputs = {k: np.array(v, float) for k, v in test.inputs.items()}
        boundaries = {k: np.array(np.broadcast_to(v, test.time.shape), float) for k, v in test.boundaries.items()}
        inputs, boundaries = self.change(test.time, inputs, boundaries)
        still = tuple(replace(c, y=np.zeros_like(test.time)) for c in test.channels)
        return replace(test, name=f"planned: {self.name}", inputs=inputs, boundaries=boundaries, channels=still)


def _set(**levels: float | Callable[[Array], Array]) -> Callable[[Array, Inputs, Inputs], tuple[Inputs, Inputs]]:
    """Inputs held at a number, or given as a function of time; those the machine lacks are left out."""

    def change(time: Array, inputs: Inputs, boundaries: Inputs) -> tuple[Inputs, Inputs]:
        new = {k: (v(time) if callable(v) else np.full_like(time, v)) for k, v in levels.items() if k in inputs}
        return {**inputs, **new}, boundaries

    return change


def _steady(name: str) -> Callable[[Array, Inputs, Inputs], tuple[Inputs, Inputs]]:
    """An input held at the root mean square of its record, all others as they are."""

    def change(time: Array, inputs: Inputs, boundaries: Inputs) -> tuple[Inputs, Inputs]:
        return {**inputs, name: np.full_like(time, np.sqrt(np.mean(inputs[name] ** 2)))}, boundaries

    return change


def _then(*changes: Callable) -> Callable[[Array, Inputs, Inputs], tuple[Inputs, Inputs]]:
    def change(time: Array, inputs: Inputs, boundaries: Inputs) -> tuple[Inputs, Inputs]:
        for one in changes:
            inputs, boundaries = one(time, inputs, boundaries)
        return inputs, boundaries

    return change


def _boundary_step(word: str, rise: float) -> Callable[[Array, Inputs, Inputs], tuple[Inputs, Inputs]]:
    def change(time: Array, inputs: Inputs, boundaries: Inputs) -> tuple[Inputs, Inputs]:
        late = time > 0.4 * time[-1]
        return inputs, {k: v + rise * late if word in k else v for k, v in boundaries.items()}

    return change


def _on_off(level: float, periods: int = 3) -> Callable[[Array], Array]:
    return lambda time: np.where((time * 2 * periods / (time[-1] + 1.0)).astype(int) % 2 == 0, level, 0.0)


def _half(scale: str) -> Callable[[Array, Inputs, Inputs], tuple[Inputs, Inputs]]:
    def change(time: Array, inputs: Inputs, boundaries: Inputs) -> tuple[Inputs, Inputs]:
        return {**inputs, scale: inputs[scale] * np.where(time > 0.5 * time[-1], 0.5, 1.0)}, boundaries

    return change


STANDING = _set(speed_rpm=0.0, vehicle_speed_mps=0.0)
SPINNING = _set(current_A=0.0, torque_Nm=0.0, speed_rpm=1000.0, vehicle_speed_mps=0.0)
COOLING = _set(vehicle_speed_mps=_on_off(12.0), speed_rpm=0.0)
BLOWN = _set(vehicle_speed_mps=_on_off(8.0), speed_rpm=0.0)
TWO_SPEEDS = _set(speed_rpm=_on_off(1500.0, 2))
EVEN = _steady("current_A")
MENU = (
    Experiment("DC heating at standstill", _then(EVEN, STANDING), ("current_A",)),
    Experiment("spin without current", SPINNING, ("speed_rpm",)),
    Experiment("same current at two speeds", _then(EVEN, TWO_SPEEDS), ("speed_rpm", "current_A")),
    Experiment("cool-down with wind on and off", COOLING, ("vehicle_speed_mps",)),
    Experiment("blower on the machine at standstill", _then(EVEN, BLOWN), ("vehicle_speed_mps", "current_A")),
    Experiment("fan flow halved midway", _half("fan_flow_m3h"), ("fan_flow_m3h",)),
    Experiment("ambient raised by 20 K", _boundary_step("ambient", 20.0), (), 6.0),
    Experiment("coolant inlet raised by 20 K", _boundary_step("coolant", 20.0), (), 3.0),
    Experiment("bench plate heated by 20 K", _boundary_step("bench", 20.0), (), 4.0),
)  # fmt: skip


def possible(test: Test) -> list[Experiment]:
    """Experiments that change something on this machine."""
    out = []
    for e in MENU:
        if set(e.needs) <= set(test.inputs):
            new = e.made_from(test)
            same = all(np.array_equal(new.inputs[k], v) for k, v in test.inputs.items())
            fixed = all(
                np.array_equal(new.boundaries[k], np.broadcast_to(v, test.time.shape))
                for k, v in test.boundaries.items()
            )
            if not (same and fixed):
                out.append(e)
    return out


def next_tests(
    evidence: Evidence, members: Sequence[int], amplitude: Mapping[int, float], kappa: Array
) -> list[NextTest]:
    """Tests that separate the members, best gain per hour first.

    Gain: the smallest deviance, over all pairs, by which the wrong one would fit worse with the new test added.
    """
    base = evidence.tests[-1]
    out = []
    for experiment in possible(base):
        gaps = separation(evidence, experiment.made_from(base), members, amplitude, kappa)
        apart = tuple(f"{evidence.names[k]} / {evidence.names[m]}" for (k, m), g in gaps.items() if g >= DECISIVE)
        out.append(NextTest(experiment.name, apart, float(min(gaps.values())), experiment.hours))
    return sorted(out, key=lambda t: -t.predicted_gain / t.hours)


def separation(
    evidence: Evidence, planned: Test, members: Sequence[int], amplitude: Mapping[int, float], kappa: Array
) -> dict[tuple[int, int], float]:
    """For every pair the deviance gap with the planned test added: a^2 V_kk (1 - c_kl^2) / kappa^2, the smaller way."""
    fit, p, chosen = evidence.fit, len(evidence.fit.unknowns.parameters), list(members)
    columns = (*fit.unknowns.parameters, *(evidence.parameters[k] for k in chosen))
    parts = segments(evidence.network, [planned], fit.values, columns)
    G = total(evidence.grams)
    seen = replace(G, JZ=G.JZ[:, chosen], ZZ=G.ZZ[np.ix_(chosen, chosen)], Zr=G.Zr[chosen])
    both = seen + gram(parts, fit.noise, p)[planned.name]
    s = score(both, fit.theta, fit.unknowns.sd, evidence.score.sign[chosen])
    V, c = np.diag(s.V), s.cosine
    out = {}
    for i, j in combinations(range(len(chosen)), 2):
        strength = min(amplitude[chosen[x]] ** 2 * V[x] / kappa[chosen[x]] ** 2 for x in (i, j))
        out[chosen[i], chosen[j]] = float(strength * (1.0 - c[i, j] ** 2))
    return out
