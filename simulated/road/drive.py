"""What the motor is made to do: an hour on the brake stand, an hour on the road, second by second."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from simulated.physics.draws import Draws
from simulated.physics.losses import L_AF, RPM

Array = NDArray[np.float64]
SECONDS = 3600
RPM_PER_KMH = 25.0  # 1000 rpm at 40 km/h


@dataclass(frozen=True)
class Vehicle:
    """mass (kg), drag area (m2), rolling resistance (1), efficiency (1), friction torque of the motor (N m)."""

    mass: float = 3200.0
    drag_area: float = 1.6
    rolling: float = 0.012
    efficiency: float = 0.92
    friction: float = 4.0

    def current(self, v: Array, acceleration: Array, slope: Array) -> Array:
        """Motor current (A) that moves the vehicle: torque = L_af I^2; none when coasting or braking, 511 A at most."""
        force = (
            self.mass * (1.06 * acceleration + 9.81 * (slope + self.rolling * (v > 0))) + 0.6 * self.drag_area * v**2
        )
        torque = force / (RPM_PER_KMH * 3.6 * RPM) / self.efficiency + self.friction
        return np.where(v > 0.05, np.minimum(np.sqrt(np.maximum(torque, 0.0) / L_AF), 511.0), 0.0)


@dataclass(frozen=True)
class Drive:
    """An hour by seconds: current (A), rpm, vehicle (m/s), flow (m3/h), ambient (degC); start: degC everywhere."""

    current: Array
    rpm: Array
    vehicle: Array
    flow: Array
    ambient: Array
    start: float


@dataclass(frozen=True)
class Overpass:
    """A bridge: up 4 % and down again, once `every` metres, `ramp` metres each way, first after `first` metres."""

    every: float
    ramp: float
    first: float

    def slope(self, distance: Array) -> Array:
        x = (distance - self.first) % self.every
        return np.where(
            distance < self.first, 0.0, np.where(x < self.ramp, 0.04, np.where(x < 2 * self.ramp, -0.04, 0.0))
        )


STAND_PLAN = ((15, 1000, 38.0), (12, 700, 30.0), (13, 1200, 38.0), (8, 500, 15.0), (12, 1000, 38.0))  # min, rpm, A


def stand(draws: Draws, name: str, ambient: float, warm: float) -> Drive:
    """The brake stand: the plan above, each repeat with its own slips in load, speed and room temperature."""
    random = draws.stream(f"{name}.load")
    minutes = np.array([row[0] for row in STAND_PLAN]) + random.normal(0, 0.4, len(STAND_PLAN))
    ends = np.cumsum(minutes * SECONDS / minutes.sum())
    at = np.minimum(np.searchsorted(ends, np.arange(SECONDS), side="right"), len(STAND_PLAN) - 1)
    rpm = np.array([row[1] for row in STAND_PLAN]) * random.normal(1, 0.015, len(STAND_PLAN))
    amps = np.array([row[2] for row in STAND_PLAN]) * random.normal(1, 0.02, len(STAND_PLAN))
    current = np.minimum(_smooth(amps[at], 4.0) + _wander(random, 0.5, 30.0), 39.9)
    speed = _smooth(rpm[at], 8.0) + _wander(random, 5.0, 20.0)
    still = np.zeros(SECONDS)
    return _surroundings(draws, name, Drive(current, speed, still, still, still, ambient + warm), ambient, 1.0)


def road(draws: Draws, name: str, bridge: Overpass, ambient: float, warm: float) -> Drive:
    """The road: a driver follows the speeds of NAME.csv; mass, drag and route are the vehicle's."""
    random = draws.stream(f"{name}.driver")
    v = _follow(np.loadtxt(Path(__file__).with_name(f"{name}.csv"), delimiter=",", skiprows=1), random)
    slope = bridge.slope(np.cumsum(v))
    current = Vehicle().current(v, np.gradient(v), slope)
    still = np.zeros(SECONDS)
    return _surroundings(
        draws, name, Drive(current, v * 3.6 * RPM_PER_KMH, v, still, still, ambient + warm), ambient, 1.5
    )


def _follow(plan: Array, random: np.random.Generator) -> Array:
    """Speed (m/s) of a driver who closes in on the target within 5 s, at no more than 0.7 up and 1.1 m/s2 down.

    plan : (n, 2) minutes and km/h
    """
    ends = np.cumsum(plan[:, 0] * 60)
    at = np.minimum(np.searchsorted(ends * SECONDS / ends[-1], np.arange(SECONDS), side="right"), len(plan) - 1)
    target = (plan[:, 1] / 3.6)[at]
    target = np.where(target > 0, target + _wander(random, 0.5, 40.0), 0.0)
    v = np.zeros(SECONDS)
    for i in range(1, SECONDS):
        v[i] = max(v[i - 1] + np.clip((target[i] - v[i - 1]) / 5.0, -1.1, 0.7), 0.0)
    return np.where(v < 0.2, 0.0, v)


def _surroundings(draws: Draws, name: str, drive: Drive, ambient: float, drift: float) -> Drive:
    """Ambient that drifts through the hour, and a fan that delivers its 138 m3/h within a few per cent."""
    random = draws.stream(f"{name}.air")
    hour = np.arange(SECONDS) / SECONDS
    room = ambient + drift * hour * random.uniform(0.5, 1.0) + _wander(random, 0.2, 400.0)
    flow = draws.around("fan.flow_m3h", 138.0, 0.03) * (1 + 0.01 * random.standard_normal()) + _wander(
        random, 0.7, 60.0
    )
    return replace(drive, flow=flow, ambient=room - room[0] + ambient)


def _smooth(x: Array, tau: float) -> Array:
    """First-order follower with time constant tau (s)."""
    out, blend = x.copy(), 1 - np.exp(-1 / tau)
    for i in range(1, len(x)):
        out[i] = out[i - 1] + blend * (x[i] - out[i - 1])
    return out


def _wander(random: np.random.Generator, sd: float, tau: float) -> Array:
    """Ornstein-Uhlenbeck noise: sd, correlation time tau (s)."""
    keep = np.exp(-1 / tau)
    kicks = sd * np.sqrt(1 - keep**2) * random.standard_normal(SECONDS)
    out = np.empty(SECONDS)
    out[0] = sd * random.standard_normal()
    for i in range(1, SECONDS):
        out[i] = keep * out[i - 1] + kicks[i]
    return out


def drives(draws: Draws) -> dict[str, Drive]:
    """The five tests, by name."""
    return {
        "stand-1": stand(draws, "stand-1", 19.6, 0.4),
        "stand-2": stand(draws, "stand-2", 22.8, 2.3),
        "stand-3": stand(draws, "stand-3", 21.3, 1.1),
        "road-1": road(draws, "road-1", Overpass(3300.0, 350.0, 1500.0), 23.8, 0.6),
        "road-2": road(draws, "road-2", Overpass(5200.0, 500.0, 3100.0), 11.5, 1.4),
    }
