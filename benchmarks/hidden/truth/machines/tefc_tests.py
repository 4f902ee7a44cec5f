"""Tests, thermometers and what can go wrong on the fan-cooled induction motor."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hidden.truth import faults, foreign
from hidden.truth.archetype import Archetype, Hidden, Plan, Spot
from hidden.truth.change import Change
from hidden.truth.effects import METER, airflow, bridge, covered, draught, fading, heating, less, spinning, stirred_gap
from hidden.truth.machines.tefc import machine
from hidden.truth.profile import levels, steady, until

Array = NDArray[np.float64]
Rng = np.random.Generator


def drive(current: Array, speed: Array, wind: Array) -> dict[str, Array]:
    """Rotor current: what the stator's exceeds 5 A of magnetising current, in quadrature; none at standstill."""
    bars = np.where(speed > 0.0, 0.8 * np.sqrt(np.maximum(current**2 - 25.0, 0.0)), 0.0)
    return {"current_A": current, "rotor_A": bars, "speed_rpm": speed, "vehicle_speed_mps": wind}


def direct(rng: Rng, at: Array) -> dict[str, Array]:
    """Direct current at standstill, then cooling down."""
    current = levels(at, rng, 9.0, 14.0, 25.0) * (until(at, 55.0, 1.0))
    return drive(current, steady(at, 0.0), steady(at, 0.0))


def load(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(levels(at, rng, 6.0, 19.0, 12.0), steady(at, 1500.0), steady(at, 0.0))


def speeds(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(levels(at, rng, 7.0, 15.0, 15.0), levels(at, rng, 400.0, 2800.0, 10.0), steady(at, 0.0))


def road(rng: Rng, at: Array) -> dict[str, Array]:
    wind = levels(at, rng, 0.0, 14.0, 5.0)
    return drive(levels(at, rng, 7.0, 18.0, 4.0), levels(at, rng, 500.0, 2600.0, 6.0), wind)


PLANS = (
    Plan("standstill", "calibrate", 75.0, direct),
    Plan("load", "calibrate", 75.0, load),
    Plan("speeds", "calibrate", 75.0, speeds),
    Plan("road", "validate", 75.0, road),
    Plan("road-2", "hold-out", 75.0, road),
)
MISSING = (
    Hidden("convection@flange.de", lambda a: airflow("flange.de", a), 8.0),
    Hidden("convection@housing", lambda a: airflow("housing", a), 60.0),
    Hidden("conduction.bench@flange.de", lambda a: bridge("foot", a, "flange.de", "bench", (0.5, 0.1)), 8.0),
    Hidden("convection.constant@flange.nde", lambda a: draught("flange.nde", a), 8.0),
    Hidden("windage@rotor", lambda a: heating("rotor", a, (3.0, 2.8)), 60.0),
    Hidden("copper.ac@winding.slot", lambda a: heating("slot", a, (2.0, 1.8), (2.0, 2.0), fade=0.002), 2e4),
    Hidden("loss.rotor.load@rotor", lambda a: heating("rotor", a, (2.0, 1.7), (2.0, 2.0)), 2e4),
    Hidden("loss.constant@flange.nde", lambda a: heating("flange.nde", a), 100.0),
    Hidden("gap.convection@core|rotor", lambda a: stirred_gap(a, "rotor", "teeth"), 30.0),
    Hidden("convection.rotation@rotor", lambda a: spinning("rotor", a), 20.0),
    Hidden("coupling@winding.de|core", lambda a: bridge("potting", a, "winding.de", "teeth", (0.7, 0.0)), 40.0),
    Hidden("fouling@housing", lambda a: fading("housing", a), 0.8),
)
FAULTS = {
    "sensor.bias@housing": lambda seed: faults.bias("housing", 4.0),
    "sensor.lag@winding.de": lambda seed: faults.slow("winding.de", 120.0),
    "sensor.gain@core": lambda seed: faults.gain("core", -0.12),
    "sensor.stem@flange.nde": lambda seed: faults.stem("flange.nde", 0.2),
    "sensor.delay@winding.slot": lambda seed: faults.late("winding.slot", 90.0),
    "sensor.drift@core": lambda seed: faults.drift("core", 4.0),
    "sensor.swap@flange.de|flange.nde": lambda seed: faults.swapped("flange.de", "flange.nde"),
    "ambient.offset@ambient": lambda seed: faults.offset("T_ambient", 5.0),
    "frozen@flange.de": lambda seed: faults.frozen("flange.de", 0.5),
    "clipped@winding.slot": lambda seed: faults.clipped("winding.slot", 0.6),
}
FOREIGN = {
    "cable at winding.nde": lambda seed: foreign.cable("winding.nde", 6.0, 4000.0),
    "splash at housing": lambda seed: foreign.gusts("housing", 300.0, seed),
    "rub at bearing.de": lambda seed: foreign.rub("bearing.de", "rotor", "housing", 40.0),
    "heater at flange.nde": lambda seed: foreign.hot_spell("flange.nde", 60.0),
}
ABSORBED = {
    "link.fit": lambda seed: Change({"fit": 0.25}),
    "link.liner": lambda seed: Change({"liner": 0.25}),
    "loss.cage": lambda seed: Change({"cage": 2.0}),
    "link.fins-fan": lambda seed: Change({"fan": 0.45}),
}
TENSE = {
    "fit": 0.25,
    "liner": 0.2,
    "fan": 0.15,
    "iron": 0.15,
    "seat-de": 0.25,
    "feet": 0.25,
    "capacity.housing": 0.1,
    "cage": 0.12,
    "spigot-de": 0.25,
    "still": 0.15,
}
PARTS = {
    "winding.slot": "slot",
    "winding.de": "winding.de",
    "winding.nde": "winding.nde",
    "core": "yoke",
    "rotor": "rotor",
    "housing": "housing",
    "flange.de": "flange.de",
    "flange.nde": "flange.nde",
    "bearing.de": "bearing.de",
    "bearing.nde": "bearing.nde",
}
PASSING = (
    Hidden("convection.constant@housing", lambda a: draught("housing", a), 60.0),
    Hidden("convection.constant@flange.de", lambda a: draught("flange.de", a), 15.0),
    Hidden("loss.constant@flange.nde", lambda a: heating("flange.nde", a), 100.0),
    Hidden("cover@housing", lambda a: covered(("fins",), a), 0.9),
    Hidden("meter@current_A", lambda a: less("current_A", a), 0.5, least=METER),
)
WORDS = {"cover@housing": ("blockage@housing",), "meter@current_A": ("input.factor@current_A",)}
TEFC = Archetype(
    "tefc",
    machine,
    PLANS,
    {
        "winding.slot": Spot("slot", 0.5),
        "winding.de": Spot("winding.de", 0.5),
        "core": Spot("yoke", 0.5),
        "housing": Spot("housing", 0.5),
        "flange.de": Spot("flange.de", 0.5),
        "flange.nde": Spot("flange.nde", 0.5),
        "bearing.de": Spot("bearing.de", 0.3),
    },
    {"bench": Spot("bench", 0.1)},
    MISSING,
    FAULTS,
    FOREIGN,
    ABSORBED,
    TENSE,
    PARTS,
    PASSING,
    words=WORDS,
)
