"""What the sensors of a test would read: the network's run, seen through each channel's operator.

Order of the operator: delay, stem conduction, lag, gain, bias, drift, exchanged plugs. Each is affine in the
temperatures, so tangents pass through its linear part.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import lfilter

from lumped.network import Network, Parameter
from lumped.simulate import Record, simulate
from validation.case import Test
from validation.effects.sites import ambient

Array = NDArray[np.float64]
OPERATORS = ("bias", "gain", "lag", "stem", "drift", "delay", "swap")
SHIFTS = ("boundary", "initial")
GAIN_ZERO = 20.0
STEP = {"lag": 0.05, "delay": 0.05}


@dataclass(frozen=True)
class Prediction:
    """y : (n_time, n_channel) degC;  J : (n_time, n_channel, n_parameter), see lumped.simulate for its coordinates."""

    y: Array
    J: Array


def head(parameter: Parameter) -> str:
    """What a parameter acts on: 'bias', 'boundary', ... or 'thermal'."""
    first = parameter.targets[0][0].split(":", 1)[0] if parameter.targets else "thermal"
    return first if first in OPERATORS + SHIFTS else "thermal"


def thermal(network: Network) -> Network:
    """The network with only the parameters that act on heat."""
    return replace(network, parameters=tuple(p for p in network.parameters if head(p) == "thermal"))


def setting(parameters: Sequence[Parameter], values: Mapping[str, float]) -> dict[str, float]:
    """Total of what acts on each channel, boundary and start: 'bias:CHANNEL' -> K, ... (neutral ones left out)."""
    out: dict[str, float] = {}
    for p in parameters:
        if head(p) != "thermal":
            for target, factor in p.targets:
                out[target] = out.get(target, 0.0) + factor * values.get(p.name, p.value)
    return {target: value for target, value in out.items() if value != 0.0}


def predict(
    network: Network, test: Test, values: Mapping[str, float], tangents: Sequence[Parameter] = ()
) -> Prediction:
    """Readings of every channel of a test and their derivatives with respect to `tangents`."""
    bare, hot = thermal(network), [p for p in tangents if head(p) == "thermal"]
    now = setting(network.parameters, values)
    known = {p.name for p in bare.parameters}
    heat = {k: v for k, v in values.items() if k in known}
    rows = [c.row for c in test.channels]

    def temperatures(shift: Mapping[str, float], wanted: Sequence[Parameter] = ()) -> tuple[Array, Array | None]:
        run = simulate(bare, record(test, shift), heat, rows, wanted)
        return run.y, run.dy

    T, dT = temperatures(now, hot)
    late = delayed(test, T, now)
    y = read(network, test, late, now)
    J = np.zeros((*y.shape, len(tangents)))
    if hot and dT is not None:
        J[:, :, [i for i, p in enumerate(tangents) if head(p) == "thermal"]] = observe(network, test, dT, now, True)
    for i, p in enumerate(tangents):
        if head(p) in SHIFTS:
            J[:, :, i] = _shift_tangent(network, test, now, p, T, temperatures)
        elif head(p) in OPERATORS:
            J[:, :, i] = _operator_tangent(network, test, T, late, y, now, p)
    return Prediction(y, J)


def record(test: Test, shift: Mapping[str, float]) -> Record:
    """The test's inputs, its time, and that it is this test; offsets of boundaries and start applied."""
    boundaries = {n: np.asarray(u, float) + shift.get(f"boundary:{n}", 0.0) for n, u in test.boundaries.items()}
    move = shift.get(f"initial:{test.name}", 0.0)
    initial = test.initial
    start = {k: v + move for k, v in initial.items()} if isinstance(initial, Mapping) else initial + move
    return Record(test.time, test.signals, boundaries, start)


Temperatures = Callable[..., tuple[Array, Array | None]]


def _shift_tangent(network: Network, test: Test, now: dict, p: Parameter, T: Array, run: Temperatures) -> Array:
    """By a difference over 0.5 K: the response to a boundary or start is linear but for the films' weak curvature."""
    target, step = p.targets[0][0], 0.5
    name = target.split(":", 1)[1]
    if name not in test.boundaries and name != test.name:
        return np.zeros_like(T)
    moved, _ = run({**now, target: now.get(target, 0.0) + step})
    return observe(network, test, (moved - T) / step, now, True)


