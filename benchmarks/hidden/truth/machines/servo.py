"""The true servo motor, 0.1 kW, brushless, on an aluminium bracket: 27 cells, two thermometers."""

import numpy as np

from hidden.truth import faults, foreign
from hidden.truth.archetype import Archetype, Hidden, Plan, Spot, no_tempco
from hidden.truth.body import Body, Joint, Skeleton
from hidden.truth.change import Change
from hidden.truth.draw import Draw
from hidden.truth.effects import METER, covered, draught, heating, joined, less, spinning, switched, warming
from hidden.truth.films import ALPHA, across_gap, bearing, cylinder_still, free_film, joule, plate_still
from hidden.truth.machine import Array, Film, Loss
from hidden.truth.profile import Rng, levels, steady, until
from hidden.truth.readings import Logger

R20, ALUMINIUM = 0.19, -1e-4  # ohm per phase, three of them


def bodies(d: Draw) -> list[Body]:
    def C(key: str, value: float) -> float:
        return d.capacity(key, value, 0.06)

    return [
        Body("copper", C("copper", 42.0), 5, 3.0, -2e-4),
        Body("teeth", C("iron", 120.0), 5, 9.0, -8e-4),
        Body("case", C("case", 150.0), 6, 1.2, ALUMINIUM),
        Body("lid", C("lid", 45.0), 2, 0.6, ALUMINIUM),
        Body("rotor", C("rotor", 75.0), 4, 6.0),
        Body("bracket", 45.0, 5, 0.8, ALUMINIUM),
    ]


def joints(d: Draw) -> list[Joint]:
    return [
        Joint("enamel", "copper", "teeth", 1.7 * d.factor("enamel", 0.2), slope=4e-4),
        Joint("shrink", "teeth", "case", 12.0 * d.factor("shrink", 0.2), slope=1e-3),
        Joint("screws", "case", "lid", 1.5 * d.factor("screws", 0.25), (1.0, 0.0)),
        Joint("bearings", "rotor", "case", 0.16 * d.factor("bearings", 0.25), (0.0, 0.0)),
        Joint("flange", "case", "bracket", 0.35 * d.factor("flange", 0.25), (0.0, 0.0)),
    ]


def films(s: Skeleton, d: Draw) -> list[Film]:
    """Free air on a small black box and on its bracket; the rotor stirs its gap of half a millimetre."""
    still, g = d.factor("still", 0.12), 0.45e-3 / d.factor("gap", 0.15)

    box = free_film(cylinder_still, 0.055, still, 0.85)
    plate = free_film(plate_still, 0.12, still, 0.1)
    return [
        Film("box", s.cells("case"), "T_ambient", np.full(6, 0.013 / 6), box),
        Film("lid", s.cells("lid"), "T_ambient", np.full(2, 0.0015), box),
        Film("plate", s.cells("bracket"), "T_ambient", np.full(5, 0.012 / 5), plate),
        across_gap(s, "rotor", "teeth", 0.0045, 0.014, g),
    ]


def losses(s: Skeleton, d: Draw) -> list[Loss]:
    R, iron, grease = R20 * d.factor("copper", 0.04), 2.4 * d.factor("iron", 0.2), 0.8 * d.factor("grease", 0.3)

    def core(T: Array, u) -> float:
        f = u["speed_rpm"] / 3000.0
        return iron * (0.55 * f + 0.45 * f**2)

    return [
        Loss("winding", s.cells("copper"), np.full(5, 0.2), joule(R)),
        Loss("iron", s.cells("teeth"), np.full(5, 0.2), core),
        Loss("grease", s.cells("rotor"), np.full(4, 0.25), bearing(grease, 3000.0, 0.008, 1.3)),
    ]


def drive(current: Array, speed: Array) -> dict[str, Array]:
    """The inverter switches at 16 kHz whenever the shaft turns; held by direct current it is off."""
    return {"current_A": current, "speed_rpm": speed, "switching_Hz": 16000.0 * (speed > 0.0)}


