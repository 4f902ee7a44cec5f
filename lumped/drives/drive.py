"""The series-wound direct-current machine, its current-limited controller and the vehicle it moves.

V = (R_a + R_f) i + (L_a + L_f) di/dt + L_af w i        (1-3)
J dw/dt = L_af i^2 - B w - T_load                        (4-6)

Where it brakes electrically the field is reversed: the machine generates, V = L_af w i - R i - L di/dt, and its torque
is -L_af i^2. Friction brakes take the rest.
"""

from dataclasses import dataclass, fields

import numpy as np

from geom.arrays import Array
from geom.constants import GRAVITY, RPM
from lumped.numerics.jit import entry


@dataclass(frozen=True)
class SeriesMachine:
    """L_af: mutual inductance (H), R = R_a + R_f (ohm), L = L_a + L_f (H), J: rotor inertia (kg m2), B (N m s/rad)."""

    L_af: float
    R: float
    L: float = 2e-3
    J: float = 2.0
    B: float = 0.0

    @classmethod
    def from_ratings(
        cls, power: float, speed_rpm: float, voltage: float, current: float, **others: float
    ) -> "SeriesMachine":
        """From shaft power (W), speed (1/min), voltage (V), current (A): T = L_af I^2 and V = R I + w L_af I."""
        omega = speed_rpm * RPM
        L_af = power / omega / current**2
        return cls(L_af, (voltage - omega * L_af * current) / current, **others)

    def torque(self, current: Array | float) -> Array | float:
        """N m (eq. 5)."""
        return self.L_af * np.asarray(current) ** 2

    def current(self, torque: Array | float) -> Array | float:
        """A that gives a torque (N m); none below 0."""
        return np.sqrt(np.maximum(torque, 0.0) / self.L_af)

    def voltage(self, current: Array | float, speed_rpm: Array | float) -> Array | float:
        """Steady terminal voltage (V)."""
        return (self.R + self.L_af * RPM * np.asarray(speed_rpm)) * np.asarray(current)

    def speed(self, current: Array | float, voltage: float) -> Array | float:
        """Steady speed (1/min) at a terminal voltage: the torque-current-speed curves of the machine."""
        i = np.asarray(current)
        return (voltage - self.R * i) / (self.L_af * i) / RPM

    def losses(self, current: Array | float) -> Array | float:
        """Copper loss (W)."""
        return self.R * np.asarray(current) ** 2


@dataclass(frozen=True)
class Vehicle:
    """mass (kg), wheel_radius (m), gear: motor over wheel speed, its efficiency, rolling (1), drag_area cw A (m2).

    brakes : deceleration (m/s2) on the level that its friction brakes can give
    regeneration : share (1) of the braking that the machine takes over as a generator, within its limits
    """

    mass: float
    wheel_radius: float
    gear: float
    efficiency: float = 0.95
    rolling: float = 0.01
    drag_area: float = 3.0
    air_density: float = 1.2
    brakes: float = 3.0
    regeneration: float = 0.0

    def wheel_torque(self, speed_mps: Array | float, slope: Array | float) -> Array:
        """At the motor shaft, steady, of a gear without loss (N m); slope: rise over run."""
        angle = np.arctan(slope)
        weight = self.mass * GRAVITY * (np.sin(angle) + self.rolling * np.cos(angle))
        drag = 0.5 * self.air_density * self.drag_area * np.asarray(speed_mps) ** 2
        return np.asarray((weight + drag) * self.wheel_radius / self.gear)

    def inertia(self) -> float:
        """Of the vehicle, seen from the motor shaft (kg m2)."""
        return self.mass * (self.wheel_radius / self.gear) ** 2


@dataclass(frozen=True)
class Controller:
    """Speed loop gives the current wanted, current loop the mean PWM voltage; both are limited.

    A current wanted below 0 is a braking torque, as large as that of the current.

    Kp (A s/rad), Ki (A/rad) of the speed loop; the current loop has the time constant `current_lag` (s).
    """

    Kp: float = 40.0
    Ki: float = 4.0
    current_limit: float = 511.0
    voltage_limit: float = 220.0
    current_lag: float = 0.02


@dataclass(frozen=True)
class Cycle:
    """What the drive does at the record's times: mean-square current is kept, so that the heat is right.

    current_A: root of the mean square since the time before; electrical_W (negative where it comes back) and
    brake_W (heat of the friction brakes): means since then; the others at the instant.
    """

    time: Array
    current_A: Array
    speed_rpm: Array
    voltage_V: Array
    torque_Nm: Array
    vehicle_speed_mps: Array
    electrical_W: Array
    brake_W: Array

    def inputs(self) -> dict[str, Array]:
        """As inputs of a network's laws."""
        return {f.name: getattr(self, f.name) for f in fields(self) if f.name != "time"}


