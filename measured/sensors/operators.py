"""From temperatures at the sensors to what the recorder shows, for a whole test or one stretch of it after another.

Order: delay, stem conduction, lag, gain, bias, drift, exchanged plugs. Each is affine in the temperatures, so tangents
pass through its linear part.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lumped.model.network import Network, Parameter
from lumped.model.sites import ambient
from lumped.numerics.jit import entry
from measured.case import Channel, Test
from measured.sensors.spline import through

Array = NDArray[np.float64]
OPERATORS = ("bias", "gain", "lag", "stem", "drift", "delay", "swap")
SHIFTS = ("boundary", "initial")
GAIN_ZERO = 20.0  # degC, at which sensors are compared
STEP = {"lag": 0.05, "delay": 0.05}  # s, of a difference quotient; chosen, small beside any sample step
Memory = dict[str, Array]


def head(parameter: Parameter) -> str:
    """What a parameter acts on: 'bias', 'boundary', ... or 'thermal'."""
    return _kind(parameter.targets[0][0]) if parameter.targets else "thermal"


@lru_cache(maxsize=4096)
def _kind(target: str) -> str:
    first = target.split(":", 1)[0]
    return first if first in OPERATORS + SHIFTS else "thermal"


def start_target(test: str, state: str) -> str:
    """What a parameter acts on that says at what temperature a state begins a test."""
    return f"initial:{test}:{state}"


def starts(target: str, test: str) -> bool:
    """Does what acts on a target move the start of this test, of the whole machine or of a state?"""
    return target == f"initial:{test}" or target.startswith(start_target(test, ""))


def of_measurement(parameter: Parameter) -> bool:
    """Is it a sensor's, a boundary's, a start's or a clock's?"""
    return head(parameter) != "thermal"


def setting(parameters: Sequence[Parameter], values: Mapping[str, float]) -> dict[str, float]:
    """Total of what acts on each channel, boundary and start: 'bias:CHANNEL' -> K, ... (neutral ones left out)."""
    out: dict[str, float] = {}
    for p in parameters:
        if head(p) != "thermal":
            for target, factor in p.targets:
                out[target] = out.get(target, 0.0) + factor * values.get(p.name, p.value)
    return {target: value for target, value in out.items() if value != 0.0}


def moved(now: Mapping[str, float], p: Parameter) -> tuple[dict[str, float], float]:
    """The setting with what a parameter acts on a step further, and the step."""
    target, step = p.targets[0][0], STEP.get(head(p), 1e-3)
    return {**now, target: now.get(target, 0.0) + step}, step


@dataclass(frozen=True)
class Stretch:
    """A part of a test: its times (s), the air around (degC), where the test began (s), and its channels.

    memory : variant -> how far its sensors are behind at the end of what was read last. A stretch that follows another
        starts with the time at which that ended.
    """

    time: Array
    air: Array | None
    began: float
    channels: tuple[Channel, ...]
    memory: Memory

    def read(self, T: Array, now: Mapping[str, float], variant: str = "", linear: bool = False) -> Array:
        """Readings (n_time, n_channel, ...) from temperatures that are delayed already; linear: without the constants.

        Each variant remembers its own lags.
        """
        out = self.through(self.channels, T, now, variant, linear)
        for key, a in now.items():
            if key.startswith("swap:"):
                _swap(out, [c.name for c in self.channels], key, a)
        return out

    def through(
        self, channels: Sequence[Channel], T: Array, now: Mapping[str, float], variant: str = "", linear: bool = False
    ) -> Array:
        """What some channels read, a column of T (n_time, n_channel, ...) each, but for exchanged plugs."""
        out, one = np.array(T, float, order="C"), 0.0 if linear else 1.0
        columns, rows = (-1,) + (1,) * (T.ndim - 2), (-1,) + (1,) * (T.ndim - 1)

        def each(kind: str) -> Array:
            return np.array([now.get(f"{kind}:{c.name}", 0.0) for c in channels]).reshape(columns)

        stem, gain, bias, drift = each("stem"), each("gain"), each("bias"), each("drift")
        if stem.any() and self.air is not None:
            out += stem * (one * self.air.reshape(rows) - out)
        tau = np.array([c.lag_s for c in channels]) + each("lag").ravel()
        if np.any(tau > 0.0):
            self.memory[variant] = lag(self.time, out, tau, self.memory.get(variant))
        if gain.any():
            out += gain * (out - one * GAIN_ZERO)
        if bias.any():
            out += one * bias
        if drift.any():
            out += one * drift * ((self.time - self.began) / 3600.0).reshape(rows)
        return out


def stretch_of(network: Network, test: Test, some: slice, memory: Memory) -> Stretch:
    """The samples of a test from some.start to some.stop."""
    air = test.boundaries.get(ambient(network) or "")
    around = None if air is None else np.broadcast_to(np.asarray(air, float), test.time.shape)[some]
    return Stretch(test.time[some], around, float(test.time[0]), test.channels, memory)


def observe(network: Network, test: Test, T: Array, now: Mapping[str, float]) -> Array:
    """Readings of a whole test from the temperatures at its sensors, (n_time, n_channel)."""
    delay = now.get(f"delay:{test.name}", 0.0)
    late = shifted(test.time, T, delay) if delay else T
    return stretch_of(network, test, slice(0, len(test.time)), {}).read(late, now)


def _swap(out: Array, names: list[str], key: str, a: float) -> None:
    pair = [names.index(n) for n in key.split(":", 1)[1].split("|") if n in names]
    if len(pair) == 2:
        i, j = pair
        out[:, i], out[:, j] = out[:, i] + a * (out[:, j] - out[:, i]), out[:, j] + a * (out[:, i] - out[:, j])


def lag(time: Array, T: Array, tau: Array, first: Array | None = None) -> Array:
    """Let first-order lags tau (n_channel,) s follow T (n_time, n_channel, ...), which becomes what they show.

    Exact for temperatures linear between the times.
    first : how far they are behind at the first time, 0 in equilibrium.  Returns the same at the last time.
    """
    flat = T.reshape(len(T), tau.size, -1)
    state = np.zeros((2, *flat.shape[1:]))
    if first is not None:
        state[0] = first
    _follow(time, flat, tau, state)
    return np.asarray(state[0])


@entry
def _follow(time, T, tau, state):
    """state (2, n_channel, n): how far each is behind, and what it followed last."""
    nt, nc, n = T.shape
    for t in range(nt):
        h = time[t] - time[max(t - 1, 0)]
        for j in range(nc):
            if tau[j] > 0.0:
                decay = math.exp(-h / tau[j])
                share = tau[j] / h * (1.0 - decay) if h > 0.0 else 0.0
                for k in range(n):
                    now = T[t, j, k]
                    state[0, j, k] = decay * state[0, j, k] - share * (now - state[1, j, k])
                    state[1, j, k] = now
                    T[t, j, k] = now + state[0, j, k]


def shifted(
    time: Array, T: Array, delay: float, at: Array | None = None, ends: tuple[float, float] | None = None
) -> Array:
    """What was true `delay` seconds ago; a cubic spline, so that a fit may move the delay through zero smoothly.

    at : when (s), by default `time`;  ends : beyond these nothing changes, by default those of `time`
    """
    low, high = ends or (time[0], time[-1])
    return through(time, T, np.clip((time if at is None else at) - delay, low, high))