def _operator_tangent(network: Network, test: Test, T: Array, late: Array, y: Array, now: dict, p: Parameter) -> Array:
    """T at the sensors, late: with the delay, y: as read."""
    target = p.targets[0][0]
    step = STEP.get(head(p), 1e-3)
    moved = {**now, target: now.get(target, 0.0) + step}
    if head(p) == "delay":
        return (observe(network, test, T, moved) - y) / step
    if any(key.startswith("swap:") for key in moved):
        return (read(network, test, late, moved) - y) / step
    out, air = np.zeros_like(T), _air(network, test)
    for j, c in enumerate(test.channels):
        if c.name == target.split(":", 1)[1]:
            out[:, j] = (_channel(test.time, late[:, j], c.name, c.lag_s, air, moved, 1.0) - y[:, j]) / step
    return out


def observe(network: Network, test: Test, T: Array, now: Mapping[str, float], linear: bool = False) -> Array:
    """Readings from the temperatures at the sensors, (n_time, n_channel, ...); `linear` leaves out the constants."""
    return read(network, test, delayed(test, T, now), now, linear)


def delayed(test: Test, T: Array, now: Mapping[str, float]) -> Array:
    delay = now.get(f"delay:{test.name}", 0.0)
    return shifted(test.time, T, delay) if delay else T


def read(network: Network, test: Test, T: Array, now: Mapping[str, float], linear: bool = False) -> Array:
    """What observe makes of temperatures that are delayed already."""
    out, air = np.array(T, float), _air(network, test)
    for j, c in enumerate(test.channels):
        out[:, j] = _channel(test.time, out[:, j], c.name, c.lag_s, air, now, 0.0 if linear else 1.0)
    for key, a in now.items():
        if key.startswith("swap:"):
            _swap(out, [c.name for c in test.channels], key, a)
    return out


def _air(network: Network, test: Test) -> Array | None:
    return test.boundaries.get(ambient(network) or "")


def _channel(time: Array, T: Array, name: str, lag_s: float, air: Array | None, now: Mapping, one: float) -> Array:
    stem, gain = now.get(f"stem:{name}", 0.0), now.get(f"gain:{name}", 0.0)
    bias, drift = now.get(f"bias:{name}", 0.0), now.get(f"drift:{name}", 0.0)
    shape = (-1,) + (1,) * (T.ndim - 1)
    if stem and air is not None:
        T = T + stem * (one * np.broadcast_to(air, time.shape).reshape(shape) - T)
    T = lagged(time, T, lag_s + now.get(f"lag:{name}", 0.0))
    if gain:
        T = T + gain * (T - one * GAIN_ZERO)
    if bias:
        T = T + one * bias
    if drift:
        T = T + one * drift * ((time - time[0]) / 3600.0).reshape(shape)
    return T


def _swap(out: Array, names: list[str], key: str, a: float) -> None:
    pair = [names.index(n) for n in key.split(":", 1)[1].split("|") if n in names]
    if len(pair) == 2:
        i, j = pair
        out[:, i], out[:, j] = out[:, i] + a * (out[:, j] - out[:, i]), out[:, j] + a * (out[:, i] - out[:, j])


def lagged(time: Array, T: Array, tau: float) -> Array:
    """First-order lag tau (s), exact for readings linear between the times, in equilibrium at the start."""
    if tau <= 0.0:
        return T
    dt = np.diff(time)
    decay = np.exp(-dt / tau)
    share = np.where(dt > 0, tau / np.maximum(dt, 1e-12) * (1.0 - decay), 0.0)
    push = -share.reshape(-1, *(1,) * (T.ndim - 1)) * np.diff(T, axis=0)
    out = np.array(T)
    out[1:] += _even(push, decay[0]) if np.ptp(dt) < 1e-9 * dt[0] else _uneven(push, decay)
    return out


def _even(push: Array, decay: float) -> Array:
    """b[n] = decay b[n-1] + push[n]."""
    return np.asarray(lfilter([1.0], [1.0, -decay], push, axis=0))


def _uneven(push: Array, decay: Array) -> Array:
    """The same with a decay of its own for each step."""
    behind = np.array(push)
    for n in range(1, len(push)):
        behind[n] += decay[n] * behind[n - 1]
    return behind


def shifted(time: Array, T: Array, delay: float) -> Array:
    """What was true `delay` seconds ago; a cubic spline, so that a fit may move the delay through zero smoothly."""
    return np.asarray(CubicSpline(time, T)(np.clip(time - delay, time[0], time[-1])))
