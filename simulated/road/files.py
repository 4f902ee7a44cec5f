"""The files of a test: NAME.csv as recorded, NAME.toml that says what each column is, and the truth."""

import csv
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import tomlkit
from numpy.typing import NDArray

from simulated.physics.draws import Draws
from simulated.road.run import Result
from simulated.road.sensors import EXHAUST, SIGMA_K, THERMOCOUPLES, Sensor, recorded

Array = NDArray[np.float64]

# column -> quantity, unit, place, input, decimals
INPUTS = {
    "current_A": ("current", "A", "", "current_A", 2),
    "voltage_V": ("voltage", "V", "", "voltage_V", 2),
    "speed_rpm": ("speed", "rpm", "", "speed_rpm", 0),
    "vehicle_speed_kmh": ("vehicle_speed", "km/h", "", "vehicle_speed_mps", 1),
    "fan_flow_m3h": ("air_flow", "m3/h", "", "fan_flow_m3h", 1),
    "T_ambient_degC": ("temperature", "degC", "ambient", "", 1),
}


def measured_inputs(result: Result, test: str, draws: Draws) -> dict[str, Array]:
    """The inputs with their meters' errors: the same meters in all tests, ambient probe placed anew in each.

    Each value is the mean over the interval that ends at its time; the current is the root mean square.
    """
    random, n = draws.stream(f"{test}.meters"), len(result.time)
    gain = {name: 1 + draws.normal(f"meter.{name}.gain", sd) for name, sd in (("current", 0.004), ("voltage", 0.003))}
    flow = 1 + draws.normal("meter.flow.gain", 0.02, 0.03)
    ambient = draws.normal(f"meter.ambient.{test}.bias_K", 0.35, 0.5)
    rms = np.sqrt([now.current2 for now in result.inputs])
    return {
        "current_A": gain["current"] * rms + 0.1 * random.standard_normal(n) * (rms > 0),
        "voltage_V": gain["voltage"] * result.voltage + 0.05 * random.standard_normal(n) * (rms > 0),
        "speed_rpm": np.array([now.rpm for now in result.inputs]),
        "vehicle_speed_kmh": np.array([3.6 * now.vehicle for now in result.inputs]),
        "fan_flow_m3h": flow * np.array([now.flow for now in result.inputs]) + 0.5 * random.standard_normal(n),
        "T_ambient_degC": np.array([now.ambient for now in result.inputs]) + ambient + 0.05 * random.standard_normal(n),
    }


def write_csv(path: Path, result: Result, sensors: Sequence[Sensor], test: str, draws: Draws) -> None:
    random = draws.stream(f"{test}.readings")
    columns = {"time_s": [f"{t:.0f}" for t in result.time]}
    for name, values in measured_inputs(result, test, draws).items():
        columns[name] = [f"{abs(v) if abs(v) < 0.005 else v:.{INPUTS[name][4]}f}" for v in values]
    for sensor, values in zip(sensors, result.T.T):
        columns[sensor.name] = [f"{v:.1f}" for v in recorded(sensor, result.time, values, random)]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*columns.values()))


def write_sheets(folder: Path, descriptions: Mapping[str, str]) -> None:
    """columns.toml: the columns as the drawing of the test set-up has them, nominal positions and lags; NAME.toml."""
    columns: dict[str, dict[str, object]] = {}
    for name, (quantity, unit, place, feeds, _) in INPUTS.items():
        columns[name] = {"quantity": quantity, "unit": unit}
        columns[name] |= {"place": place, "sensor": "thermocouple", "sigma_K": 0.4} if place else {"input": feeds}
    for name, (part, position, lag) in THERMOCOUPLES.items():
        columns[name] = _thermocouple(part, lag) | {"position_mm": list(position)}
    columns[EXHAUST[0]] = _thermocouple(EXHAUST[1], EXHAUST[2])
    clock = {"time": "time_s", "time_unit": "s"}
    _write(folder / "columns.toml", {"test": {**clock, "description": "the columns of every test"}, "columns": columns})
    for name, words in descriptions.items():
        sheet = {**clock, "description": words, "initial": "first-readings", "columns_of": "columns.toml"}
        _write(folder / f"{name}.toml", {"test": sheet})


def inline(values: Mapping[str, object]) -> tomlkit.items.InlineTable:
    """A table on one line."""
    table = tomlkit.inline_table()
    table.update(values)
    return table


def _write(path: Path, tables: Mapping[str, object]) -> None:
    path.write_text(tomlkit.dumps(tables), encoding="utf-8")


def _thermocouple(place: str, lag: float) -> dict[str, object]:
    kind = {"quantity": "temperature", "unit": "degC", "place": place, "sensor": "thermocouple"}
    return {**kind, "sigma_K": SIGMA_K, "lag_s": lag}


def write_truth(path: Path, draws: Draws, sensors: Sequence[Sensor], sections: dict[str, object]) -> None:
    """All drawn values, true sensor positions, and the sections given (the hidden effect, the runs)."""
    document = tomlkit.document()
    document.add(tomlkit.comment("The truth behind cases/road-test. Nothing under the rooms reads this file."))
    document["seed"] = draws.seed
    for name, section in sections.items():
        document[name] = section
    document["drawn"] = {name: float(f"{value:.6g}") for name, value in sorted(draws.taken.items())}
    placed = {s.name: [round(float(1e3 * x), 2) for x in s.position] for s in sensors if s.position is not None}
    document["true_position_mm"] = placed
    path.write_text(tomlkit.dumps(document), encoding="utf-8")
