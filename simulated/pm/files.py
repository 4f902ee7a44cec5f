"""The sheet beside each record of the PM machines: its columns, with the cold readings and the data of the meters."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from simulated.road.files import inline

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
