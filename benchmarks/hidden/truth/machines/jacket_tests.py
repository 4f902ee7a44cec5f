"""Tests, thermometers and what can go wrong on the water-jacket magnet motor."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hidden.truth import faults, foreign
from hidden.truth.archetype import Archetype, Hidden, Plan, Spot
from hidden.truth.change import Change
from hidden.truth.effects import METER, airflow, covered, draught, heating, less, stirred_gap
from hidden.truth.machines.jacket import machine
from hidden.truth.profile import levels, steady, until

Array = NDArray[np.float64]
Rng = np.random.Generator


def drive(at: Array, current: Array, speed: Array, wind: Array, flow: Array, inlet: Array) -> dict[str, Array]:
    """The chiller starts 5 K below `inlet` and is there after some minutes."""
    warming = inlet - 5.0 * np.exp(-at / 200.0)
    return {
        "current_A": current,
        "speed_rpm": speed,
        "vehicle_speed_mps": wind,
        "flow_l_min": flow,
        "T_coolant": warming,
    }


def direct(rng: Rng, at: Array) -> dict[str, Array]:
    """Direct current at standstill, then cooling down; the inlet steps up midway."""
    current = levels(at, rng, 120.0, 220.0, 20.0) * until(at, 55.0, 1.0)
    inlet = 44.0 + 8.0 * (at > 1800.0)
    return drive(at, current, steady(at, 0.0), steady(at, 0.0), steady(at, 8.0), inlet)


def load(rng: Rng, at: Array) -> dict[str, Array]:
    flow = np.where(at > 2500.0, 7.0, 10.0)
    return drive(at, levels(at, rng, 60.0, 260.0, 10.0), steady(at, 3000.0), steady(at, 0.0), flow, steady(at, 50.0))


def speeds(rng: Rng, at: Array) -> dict[str, Array]:
    speed = levels(at, rng, 500.0, 8000.0, 9.0)
    return drive(at, levels(at, rng, 40.0, 160.0, 14.0), speed, steady(at, 0.0), steady(at, 8.0), steady(at, 48.0))


def road(rng: Rng, at: Array) -> dict[str, Array]:
    wind, inlet = levels(at, rng, 0.0, 25.0, 5.0), 50.0 + 4.0 * np.sin(at / 900.0 + 6.0 * rng.uniform())
    return drive(
        at, levels(at, rng, 40.0, 240.0, 4.0), levels(at, rng, 800.0, 7000.0, 6.0), wind, steady(at, 8.0), inlet
    )


PLANS = (
    Plan("standstill", "calibrate", 75.0, direct),
    Plan("load", "calibrate", 75.0, load),
    Plan("speeds", "calibrate", 75.0, speeds),
    Plan("road", "validate", 75.0, road),
    Plan("road-2", "hold-out", 75.0, road),
)
MISSING = (
    Hidden("convection@shield.de", lambda a: airflow("shield.de", a), 30.0),
    Hidden("convection@housing", lambda a: airflow("housing", a), 80.0),
    Hidden("convection.constant@shield.nde", lambda a: draught("shield.nde", a), 20.0),
    Hidden("windage@rotor", lambda a: heating("rotor", a, (3.0, 2.8)), 10.0),  # 240 degC in the magnets
    Hidden("loss.rotor@magnets", lambda a: heating("magnets", a, (2.0, 1.8), fade=0.001), 60.0),
    Hidden("loss.rotor.load@magnets", lambda a: heating("magnets", a, (2.0, 1.8), (2.0, 2.0)), 60.0),
    Hidden("copper.ac@winding.slot", lambda a: heating("slot", a, (2.0, 1.8), (2.0, 2.0), fade=0.002), 60.0),
    Hidden("gap.convection@magnets|stator", lambda a: stirred_gap(a, "magnets", "teeth"), 30.0),
    Hidden("loss.constant@shield.nde", lambda a: heating("shield.nde", a), 200.0),
)
FAULTS = {
    "sensor.bias@housing": lambda seed: faults.bias("housing", 4.0),
    "sensor.lag@winding.de": lambda seed: faults.slow("winding.de", 120.0),
    "sensor.gain@stator": lambda seed: faults.gain("stator", -0.12),
    "sensor.stem@magnets": lambda seed: faults.stem("magnets", 0.25),
    "sensor.delay@winding.slot": lambda seed: faults.late("winding.slot", 90.0),
    "sensor.drift@stator": lambda seed: faults.drift("stator", 4.0),
    "sensor.swap@stator|winding.slot": lambda seed: faults.swapped("winding.slot", "stator"),
    "ambient.offset@coolant": lambda seed: faults.offset("T_coolant", 5.0),
    "frozen@shield.de": lambda seed: faults.frozen("shield.de", 0.5),
    "clipped@winding.slot": lambda seed: faults.clipped("winding.slot", 0.6),
}
FOREIGN = {
    "cable at winding.nde": lambda seed: foreign.cable("winding.nde", 8.0, 4000.0),
    "demagnetisation at magnets": lambda seed: foreign.runaway("magnets", 60.0, 50.0),
    "splash at shield.de": lambda seed: foreign.gusts("shield.de", 300.0, seed),
    "rub at shield.nde": lambda seed: foreign.rub("bearing.nde", "rotor", "housing", 30.0),
}
ABSORBED = {
    "link.fit": lambda seed: Change({"fit": 0.2}),
    "link.liner": lambda seed: Change({"liner": 0.25}),
    "link.jacket": lambda seed: Change({"jacket": 0.3}),
    "loss.iron": lambda seed: Change({"iron": 2.2, "eddy": 2.2}),
}
TENSE = {
    "fit": 0.25,
    "liner": 0.2,
    "jacket": 0.15,
    "iron": 0.15,
    "glue": 0.2,
    "mount": 0.25,
    "spigot-de": 0.25,
    "potting-de": 0.25,
    "gap": 0.15,
    "magnet": 0.2,
}
PARTS = {
    "winding.slot": "slot",
    "winding.de": "winding.de",
    "winding.nde": "winding.nde",
    "stator": "yoke",
    "magnets": "magnets",
    "rotor": "rotor",
    "housing": "housing",
    "shield.de": "shield.de",
    "shield.nde": "shield.nde",
}
PASSING = (
    Hidden("convection.constant@housing", lambda a: draught("housing", a), 60.0),
    Hidden("convection.constant@shield.nde", lambda a: draught("shield.nde", a), 20.0),
    Hidden("loss.constant@shield.nde", lambda a: heating("shield.nde", a), 200.0),
    Hidden("pump@coolant", lambda a: less("flow_l_min", a), 1.5),
    Hidden("cover@housing", lambda a: covered(("drum",), a), 0.9),
    Hidden("meter@current_A", lambda a: less("current_A", a), 0.5, least=METER),
)
WORDS = {
    "pump@coolant": ("flow@stream.coolant", "input.factor@flow_l_min"),
    "cover@housing": ("blockage@housing",),
    "meter@current_A": ("input.factor@current_A",),
}
JACKET = Archetype(
    "jacket",
    machine,
    PLANS,
    {
        "winding.slot": Spot("slot", 0.5),
        "winding.de": Spot("winding.de", 0.5),
        "stator": Spot("yoke", 0.5),
        "magnets": Spot("magnets", 0.5),
        "housing": Spot("housing", 0.5),
        "shield.de": Spot("shield.de", 0.5),
        "shield.nde": Spot("shield.nde", 0.5),
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
