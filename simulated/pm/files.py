"""Readings of the PM machines by meters that err, and the sheet beside each record with the data of these meters."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulated.physics.draws import Draws
from simulated.road.files import inline

Array = NDArray[np.float64]

SWITCHES = {"none": (0, 0), "plate": (1, 0), "bench": (0, 1)}  # on_plate, on_bench
PLACES = {"none": "on a wooden base", "plate": "on the aluminium plate", "bench": "on the test bench"}


def sheet(name: str, base: str, current: float, cold: Mapping[str, float], ambient_end: float) -> dict[str, Any]:
    """The tables of NAME.toml."""
    what = f"{current:g} A, machine {PLACES[base]}"
    words = f"Thermal test '{name}': {what}. Simulated measurement, see docs/data-pmsm.md."
    reading = {"reading": round(cold["cold_V"], 1), "at_degC": cold["cold_degC"], "rpm": 383}
    columns: dict[str, Any] = {
        "current_A": {"quantity": "current", "unit": "A"},
        "speed_rpm": {"quantity": "speed", "unit": "rpm"},
        "T_ambient_degC": {"quantity": "temperature", "unit": "degC", "place": "ambient", "sigma_K": 0.2},
        f"R_{name}": _resistance(name, cold, ambient_end),
        f"emf_{name}": {
            "column": "emf_V",
            "quantity": "back_emf",
            "unit": "V",
            "place": "magnets",
            "cold": inline(reading),
            "coefficient_percent_K": [-0.11, -0.10],
            "meter": inline({"percent": 0.1, "offset": 1.0}),
            "speed_rpm": 383,
        },
    }
    test = {"time": "time_s", "description": words, "initial": cold["cold_degC"], "max_gap_s": 1200}
    plate, bench = SWITCHES[base]
    return {"test": test, "inputs": {"on_plate": plate, "on_bench": bench}, "columns": columns}


def _resistance(name: str, cold: Mapping[str, float], ambient_end: float) -> dict[str, Any]:
    after = {
        "file": f"{name}-cooling.csv",
        "column": "R_winding_ohm",
        "method": "exponentials",
        "ambient_degC": ambient_end,
        "rated_kW": 7,
    }
    return {
        "column": "R_winding_ohm",
        "quantity": "resistance",
        "unit": "ohm",
        "place": "winding.copper",
        "cold": inline({"reading": round(cold["cold_ohm"], 4), "at_degC": cold["cold_degC"]}),
        "reference_degC": 20,
        "coefficient_percent_K": [0.392, 0.393],
        "meter": inline({"percent": 0.25, "offset": 0.002, "resolution": 0.002, "range": [0.4, 4.0]}),
        "after": inline(after),
    }


# Ohmmeter and voltmeter: a gain and an offset for each session within the data sheet, and steps.
SHEETS = {"ohm": (0.25e-2, 2e-3, 2e-3), "volt": (0.1e-2, 1.0, 0.1)}  # gain, offset, step in ohm or V


def read(kind: str, true: Array | float, session: str, draws: Draws) -> Array:
    """Readings of one session, in which the meter's error does not change."""
    gain, offset, step = SHEETS[kind]
    errors = draws.stream(f"meter.{kind}.{session}").uniform(-1.0, 1.0, 2)
    draws.taken[f"meter.{kind}.{session}.gain"] = float(gain * errors[0])
    draws.taken[f"meter.{kind}.{session}.offset"] = float(offset * errors[1])
    seen = np.asarray(true, float) * (1 + gain * errors[0]) + offset * errors[1]
    return np.asarray(np.round(seen / step) * step)


def thermometer(true: Array | float, session: str, draws: Draws) -> Array:
    """A thermometer with a bias of 0.2 K (1 sigma) per session, read to 0.1 K."""
    seen = np.asarray(true, float) + draws.normal(f"thermometer.{session}.bias_K", 0.2, 0.4)
    return np.asarray(np.round(seen, 1))


def emf(cold_V: float, alpha: float, magnets: Array | float) -> Array:
    """Line-to-line back-EMF (V) at 383 rpm; the magnets lose `alpha` per K above 20 degC."""
    return cold_V * (1 + alpha * (np.asarray(magnets, float) - 20.0))
