"""Tests, thermometers and what can go wrong on the brushed motor."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hidden.truth import faults, foreign
from hidden.truth.archetype import Archetype, Hidden, Plan, Spot
from hidden.truth.change import Change
from hidden.truth.effects import METER, airflow, bridge, covered, draught, fading, heating, less, stirred_gap
from hidden.truth.machines.brushed import machine
from hidden.truth.profile import levels, steady, until

Array = NDArray[np.float64]
Rng = np.random.Generator


def drive(current: Array, speed: Array, wind: Array, flow: Array) -> dict[str, Array]:
    return {"current_A": current, "speed_rpm": speed, "vehicle_speed_mps": wind, "fan_flow_m3h": flow}


def direct(rng: Rng, at: Array) -> dict[str, Array]:
    """Current at a locked rotor, then cooling down; less air from half time on."""
    current = levels(at, rng, 60.0, 130.0, 25.0) * until(at, 55.0, 1.0)
    return drive(current, steady(at, 0.0), steady(at, 0.0), np.where(at > 2100.0, 250.0, 400.0))


def load(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(levels(at, rng, 50.0, 190.0, 11.0), steady(at, 900.0), steady(at, 0.0), steady(at, 400.0))


def speeds(rng: Rng, at: Array) -> dict[str, Array]:
    flow = np.where(at > 2700.0, 300.0, 420.0)
    return drive(levels(at, rng, 50.0, 140.0, 15.0), levels(at, rng, 250.0, 2000.0, 9.0), steady(at, 0.0), flow)


def road(rng: Rng, at: Array) -> dict[str, Array]:
    wind = levels(at, rng, 0.0, 18.0, 5.0)
    return drive(levels(at, rng, 40.0, 200.0, 4.0), levels(at, rng, 300.0, 1900.0, 6.0), wind, steady(at, 380.0))


PLANS = (
    Plan("locked", "calibrate", 75.0, direct),
    Plan("load", "calibrate", 75.0, load),
    Plan("speeds", "calibrate", 75.0, speeds),
    Plan("road", "validate", 75.0, road),
    Plan("road-2", "hold-out", 75.0, road),
)
MISSING = (
    Hidden("convection@flange.de", lambda a: airflow("flange.de", a), 20.0),
    Hidden("convection@yoke", lambda a: airflow("yoke", a), 60.0),
    Hidden("conduction.bench@flange.de", lambda a: bridge("foot", a, "flange.de", "bench", (0.5, 0.1)), 15.0),
    Hidden("convection.constant@flange.nde", lambda a: draught("flange.nde", a), 15.0),
    Hidden("brush.drop@commutator", lambda a: heating("commutator", a, (0, 0), (1.0, 0.9), fade=0.001), 400.0),
    Hidden("brush.friction@commutator", lambda a: heating("commutator", a, (1.0, 0.9), fade=0.001), 300.0),
    Hidden("windage@rotor", lambda a: heating("core", a, (3.0, 2.8)), 200.0),
    Hidden("copper.ac@winding.armature", lambda a: heating("armature", a, (2.0, 1.8), (2.0, 2.0), fade=0.002), 600.0),
    Hidden("gap.convection@poles|rotor", lambda a: stirred_gap(a, "core", "poles"), 40.0),
    Hidden("loss.constant@flange.de", lambda a: heating("flange.de", a), 200.0),
    Hidden("fouling@yoke", lambda a: fading("yoke", a), 0.8),
)
FAULTS = {
    "sensor.bias@yoke": lambda seed: faults.bias("yoke", 4.0),
    "sensor.lag@winding.field": lambda seed: faults.slow("winding.field", 150.0),
    "sensor.gain@poles": lambda seed: faults.gain("poles", -0.12),
    "sensor.stem@commutator": lambda seed: faults.stem("commutator", 0.2),
    "sensor.delay@commutator": lambda seed: faults.late("commutator", 90.0),
    "sensor.drift@poles": lambda seed: faults.drift("poles", 4.0),
    "sensor.swap@flange.de|flange.nde": lambda seed: faults.swapped("flange.de", "flange.nde"),
    "ambient.offset@ambient": lambda seed: faults.offset("T_ambient", 5.0),
    "frozen@flange.de": lambda seed: faults.frozen("flange.de", 0.5),
    "clipped@winding.field": lambda seed: faults.clipped("winding.field", 0.6),
}
FOREIGN = {
    "cable at winding.field": lambda seed: foreign.cable("field", 10.0, 6000.0),
    "splash at yoke": lambda seed: foreign.gusts("yoke", 500.0, seed),
    "rub at flange.de": lambda seed: foreign.rub("bearing.de", "core", "yoke", 60.0),
    "heater at flange.nde": lambda seed: foreign.hot_spell("flange.nde", 120.0),
}
ABSORBED = {
    "link.bolts": lambda seed: Change({"bolts": 0.2}),
    "link.coil": lambda seed: Change({"coil": 0.3}),
    "fan.flow": lambda seed: Change({"fan": 0.5}),
    "loss.brushes": lambda seed: Change({"drop": 2.0, "rub": 2.0}),
}
TENSE = {
    "bolts": 0.25,
    "coil": 0.25,
    "fan": 0.12,
    "iron": 0.15,
    "hub": 0.25,
    "feet": 0.25,
    "spigot-de": 0.25,
    "rub": 0.2,
    "still": 0.15,
    "capacity.yoke": 0.08,
}
PARTS = {
    "winding.armature": "armature",
    "rotor": "core",
    "commutator": "commutator",
    "poles": "poles",
    "winding.field": "field",
    "yoke": "yoke",
    "flange.de": "flange.de",
    "flange.nde": "flange.nde",
}
PASSING = (
    Hidden("convection.constant@yoke", lambda a: draught("yoke", a), 60.0),
    Hidden("convection.constant@flange.nde", lambda a: draught("flange.nde", a), 15.0),
    Hidden("loss.constant@flange.de", lambda a: heating("flange.de", a), 200.0),
    Hidden("fan slower@air", lambda a: less("fan_flow_m3h", a), 1.5),
    Hidden("cover@yoke", lambda a: covered(("frame",), a), 0.9),
    Hidden("meter@current_A", lambda a: less("current_A", a), 0.5, least=METER),
)
WORDS = {
    "fan slower@air": ("flow@stream.fan", "flow@fan.flow", "input.factor@fan_flow_m3h"),
    "cover@yoke": ("blockage@yoke",),
    "meter@current_A": ("input.factor@current_A",),
}
BRUSHED = Archetype(
    "brushed",
    machine,
    PLANS,
    {
        "commutator": Spot("commutator", 0.5),
        "poles": Spot("poles", 0.5),
        "winding.field": Spot("field", 0.5),
        "yoke": Spot("yoke", 0.5),
        "flange.de": Spot("flange.de", 0.5),
        "flange.nde": Spot("flange.nde", 0.5),
        "air.de": Spot("air", 0.8),
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
