"""Tests, thermometers and what can go wrong on the mill's motor, whose user numbers his nodes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hidden.truth import faults, foreign
from hidden.truth.archetype import Archetype, Hidden, Plan, Spot
from hidden.truth.change import Change
from hidden.truth.effects import METER, airflow, covered, draught, heating, joined, less, spinning, switched, warming
from hidden.truth.losses import ALPHA
from hidden.truth.machines.mill import R20, machine
from hidden.truth.profile import levels, steady, until
from hidden.truth.readings import Logger

Array = NDArray[np.float64]
Rng = np.random.Generator
NODES = {
    "n1": "slot",
    "n2": "coil.de",
    "n3": "coil.nde",
    "n4": "teeth",
    "n5": "yoke",
    "n6": "rotor",
    "n9": "bearing.de",
    "n10": "bearing.nde",
    "n11": "shield.de",
    "n12": "shield.nde",
    "n13": "frame",
    "n15": "feet",
}
CALLED = {body: node for node, body in NODES.items()}


def drive(current: Array, speed: Array, wind: Array) -> dict[str, Array]:
    """The mill's door stands open at times (wind); the inverter switches at 4 kHz whenever the motor turns loaded."""
    on = (speed > 0.0) & (current > 0.0)
    return {"current_A": current, "speed_rpm": speed, "vehicle_speed_mps": wind, "switching_Hz": 4000.0 * on}


def direct(rng: Rng, at: Array) -> dict[str, Array]:
    current = levels(at, rng, 55.0, 75.0, 30.0) * until(at, 75.0, 1.0)
    return drive(current, steady(at, 0.0), steady(at, 0.0))


def stand(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(levels(at, rng, 45.0, 95.0, 15.0), levels(at, rng, 900.0, 1480.0, 20.0), steady(at, 0.0))


def towed(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(steady(at, 0.0), levels(at, rng, 300.0, 2000.0, 18.0), steady(at, 0.0))


def shift(rng: Rng, at: Array) -> dict[str, Array]:
    wind = levels(at, rng, 0.0, 6.0, 6.0)
    return drive(levels(at, rng, 35.0, 100.0, 5.0), levels(at, rng, 500.0, 1600.0, 7.0), wind)


PLANS = (
    Plan("dc heating", "calibrate", 120.0, direct),
    Plan("stand", "calibrate", 120.0, stand),
    Plan("towed", "calibrate", 100.0, towed),
    Plan("shift", "validate", 120.0, shift),
    Plan("late shift", "hold-out", 120.0, shift),
)
MISSING = (
    Hidden("road wind@n11", lambda a: airflow("shield.de", a, 0.35), 30.0),
    Hidden("shaft fan@n11", lambda a: spinning("shield.de", a), 20.0),
    Hidden("coupling heat@n9", lambda a: joined("bearing.de", a), 8.0),
    Hidden("draught@n13", lambda a: draught("frame", a), 30.0),
    Hidden("windage@n6", lambda a: heating("rotor", a, (3.0, 2.75)), 200.0),
    Hidden("friction@n9", lambda a: heating("bearing.de", a, (5 / 3, 1.3), fade=0.004), 150.0),
    Hidden("ac copper@n1", lambda a: heating("slot", a, (2.0, 1.85), (2.0, 2.0), fade=0.002), 900.0),
    Hidden("inverter iron@n4", lambda a: switched("teeth", a / 4000.0, "switching_Hz"), 500.0),
    Hidden("no tempco@n1", lambda a: warming("slot", 3.0 * R20, a), ALPHA, ((("losses", "copper", "alpha_1_K"), 0.0),)),
)
WORDS = {
    "road wind@n11": ("convection@n11",),
    "shaft fan@n11": ("convection.fan@n11", "convection.rotation@n11"),
    "coupling heat@n9": ("conduction.shaft@n7", "conduction.shaft@n9"),
    "draught@n13": ("convection.constant@n13", "convection.constant@n14"),
    "windage@n6": ("windage@n6",),
    "friction@n9": ("bearing.friction@n9",),
    "ac copper@n1": ("copper.ac@n1",),
    "inverter iron@n4": ("iron.pwm@n4",),
    "no tempco@n1": ("copper.feedback@copper",),
    "draught@n11": ("convection.constant@n11",),
    "heat@n12": ("loss.constant@n12",),
    "cover@n12": ("blockage@n12",),
    "meter@current_A": ("input.factor@current_A",),
}
ALL = ("slot", "coil.de", "yoke", "frame", "shield.de", "shield.nde", "bearing.de", "feet")
FAULTS = {
    "sensor.gain@n5": lambda seed: faults.gain("yoke", -0.1),
    "sensor.lag@n2": lambda seed: faults.slow("coil.de", 240.0),
    "sensor.stem@n9": lambda seed: faults.stem("bearing.de", 0.25),
    "sensor.bias@n13": lambda seed: faults.bias("frame", 4.0),
    "sensor.swap@n11|n12": lambda seed: faults.swapped("shield.de", "shield.nde"),
    "time.offset@stand": lambda seed: Change(in_test={"stand": faults.clock(ALL, 300.0)}),
    "input.factor@current_A": lambda seed: Change(in_test={"stand": faults.factor("current_A", 1.15)}),
    "ambient.offset@ambient": lambda seed: faults.offset("T_ambient", 5.0),
    "frozen@n12": lambda seed: faults.frozen("shield.nde", 0.4),
}
FOREIGN = {
    "cable at n3": lambda seed: foreign.cable("coil.nde", 9.0, 8000.0),
    "splash at n13": lambda seed: foreign.gusts("frame", 900.0, seed),
    "rub at n10": lambda seed: foreign.rub("bearing.nde", "rotor", "frame", 60.0),
    "heater at n12": lambda seed: foreign.hot_spell("shield.nde", 250.0),
}
ABSORBED = {
    "frame joint": lambda seed: Change({"press": 0.25}),
    "slot wall": lambda seed: Change({"wall": 0.35}),
    "fan": lambda seed: Change({"fan": 0.5}),
    "loss.iron": lambda seed: Change({"iron": 2.2, "eddy": 2.2}),
}
PASSING = (
    Hidden("draught@n13", lambda a: draught("frame", a), 60.0),
    Hidden("draught@n11", lambda a: draught("shield.de", a), 20.0),
    Hidden("heat@n12", lambda a: heating("shield.nde", a), 400.0),
    Hidden("cover@n12", lambda a: covered(("hood",), a), 0.9),
    Hidden("meter@current_A", lambda a: less("current_A", -a), 0.25, least=METER),
)
MILL = Archetype(
    "mill",
    machine,
    PLANS,
    {
        b: Spot(b, x)
        for b, x in (
            ("slot", 0.5),
            ("coil.de", 0.5),
            ("yoke", 0.6),
            ("frame", 0.5),
            ("shield.de", 0.4),
            ("shield.nde", 0.4),
            ("bearing.de", 0.7),
            ("feet", 0.4),
        )
    },
    {"bench": Spot("slab", 0.1)},
    MISSING,
    FAULTS,
    FOREIGN,
    ABSORBED,
    {"press": 0.25, "wall": 0.2, "fan": 0.12, "iron": 0.15, "cage": 0.15, "legs": 0.25, "seat-de": 0.25, "still": 0.15},
    {**NODES, "n7": "shaft"},
    PASSING,
    Logger(30.0, 10.0, 0.1, (10.0, 40.0), 0.1),
    CALLED,
    WORDS,
    {"n7": (0.0, 0.5), "n13": (0.0, 0.5)},
)
