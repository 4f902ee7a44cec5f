"""From temperatures at the sensors to what the recorder shows, for a whole test or one stretch of it after another.

Order: delay, stem conduction, lag, gain, bias, drift, exchanged plugs. Each is affine in the temperatures, so tangents
pass through its linear part.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import lfilter

from lumped.network import Network, Parameter
from validation.case import Channel, Test
from validation.effects.sites import ambient

Array = NDArray[np.float64]
OPERATORS = ("bias", "gain", "lag", "stem", "drift", "delay", "swap")
SHIFTS = ("boundary", "initial")
GAIN_ZERO = 20.0
STEP = {"lag": 0.05, "delay": 0.05}
Memory = dict[tuple[str, str], Array]


def head(parameter: Parameter) -> str:
    """What a parameter acts on: 'bias', 'boundary', ... or 'thermal'."""
    first = parameter.targets[0][0].split(":", 1)[0] if parameter.targets else "thermal"
    return first if first in OPERATORS + SHIFTS else "thermal"


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

    memory : (variant, channel) -> how far the sensor is behind at the end of what was read last. A stretch that
        follows another starts with the time at which that ended.
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
        out = np.array(T, float)
        for j in range(len(self.channels)):
            out[:, j] = self.channel(j, out[:, j], now, variant, linear)
        for key, a in now.items():
            if key.startswith("swap:"):
                _swap(out, [c.name for c in self.channels], key, a)
        return out

    def channel(self, j: int, T: Array, now: Mapping[str, float], variant: str = "", linear: bool = False) -> Array:
        """What one channel reads, but for exchanged plugs."""
        name, one = self.channels[j].name, 0.0 if linear else 1.0
        stem, gain = now.get(f"stem:{name}", 0.0), now.get(f"gain:{name}", 0.0)
        bias, drift = now.get(f"bias:{name}", 0.0), now.get(f"drift:{name}", 0.0)
        shape = (-1,) + (1,) * (T.ndim - 1)
        if stem and self.air is not None:
            T = T + stem * (one * self.air.reshape(shape) - T)
        tau = self.channels[j].lag_s + now.get(f"lag:{name}", 0.0)
        if tau > 0.0:
            late = trailing(self.time, T, tau, self.memory.get((variant, name)))
            self.memory[variant, name] = late[-1].copy()
            T = T + late
        if gain:
            T = T + gain * (T - one * GAIN_ZERO)
        if bias:
            T = T + one * bias
        if drift:
            T = T + one * drift * ((self.time - self.began) / 3600.0).reshape(shape)
        return T


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


def lagged(time: Array, T: Array, tau: float) -> Array:
    """First-order lag tau (s), exact for readings linear between the times, in equilibrium at the start."""
    return T + trailing(time, T, tau) if tau > 0.0 else T


def trailing(time: Array, T: Array, tau: float, first: Array | None = None) -> Array:
    """What a first-order lag tau (s) adds to T; `first`: at the first time, 0 in equilibrium."""
    dt, out = np.diff(time), np.empty_like(T)
    out[0] = 0.0 if first is None else first
    decay = np.exp(-dt / tau)
    share = np.where(dt > 0, tau / np.maximum(dt, 1e-12) * (1.0 - decay), 0.0)
    push = -share.reshape(-1, *(1,) * (T.ndim - 1)) * np.diff(T, axis=0)
    if dt.size and np.ptp(dt) < 1e-9 * dt[0]:
        out[1:] = lfilter([1.0], [1.0, -decay[0]], push, axis=0, zi=decay[0] * out[:1])[0]
    else:
        for n in range(dt.size):
            out[n + 1] = decay[n] * out[n] + push[n]
    return out


def shifted(
    time: Array, T: Array, delay: float, at: Array | None = None, ends: tuple[float, float] | None = None
) -> Array:
    """What was true `delay` seconds ago; a cubic spline, so that a fit may move the delay through zero smoothly.

    at : when (s), by default `time`;  ends : beyond these nothing changes, by default those of `time`
    """
    low, high = ends or (time[0], time[-1])
    return np.asarray(CubicSpline(time, T)(np.clip((time if at is None else at) - delay, low, high)))