def held(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(levels(at, rng, 5.0, 7.0, 15.0) * until(at, 35.0, 1.0), steady(at, 0.0))


def idle(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(steady(at, 0.4), levels(at, rng, 800.0, 4500.0, 12.0))


def duty(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(levels(at, rng, 0.5, 7.5, 3.0), levels(at, rng, 300.0, 4000.0, 4.0))


SERVO = Archetype(
    name="servo",
    bodies=bodies,
    joints=joints,
    terms=(films, losses),
    plans=(
        Plan("Stillstand", "calibrate", 50.0, held),
        Plan("Leerlauf", "calibrate", 50.0, idle),
        Plan("Takt 1", "calibrate", 50.0, duty),
        Plan("Takt 2", "validate", 50.0, duty),
        Plan("Takt 3", "hold-out", 50.0, duty),
    ),
    thermometers={"copper": Spot("copper", 0.7), "case": Spot("case", 0.5)},
    missing=(
        Hidden("draught@case", lambda a: draught("case", a), 1.5),
        Hidden("shaft fan@case", lambda a: spinning("case", a), 1.0),
        Hidden("coupling heat@rotor", lambda a: joined("rotor", a), 0.6),
        Hidden("windage@rotor", lambda a: heating("rotor", a, (3.0, 2.7)), 1.0),
        Hidden("bearing friction@rotor", lambda a: heating("rotor", a, (5 / 3, 1.2), fade=0.004), 3.0),
        Hidden("ac copper@copper", lambda a: heating("copper", a, (2.0, 1.85), (2.0, 2.0), fade=0.002), 400.0),
        Hidden("inverter iron@case", lambda a: switched("teeth", a / 16000.0, "switching_Hz"), 15.0),
        Hidden("no tempco@copper", lambda a: warming("copper", 3.0 * R20, a), ALPHA, no_tempco("Kupfer")),
    ),
    faults={
        "sensor.gain@Wicklung": lambda seed: faults.gain("copper", -0.1),
        "sensor.lag@Wicklung": lambda seed: faults.slow("copper", 120.0),
        "sensor.stem@Gehaeuse": lambda seed: faults.stem("case", 0.25),
        "time.offset@Takt 1": lambda seed: Change(in_test={"Takt 1": faults.clock(("copper", "case"), 150.0)}),
        "input.factor@current_A": lambda seed: faults.factor("current_A", 1.12),
        "ambient.offset@Umgebung": lambda seed: faults.offset("T_ambient", 4.0),
        "frozen@Gehaeuse": lambda seed: faults.frozen("case", 0.5),
    },
    foreign={
        "cable at Wicklung": lambda seed: foreign.cable("copper", 0.25, 60.0),
        "splash at Gehaeuse": lambda seed: foreign.gusts("case", 12.0, seed),
        "heater at Gehaeuse": lambda seed: foreign.hot_spell("lid", 4.0, 900.0, 2100.0),
    },
    absorbed={
        "loss.Eisen": lambda seed: Change({"iron": 2.2}),
        "link.Luftspalt": lambda seed: Change({"bearings": 3.5}),
    },
    tense=("enamel", "shrink", "flange", "still", "iron", "grease"),
    parts={"Wicklung": "copper", "Gehaeuse": "case", "Rotor": "rotor"},
    passing=(
        Hidden("draught@case", lambda a: draught("case", a), 1.5),
        Hidden("heat@case", lambda a: heating("case", a), 15.0),
        Hidden("cover@case", lambda a: covered(("box",), a), 0.9),
        Hidden("meter@current_A", lambda a: less("current_A", -a), 0.25, least=METER),
    ),
    logger=Logger(10.0, 5.0, 0.1, (2.0, 10.0)),
    called={"copper": "Wicklung", "case": "Gehaeuse", "ambient": "Umgebung"},
    words={
        "coupling heat@rotor": ("conduction.shaft@Rotor",),
        "windage@rotor": ("windage@Rotor",),
        # that the declared friction is a factor too small is the same heat by the same law at the same node
        "bearing friction@rotor": ("bearing.friction@Rotor", "bearing.friction@Gehaeuse", "loss.factor@loss:Lager"),
        "no tempco@copper": ("copper.feedback@Kupfer",),
    },
)
