"""A drive whose currents depend on the temperatures that they cause: run both in turn until they agree."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from geom.arrays import Array
from geom.constants import ALPHA_CU
from geom.errors import ThermoscopeError
from lumped.drives.drive import Controller, Cycle, SeriesMachine, Vehicle, drive_cycle
from lumped.drives.induction import InductionMachine
from lumped.drives.permanent_magnet import PMMachine
from lumped.integration.compiled import READINGS
from lumped.integration.simulate import Record, Run, simulate, start_state
from lumped.model.network import Network, Row

Drive = Callable[[Mapping[str, Array]], Mapping[str, Array]]


@dataclass(frozen=True)
class Coupled:
    """The converged run, the inputs it ran on, and the largest change (K) of a watched temperature in every round."""

    run: Run
    inputs: Mapping[str, Array | float]
    residuals: tuple[float, ...]


def coupled(
    network: Network,
    record: Record,
    drive: Drive,
    places: Mapping[str, str],
    values: Mapping[str, float] | None = None,
    rows: Sequence[Row] = (),
    tolerance: float = 1e-3,
    most: int = 30,
) -> Coupled:
    """Waveform iteration: drive(temperatures over the record) -> inputs, network -> temperatures, and again.

    places : name the drive knows -> place of the network;  record.inputs: what the drive does not give
    tolerance : K, largest change of a watched temperature over the whole record between two rounds
    """
    looks = [network.place(place).mean for place in places.values()]
    start = np.concatenate([start_state(network, record), np.zeros(len(network.boundaries))])
    T = {n: np.full(record.time.size, r.at(start)) for n, r in zip(places, looks, strict=True)}
    residuals: list[float] = []
    for _ in range(most):
        inputs = {**record.inputs, **drive(T)}
        final = replace(record, inputs=inputs)
        run = simulate(network, final, values, [*looks, *rows], keep_states=True, precision=READINGS)
        new = {name: run.y[:, k] for k, name in enumerate(places)}
        residuals.append(max((float(np.abs(new[n] - T[n]).max()) for n in places), default=0.0))
        T = new
        if residuals[-1] < tolerance:
            return Coupled(_without(run, len(looks)), inputs, tuple(residuals))
    last_residuals = ", ".join(f"{r:.3g}" for r in residuals[-4:])
    raise ThermoscopeError(
        f"drive and {network.title} do not agree after {most} rounds (last changes {last_residuals} K): thermal "
        "runaway, or a drive at its limit that jumps with temperature"
    )


def _without(run: Run, first: int) -> Run:
    """The run without its first rows."""
    return replace(run, y=run.y[:, first:], finer=lambda: _without(run.finer(), first))


def series_drive(
    machine: SeriesMachine,
    vehicle: Vehicle,
    controller: Controller,
    time: Array,
    target_mps: Array,
    slope: Array,
    reference_degC: float = 20.0,
    alpha: float = ALPHA_CU,
) -> Drive:
    """The vehicle's series machine; R = R(reference) (1 + alpha (T - reference)) with T["winding"]."""

    def drive(T: Mapping[str, Array]) -> Mapping[str, Array]:
        warm = machine.R * (1.0 + alpha * (T["winding"] - reference_degC))
        cycle: Cycle = drive_cycle(machine, vehicle, controller, time, target_mps, slope, resistance=warm)
        return cycle.inputs() | {"vehicle_speed_wanted_mps": np.asarray(target_mps, float)}

    return drive


def pm_drive(machine: PMMachine, torque: Array, speed_rpm: Array, rms: bool = False) -> Drive:
    """Currents of a permanent-magnet machine for torque (N m) and speed; watches "winding" and "magnet".

    rms : give current_A as that of a phase, else as the peak sqrt(id^2 + iq^2)
    """

    def drive(T: Mapping[str, Array]) -> Mapping[str, Array]:
        i_d, i_q = machine.currents(torque, speed_rpm, T["winding"], T["magnet"])
        at = i_d, i_q, speed_rpm, T["winding"], T["magnet"]
        return {
            "id_A": i_d,
            "iq_A": i_q,
            "current_A": np.hypot(i_d, i_q) / (np.sqrt(2.0) if rms else 1.0),
            "torque_Nm": machine.torque(i_d, i_q, T["magnet"]),
            "voltage_V": machine.voltage(*at),
            "speed_rpm": np.asarray(speed_rpm, float),
            "torque_wanted_Nm": np.asarray(torque, float),
            "electrical_W": machine.power(*at),
        }

    return drive


def induction_drive(machine: InductionMachine, torque: Array, speed_rpm: Array) -> Drive:
    """Currents (rms of a phase) of a cage machine for torque (N m) and speed; watches "winding" and "cage"."""

    def drive(T: Mapping[str, Array]) -> Mapping[str, Array]:
        currents = machine.currents(torque, speed_rpm, T["winding"], T["cage"])
        at = machine.operation(*currents, speed_rpm, T["winding"], T["cage"])
        return {
            "current_A": np.hypot(at.i_d, at.i_q) / np.sqrt(2.0),
            "cage_current_A": at.cage / np.sqrt(2.0),
            "slip": np.nan_to_num(at.slip),
            "stator_Hz": at.frequency,
            "torque_Nm": at.torque,
            "voltage_V": at.voltage,
            "speed_rpm": np.asarray(speed_rpm, float),
            "torque_wanted_Nm": np.asarray(torque, float),
            "electrical_W": at.power,
        }

    return drive
