"""Thermocouples and recorder: where the sensors really sit, how slow they are, and what is written down."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulated.physics.conduction import Body
from simulated.physics.draws import Draws

Array = NDArray[np.float64]
SIGMA_K = 0.3  # +-0.5 degC, evenly spread

# name -> part, nominal position (mm), nominal lag (s)
THERMOCOUPLES: Mapping[str, tuple[str, tuple[float, float, float], float]] = {
    "T_flange_left_degC": ("flange.left", (141.0, 141.0, 22.0), 15.0),
    "T_flange_right_degC": ("flange.right", (141.0, 141.0, 418.0), 15.0),
    "T_housing_top_degC": ("housing", (20.7, 236.1, 220.0), 15.0),
    "T_housing_right_degC": ("housing", (236.1, 20.7, 370.0), 15.0),
    "T_yoke_degC": ("yoke", (154.9, 154.9, 195.0), 20.0),
    "T_pole_degC": ("poles", (20.0, 180.0, 120.0), 20.0),
    "T_field_side_degC": ("winding.field", (60.0, 173.0, 195.0), 30.0),
    "T_field_end_degC": ("winding.field", (173.0, 0.0, 310.0), 30.0),
    "T_bearing_left_degC": ("bearing.left", (0.0, 57.0, 24.0), 15.0),
    "T_bearing_right_degC": ("bearing.right", (0.0, 57.0, 416.0), 15.0),
    "T_base_degC": ("base", (200.0, -290.0, 220.0), 15.0),
}
EXHAUST = ("T_exhaust_degC", "air.right", 12.0)


@dataclass(frozen=True)
class Sensor:
    """A thermocouple as built in: reads weights @ T[nodes], or the exhaust if it has no nodes.

    position : where it really sits (m), None for the exhaust; lag (s), bias (K)
    """

    name: str
    nodes: NDArray[np.int64] | None
    weights: Array
    position: Array | None
    lag: float
    bias: float

    def read(self, T: Array, exhaust: float) -> float:
        return exhaust if self.nodes is None else float(self.weights @ T[self.nodes])


def install(body: Body, draws: Draws) -> tuple[Sensor, ...]:
    """All thermocouples, each placed within a few mm of where the drawing says, kept inside its part."""
    sensors = []
    for name, (part, nominal, lag) in THERMOCOUPLES.items():
        slip = np.array([draws.normal(f"{name}.d{axis}_mm", 2.0, 4.0) for axis in "xyz"])
        nodes, weights, position = locate(body, part, (np.array(nominal) + slip) * 1e-3)
        sensors.append(Sensor(name, nodes, weights, position, *_habits(name, lag, draws)))
    name, _, lag = EXHAUST
    return (*sensors, Sensor(name, None, np.ones(1), None, *_habits(name, lag, draws)))


def _habits(name: str, lag: float, draws: Draws) -> tuple[float, float]:
    """Drawn lag (s) and bias (K, even within +-0.5)."""
    bias = draws.taken.setdefault(f"{name}.bias_K", float(draws.stream(f"{name}.bias_K").uniform(-0.5, 0.5)))
    return draws.around(f"{name}.lag_s", lag, 0.2), bias


def locate(body: Body, part: str, xyz: Array) -> tuple[NDArray[np.int64], Array, Array]:
    """Nodes and weights of a point of a part, moved to the part's nearest tetrahedron if it lies outside."""
    tets = body.tets[body.region == body.parts.index(part)]
    corners = body.points[tets]
    near = np.argsort(np.linalg.norm(corners.mean(axis=1) - xyz, axis=1))[:200]
    inverse = np.linalg.inv((corners[near, 1:] - corners[near, :1]).transpose(0, 2, 1))
    inner = np.einsum("mij,mj->mi", inverse, xyz - corners[near, 0])
    weights = np.column_stack([1 - inner.sum(axis=1), inner])
    best = int(np.argmax(weights.min(axis=1)))
    w = np.clip(weights[best], 0.0, None)
    w /= w.sum()
    return tets[near[best]], w, w @ corners[near[best]]


def lagged(time: Array, x: Array, lag: float) -> Array:
    """First-order response, exact for a signal that is straight between samples; starts settled."""
    y, dt = np.array(x, float), np.diff(time)
    for i, step in enumerate(dt):
        keep, slope = np.exp(-step / lag), (x[i + 1] - x[i]) / step
        y[i + 1] = x[i + 1] - slope * lag + keep * (y[i] - x[i] + slope * lag)
    return y


def recorded(sensor: Sensor, time: Array, T: Array, random: np.random.Generator) -> Array:
    """What stands in the file: lag, bias, 0.05 K noise, steps of 0.1 K."""
    return np.round(lagged(time, T, sensor.lag) + sensor.bias + 0.05 * random.standard_normal(len(T)), 1)
