"""One test: the plant through an hour of drive, and what is to be seen of it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulated.physics.losses import L_AF, RPM
from simulated.physics.plant import Plant, State
from simulated.physics.surfaces import Conditions
from simulated.road.drive import Drive
from simulated.road.sensors import Sensor

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Result:
    """time (n,) s; inputs: the conditions of the step that ends at each time; T (n, sensors) true temperatures at the
    thermocouples (degC); voltage (n,); heat (J) made, carried off and stored over the test; extremes (degC) by part."""

    time: Array
    inputs: tuple[Conditions, ...]
    T: Array
    voltage: Array
    made: float
    outside: float
    exhaust: float
    stored: float
    hottest: dict[str, float]

    @property
    def imbalance(self) -> float:
        """(made - carried off - stored) / made."""
        return (self.made - self.outside - self.exhaust - self.stored) / self.made


def conditions(drive: Drive, begin: int, end: int) -> Conditions:
    """Means of the seconds from begin to end."""
    part = slice(begin, end)
    columns = (drive.current, drive.current**2, drive.rpm, drive.vehicle, drive.flow, drive.ambient)
    return Conditions(*(float(np.mean(x[part])) for x in columns))


def run(
    plant: Plant, drive: Drive, sensors: Sequence[Sensor], dt: int, tell: Callable[[int], None] = lambda _: None
) -> Result:
    """Integrate with steps of `dt` seconds; tell(second) reports progress."""
    state, slope = plant.start(drive.start), np.zeros(len(plant.body.points))
    steps = [conditions(drive, t, t + dt) for t in range(0, len(drive.current), dt)]
    inputs = (conditions(drive, 0, 1), *steps)
    T, volts, heat, peak = [_seen(sensors, state)], [_voltage(plant, state.T, inputs[0])], np.zeros(3), state.T
    for i, now in enumerate(steps):
        state, slope, flows = plant.step(state, slope, now, float(dt))
        heat += dt * np.array([flows.made, flows.outside, flows.exhaust])
        peak = np.maximum(peak, state.T)
        T.append(_seen(sensors, state))
        volts.append(_voltage(plant, state.T, now))
        tell((i + 1) * dt)
    stored = float(plant.body.capacity @ (state.T - drive.start))
    hottest = {part: float(peak[plant.body.nodes(part)].max()) for part in plant.body.parts}
    time = np.arange(len(inputs)) * float(dt)
    return Result(time, inputs, np.array(T), np.array(volts), *(float(q) for q in heat), stored, hottest)


def _seen(sensors: Sequence[Sensor], state: State) -> list[float]:
    return [sensor.read(state.T, float(state.air[-1])) for sensor in sensors]


def _voltage(plant: Plant, T: Array, now: Conditions) -> float:
    """Terminal voltage (V): resistance, brushes and back-EMF of the series machine."""
    brushes = plant.losses.brush_drop * (now.current > 0.5)
    return now.current * (plant.resistance(T) + L_AF * now.rpm * RPM) + brushes
