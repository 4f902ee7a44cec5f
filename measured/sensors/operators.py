"""From temperatures at the sensors to what the recorder shows, for a whole test or one stretch of it after another.

Order: delay, stem conduction, lag, gain, bias, drift, exchanged plugs. Each is affine in the temperatures, so tangents
pass through its linear part.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from geom.arrays import Array
from lumped.model.network import Network, Parameter
from lumped.model.sites import ambient
from lumped.numerics.jit import entry
from measured.case import Channel, Test

OPERATORS = ("bias", "gain", "lag", "stem", "slip", "drift", "delay", "swap")
SHIFTS = ("boundary", "initial")
SLIP_S = 60.0  # time constant of a probe that hangs beside its part: beads take 10 s in air, sleeved ones minutes
GAIN_ZERO = 20.0  # degC, at which sensors are compared
STEP = {"lag": 0.05, "delay": 0.05}  # s, of a difference quotient; chosen, small beside any sample step
Memory = dict[str, Array]


class While(NamedTuple):
    """What acts on a channel for a while.  share : (n_time,) of each sample in which it does"""

    kind: str
    channel: str
    share: Array

    @classmethod
    def of(cls, kind: str, channel: str, time: Array, share: Array) -> While:
        """time : (n_time,) s;  share : while it holds, which a sensor that slipped off follows"""
        follows = share[:, None].copy()
        if kind == "slip":
            lag(time, follows, np.full(1, SLIP_S))
        return cls(kind, channel, follows[:, 0])


NOTHING: Mapping[str, While] = MappingProxyType({})


# The cubic spline without knots at its second points (de Boor 1978, ch. IV), for thousands of columns at once. SciPy's
# make_interp_spline is the same function; for the tangents of one test (3600 instants, 420 columns) it takes 86 ms and
# holds Python's lock, this takes 5 ms and does not.
FEWEST = 4  # instants that a cubic needs


def through(time: Array, y: Array, at: Array) -> Array:
    """Values at some times of the cubic spline through y (n_time, ...), beyond its ends by the last polynomial.

    Of fewer than four points the polynomial through all.
    """
    if time.size < FEWEST:
        from scipy.interpolate import make_interp_spline

        return np.asarray(make_interp_spline(time, y, time.size - 1)(at))
    flat = np.ascontiguousarray(y, float).reshape(time.size, -1)
    out, slope, rest = np.empty((at.size, flat.shape[1])), np.empty_like(flat), np.empty(time.size)
    _through(np.asarray(time, float), flat, np.asarray(at, float), slope, rest, out)
    return out.reshape(at.size, *y.shape[1:])


@entry
def _through(x, y, at, s, c, out):
    """Slopes s at the points by elimination in a tridiagonal system (c: room for it), then a cubic in each interval."""
    n, m = y.shape
    a, b = x[1] - x[0], x[2] - x[1]
    c[0] = (a + b) / b
    for k in range(m):
        first, second = (y[1, k] - y[0, k]) / a, (y[2, k] - y[1, k]) / b
        s[0, k] = ((3.0 * a + 2.0 * b) * b * first + a * a * second) / ((a + b) * b)
    for i in range(1, n - 1):
        a, b = x[i] - x[i - 1], x[i + 1] - x[i]
        w = 1.0 / (2.0 * (a + b) - b * c[i - 1])
        c[i] = a * w
        p, q, r = 3.0 * b / a * w, 3.0 * a / b * w, b * w
        for k in range(m):
            s[i, k] = p * (y[i, k] - y[i - 1, k]) + q * (y[i + 1, k] - y[i, k]) - r * s[i - 1, k]
    w = 1.0 / (a - (a + b) * c[n - 2])
    for k in range(m):
        before, last = (y[n - 2, k] - y[n - 3, k]) / a, (y[n - 1, k] - y[n - 2, k]) / b
        s[n - 1, k] = ((b * b * before + (2.0 * a + 3.0 * b) * a * last) / (a + b) - (a + b) * s[n - 2, k]) * w
    for i in range(n - 2, -1, -1):
        for k in range(m):
            s[i, k] -= c[i] * s[i + 1, k]
    i = 0
    for j in range(at.size):
        while i < n - 2 and at[j] >= x[i + 1]:
            i += 1
        while i > 0 and at[j] < x[i]:
            i -= 1
        h = x[i + 1] - x[i]
        u = (at[j] - x[i]) / h
        v = 1.0 - u
        p, q, r, w = (1.0 + 2.0 * u) * v * v, (3.0 - 2.0 * u) * u * u, h * u * v * v, -h * u * u * v
        for k in range(m):
            out[j, k] = p * y[i, k] + q * y[i + 1, k] + r * s[i, k] + w * s[i + 1, k]


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
    whiles : what a parameter acts on for a while -> what that is
    """

    time: Array
    air: Array | None
    began: float
    channels: tuple[Channel, ...]
    memory: Memory
    whiles: Mapping[str, While]

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
            every = np.array([now.get(f"{kind}:{c.name}", 0.0) for c in channels]).reshape(columns)
            for key, w in self.whiles.items():
                if w.kind == kind and key in now:
                    mine = np.reshape([c.name == w.channel for c in channels], columns)
                    every = every + now[key] * w.share.reshape(rows) * mine
            return every

        stem, gain, bias, drift = each("stem") + each("slip"), each("gain"), each("bias"), each("drift")
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


def stretch_of(
    network: Network, test: Test, some: slice, memory: Memory, whiles: Mapping[str, While] = NOTHING
) -> Stretch:
    """The samples of a test from some.start to some.stop; whiles of all its samples."""
    air = test.boundaries.get(ambient(network) or "")
    around = None if air is None else np.broadcast_to(np.asarray(air, float), test.time.shape)[some]
    here = {key: w._replace(share=w.share[some]) for key, w in whiles.items()}
    return Stretch(test.time[some], around, float(test.time[0]), test.channels, memory, here)


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
