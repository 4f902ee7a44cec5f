"""How far apart the instants may be at which readings and model are compared: what the record moves and a sensor feels.

A reading on the grid is the mean over a sample step h. The model's mean is made of three instants (`predict.softened`).
Where an input switches at an instant the two differ: of a mode with time constant tau and amplitude a by

    a g(h / tau),   g(x) = | 1/2 - (1 - exp(-x / 2)) / x - (1 - exp(-x)) / 12 | :   x / 24 for slow modes

The step is the largest at which no sensor differs, rms over a record, by more than a share of its standard deviation.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from geom.arrays import Array
from lumped.integration.assembly import Pattern, assembly
from lumped.integration.compiled import capacity_multipliers, hidden_states
from lumped.integration.signals import Signals
from lumped.model.multipliers import multipliers
from lumped.model.network import Network, Row
from lumped.transfer.terms_value import separated, turned
from measured.sensors.blocks import INSTANTS

Sensor = tuple[str, Row, float, float]  # name, row over z, sigma (K), lag (s)
STEPS = (0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0)  # s: those people choose
TOLERANCE = 0.5  # of a sensor's standard deviation: its residual is then 12 % larger than it need be
MOST, MOMENTS = 20_000, 1_000  # instants of a record that are looked at; those that count, where inputs move most
SLOWEST = 1e-6  # 1/s: what settles in more than eleven days drifts
SMALL = 1e-4  # below, g(x) is x / 24
MATTERS = 0.1  # of the largest amplitude at a sensor: a mode below has no say in which node is the fastest


@dataclass(frozen=True)
class SampleStep:
    """step_s;  error_K : the largest rms difference to a mean over a step, at `sensor`;  node : the fastest state that
    matters there, with its time constant (s). 0 and None where readings are taken as recorded."""

    step_s: float
    error_K: float
    sensor: str | None
    node: str | None
    time_constant_s: float | None

    def document(self) -> dict[str, Any]:
        return dict(vars(self))


def sampled(steps: Mapping[str, SampleStep]) -> str:
    """In a sentence: test by test the step, and at the worst sensor of all what that leaves."""
    tests: dict[float, list[str]] = {}
    for name, s in steps.items():
        tests.setdefault(s.step_s, []).append(name)
    sentence = "; ".join(f"every {h:.3g} s in {', '.join(names)}" for h, names in sorted(tests.items()))
    worst = max(steps.values(), key=lambda s: s.error_K)
    if worst.sensor is None:
        return f"readings and model are compared {sentence}, as recorded"
    tau_s = worst.time_constant_s
    late = f"{tau_s / 3600.0:.0f} h" if tau_s and tau_s >= 7200.0 else f"{tau_s:.3g} s" if tau_s is not None else ""
    fast = f", where the time constant of {worst.node} is {late}" * bool(late)
    return (
        f"readings and model are compared {sentence}; that leaves {worst.error_K:.2g} K (rms) at {worst.sensor}{fast}"
    )


@dataclass(frozen=True)
class Modes:
    """rate (m,) 1/s, infinite for what follows at once;  shape (n, m) of the states;  weight (m, n) of heat in them"""

    rate: Array
    shape: Array
    weight: Array

    @classmethod
    def of(cls, G: Array, C: Array) -> Modes:
        """Of C dx/dt = -G x; states without capacity follow the others."""
        warm, bare = np.flatnonzero(C > 0.0), np.flatnonzero(C == 0.0)
        n, inverse = C.size, np.linalg.pinv(G[np.ix_(bare, bare)])
        lift, fall = np.zeros((n, warm.size)), np.zeros((warm.size, n))
        lift[warm, np.arange(warm.size)] = fall[np.arange(warm.size), warm] = 1.0
        lift[bare] = -inverse @ G[np.ix_(bare, warm)]
        fall[:, bare] = -G[np.ix_(warm, bare)] @ inverse
        rate, V = np.linalg.eig((fall @ G @ lift) / C[warm, None])
        rate = np.maximum(rate.real, SLOWEST)
        shape, weight = lift @ V, np.linalg.solve(V, fall / C[warm, None]) / rate[:, None]
        at_once = np.eye(n)[:, bare]
        rate, inverse = np.append(rate, np.full(bare.size, np.inf)), inverse @ np.eye(n)[bare]
        return cls(rate, np.hstack([shape, at_once]), np.vstack([weight, inverse]))


def interpolation_error(x: Array) -> Array:
    """g(x) above."""
    full = np.maximum(x, SMALL)
    return np.abs(np.where(x < SMALL, x / 24.0, 0.5 + np.expm1(-0.5 * full) / full + np.expm1(-full) / 12.0))


def sample_step(
    network: Network,
    time: Array,
    inputs: Mapping[str, Array],
    around: Mapping[str, float],
    sensors: Sequence[Sensor],
    level: float,
    wished: float | None = None,
) -> SampleStep:
    """The step for one record: no finer than its own, no coarser than `wished` (s) or the instants of a fit.

    time (n,) s, inputs (n,): as recorded;  around : boundary -> degC;  sensors : sensors
    level : degC of a warm machine
    """
    usual = float(np.median(np.diff(time)))
    most = time[-1] / INSTANTS if wished is None else min(wished, time[-1] / INSTANTS)
    steps = sorted({usual, *(h for h in (*STEPS, *([wished] if wished else [])) if usual < h <= most)})
    felt, best = _Felt.of(network, time, inputs, around, level), SampleStep(steps[0], 0.0, None, None, None)
    for h in steps[1:]:
        worst = felt.worst(h, sensors)
        if worst.error_K > TOLERANCE * min(sigma for _, _, sigma, _ in sensors):
            break
        best = worst
    return best


@dataclass(frozen=True)
class _Felt:
    """time (n,) s;  factor (n, e) of the terms that vary with an input;  heat (states, e): W that a unit of it makes"""

    states: tuple[str, ...]
    modes: Modes
    time: Array
    factor: Array
    heat: Array

    @classmethod
    def of(
        cls, network: Network, time: Array, inputs: Mapping[str, Array], around: Mapping[str, float], level: float
    ) -> _Felt:
        """Linear about a machine at `level`, its films at the mean of their input factors."""
        every, n, acting = assembly(network), len(network.states), multipliers(network, None)
        start = np.where(hidden_states(network), 0.0, level)
        z = np.concatenate([start, [around[b] for b in network.boundaries], [1.0]])
        signals = Signals(inputs, time.size)
        factors = [np.asarray(signals.factor(p.name, separated(p.law))) for p in every.patterns]
        scale = np.array([acting.get(p.name, 1.0) * _value(p, z) for p in every.patterns])
        G = every.matrix(scale * np.array([float(np.mean(f)) for f in factors]))[:, :n]
        C = network.C * capacity_multipliers(network, acting)
        moving = [e for e, f in enumerate(factors) if f.ndim]
        heat = np.zeros((n, len(moving)))
        for k, e in enumerate(moving):
            p = every.patterns[e]
            np.add.at(heat[:, k], p.row[p.to], -scale[e] * p.vals * z[p.cols])
        table = np.stack([factors[e] for e in moving], axis=1) if moving else np.zeros((time.size, 0))
        return cls(network.states, Modes.of(G, C), time, table, heat)

    def worst(self, h: float, sensors: Sequence[Sensor]) -> SampleStep:
        """With steps of h (s)."""
        at = self.time[:: max(1, self.time.size // MOST)]
        rows = np.minimum(np.searchsorted(self.time, [at, at + h]), self.time.size - 1)
        change = self.factor[rows[1]] - self.factor[rows[0]]
        change = change[np.argsort(-np.abs(change) @ np.abs(self.heat).sum(axis=0))[:MOMENTS]]
        push, best = self.modes.weight @ self.heat, SampleStep(h, 0.0, None, None, None)
        for name, row, _, lag in sensors:
            inside = row.index < len(self.states)
            modal = row.weights[inside] @ self.modes.shape[row.index[inside]]
            parts = np.abs(change @ (modal[:, None] * push).T)
            late = parts @ interpolation_error(h / np.maximum(1.0 / self.modes.rate + lag, 1e-9))
            if (error := float(np.sqrt(np.sum(late**2) / at.size))) > best.error_K:
                best = SampleStep(h, error, name, *self._fastest(parts[int(late.argmax())]))
        return best

    def _fastest(self, parts: Array) -> tuple[str | None, float | None]:
        rate = self.modes.rate
        some = np.flatnonzero((parts > MATTERS * parts.max()) & np.isfinite(rate))
        if not some.size:
            return None, None
        m = int(some[np.argmax(rate[some])])
        visible = np.array([0.0 if "#" in s else 1.0 for s in self.states])
        return self.states[int(np.argmax(visible * np.abs(self.modes.shape[:, m])))], float(1.0 / rate[m])


def _value(p: Pattern, z: Array) -> float:
    """Of its temperature law."""
    hot, cold = (float(z[row.index] @ row.weights) for row in (p.hot, p.cold))
    return turned(p.law.temperature, hot, cold)