def drive_cycle(
    machine: SeriesMachine,
    vehicle: Vehicle,
    controller: Controller,
    time: Array,
    target_mps: Array,
    slope: Array,
    step: float = 5e-3,
    resistance: Array | None = None,
) -> Cycle:
    """Drive a speed profile: time (nt,) s, target_mps and slope (nt,) linear between the times; starts at rest.

    resistance: (nt,) ohm where it changes with temperature, else the machine's R
    step: of the inner integration (s); current by its exact exponential over the step, speed by the midpoint.
    """
    out = np.zeros((len(time), 7))
    wheel = vehicle.wheel_radius / vehicle.gear
    load = vehicle.wheel_torque(0.0, np.asarray(slope, float))
    drag = float(vehicle.wheel_torque(1.0, 0.0) - vehicle.wheel_torque(0.0, 0.0))
    grip = vehicle.brakes * vehicle.mass * wheel
    machine_ = machine.L_af, machine.L, machine.J + vehicle.inertia(), machine.B
    plant = np.array([*machine_, wheel, drag, vehicle.efficiency, grip, vehicle.regeneration])
    control = np.array([getattr(controller, f) for f in controller.__dataclass_fields__])
    R = np.full(len(time), machine.R) if resistance is None else resistance
    arrays = (np.ascontiguousarray(x, float) for x in (time, target_mps, load, R))
    _march(*arrays, plant, control, step, out)
    return Cycle(time, out[:, 0], out[:, 1] / RPM, *out[:, 2:].T)


@entry
def _march(time, profile, load, resistance, plant, control, step, out):
    L_af, L, J, B, wheel, drag, efficiency, grip, share = plant
    Kp, Ki, i_max, v_max, lag = control
    i, w, integral, generates = 0.0, 0.0, 0.0, False
    for t in range(1, time.size):
        span = time[t] - time[t - 1]
        count = max(1, int(np.ceil(span / step)))
        h, square, V, R = span / count, 0.0, 0.0, 0.5 * (resistance[t - 1] + resistance[t])
        energy, heat, T = 0.0, 0.0, 0.0
        for s in range(count):
            part = (s + 0.5) / count
            target = (profile[t - 1] + part * (profile[t] - profile[t - 1])) / wheel
            resist = load[t - 1] + part * (load[t] - load[t - 1]) + drag * (wheel * w) ** 2
            demand = Kp * (target - w) + integral
            command = min(max(demand, -np.sqrt(grip / L_af)), i_max)
            if demand == command:
                integral += Ki * (target - w) * h
            braking = L_af * command * command if command < 0.0 else 0.0
            i_ref = max(command, 0.0)
            if braking > 0.0 and L_af * w > R:  # below, a generator would have to be fed
                i_ref = min(np.sqrt(share * braking / L_af), i_max, v_max / (L_af * w - R))
            if generates != (command < 0.0) and i <= 0.01 * i_max:
                generates, i = command < 0.0, 0.0  # the field is reversed when next to no current is left
            if generates != (command < 0.0):
                i_ref = 0.0
            if generates:
                end = i_ref + (i - i_ref) * np.exp(-h / lag)
                V = max((L_af * w - R) * i_ref, 0.0)
            else:
                V = min(max((R + L_af * w) * i_ref + L / lag * (i_ref - i), 0.0), v_max)
                drop = R + L_af * w
                end = V / drop + (i - V / drop) * np.exp(-drop / L * h)
            mean, before = (i * i + i * end + end * end) / 3.0, w
            T = -L_af * mean if generates else L_af * mean
            friction = max(braking + min(T, 0.0), 0.0)
            against = (resist / efficiency if resist > 0.0 else resist * efficiency) + B * w
            if w > 0.0 or against < T or (against < 0.0 and target > 0.0):  # else it stands, on a slope by its brakes
                w = max(w + h / J * (T - against - friction), 0.0)
            square += h * mean
            energy += h * (R * mean + T * 0.5 * (before + w)) + 0.5 * L * (end * end - i * i)
            heat += h * friction * 0.5 * (before + w)
            i = max(end, 0.0)
        out[t, 0] = np.sqrt(square / span) if span > 0.0 else i
        out[t, 1], out[t, 2], out[t, 3], out[t, 4] = w, V, -L_af * i * i if generates else L_af * i * i, w * wheel
        out[t, 5], out[t, 6] = (energy / span, heat / span) if span > 0.0 else (out[t - 1, 5], out[t - 1, 6])
