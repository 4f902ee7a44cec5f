"""The true fan-cooled motor of a mill, 45 kW, cast frame on feet, driven machine on its shaft: 76 cells.

Position 0 is the drive end, 1 the fan's. The shaft is one body from coupling to fan.
"""

import numpy as np

from hidden.truth import faults, foreign
from hidden.truth.archetype import Archetype, Hidden, Plan, Spot, no_tempco
from hidden.truth.body import Body, Joint, Skeleton
from hidden.truth.change import Change
from hidden.truth.draw import Draw
from hidden.truth.effects import METER, airflow, covered, draught, heating, joined, less, spinning, switched, warming
from hidden.truth.films import ALPHA, across_gap, bearing, free_film, joule, plate_still, radiation
from hidden.truth.machine import Array, Film, Inputs, Loss
from hidden.truth.profile import Rng, levels, steady, until
from hidden.truth.readings import Logger

RATED, R20 = 1480.0, 0.062
COPPER, STEEL, CAST = -2e-4, -8e-4, -5e-4
ENDS = (("de", 0.0, 0.12, 1.0), ("nde", 1.0, 0.88, 0.8))  # name, place on frame and rotor, on the shaft; openness


def bodies(d: Draw) -> list[Body]:
    C = d.capacity
    side = [
        b
        for end, *_ in ENDS
        for b in (
            Body(f"coil.{end}", C("coil", 2900.0), 4, 0.1, COPPER),
            Body(f"bearing.{end}", C("bearing", 600.0), 2, 0.1),
            Body(f"shield.{end}", C("shield", 6200.0), 5, 0.16, CAST),
            Body(f"air.{end}", 60.0),
        )
    ]
    return [
        Body("slot", C("slot", 4600.0), 6, 0.1, COPPER),
        Body("teeth", C("teeth", 17000.0), 6, 3.0, STEEL),
        Body("yoke", C("yoke", 36000.0), 6, 2.0, STEEL),
        Body("rotor", C("rotor", 31000.0), 6, 0.25, STEEL),
        Body("shaft", C("shaft", 9000.0), 11, 4.5, STEEL),
        Body("frame", C("frame", 23000.0), 10, 0.35, CAST),
        Body("feet", C("feet", 5000.0), 3, 0.4, CAST),
        *side,
        Body("slab", 40000.0, 4, 0.3),
    ]


def joints(d: Draw) -> list[Joint]:
    G = d.conductance
    side = [
        j
        for end, x, on, _ in ENDS
        for j in (
            Joint(f"overhang-{end}", "slot", f"coil.{end}", G(f"overhang-{end}", 36.0, 0.15), (x, 0.0)),
            Joint(f"journal-{end}", "shaft", f"bearing.{end}", G(f"journal-{end}", 9.0), (on, 0.0)),
            Joint(f"seat-{end}", f"bearing.{end}", f"shield.{end}", G(f"seat-{end}", 20.0), (1.0, 1.0)),
            Joint(f"spigot-{end}", f"shield.{end}", "frame", G(f"spigot-{end}", 28.0), (0.0, x)),
        )
    ]
    return [
        Joint("wall", "slot", "teeth", G("wall", 150.0, 0.2), slope=4e-4),
        Joint("back", "teeth", "yoke", G("back", 420.0, 0.1), slope=STEEL),
        Joint("press", "yoke", "frame", G("press", 330.0), slope=1e-3),
        *side,
        Joint("core on shaft", "rotor", "shaft", G("core on shaft", 55.0), (0.5, 0.5)),
        Joint("legs", "frame", "feet", G("legs", 9.0), (0.5, 0.0)),
        Joint("bolts", "feet", "slab", G("bolts", 3.0), (1.0, 0.0)),
    ]


def outside(s: Skeleton, d: Draw) -> list[Film]:
    """The fan's air fades along the ribs (its own loss of speed, Heiles' channel to the power of 0.75); at rest still
    air and radiation of the envelope only."""
    level, power = 24.0 * d.factor("fan", 0.12), d.between("fan.power", 0.7, 0.85)
    still, cowl = d.factor("still", 0.15), 30.0 * d.factor("cowl", 0.2)
    x = (np.arange(10) + 0.5) / 10
    fade = 0.55 + 0.45 * x
    fade = fade / fade.mean()

    def ribs(T: Array, Ta: Array, u: Inputs) -> Array:
        calm = 0.55 * still * plate_still(T, Ta, 0.35) + 0.3 * radiation(T, Ta, 0.9)
        return (calm**4 + (level * fade * (abs(u["speed_rpm"]) / RATED) ** power) ** 4) ** 0.25

    face = free_film(plate_still, 0.4, still, 0.9)

    def hood(T: Array, Ta: Array, u: Inputs) -> Array:
        calm = 0.5 * still * plate_still(T, Ta, 0.4)
        return (calm**4 + (cowl * (abs(u["speed_rpm"]) / RATED) ** power) ** 4) ** 0.25

    return [
        Film("ribs", s.cells("frame"), "T_ambient", np.full(10, 0.14), ribs),
        Film("face", s.cells("shield.de"), "T_ambient", np.full(5, 0.03), face),
        Film("hood", s.cells("shield.nde"), "T_ambient", np.full(5, 0.026), hood),
        Film("feet", s.cells("feet"), "T_ambient", np.full(3, 0.03), face),
        Film("floor", s.cells("slab"), "T_ambient", np.full(4, 0.2), lambda T, Ta, u: 7.0),
    ]


def inside(s: Skeleton, d: Draw) -> list[Film]:
    out, g = [], 0.7e-3 / d.factor("gap", 0.15)
    for end, x, _, openness in ENDS:
        k = 14.0 * d.factor(f"space-{end}", 0.2)

        def h(T: Array, Ta: Array, u: Inputs, k: float = k * openness) -> float:
            return k * (1.0 + 0.5 * (abs(u["speed_rpm"]) / 1000.0 * 9.4) ** 0.7)

        walls = (
            (s.cells(f"coil.{end}"), 0.16),
            (s.cells(f"shield.{end}")[1:], 0.12),
            (np.array([s.cell("rotor", x)]), 0.07),
            (np.array([s.cell("frame", x)]), 0.06),
        )
        air = s.cells(f"air.{end}")
        out += [Film(f"space.{end}.{k}", w, air, np.full(w.size, A / w.size), h) for k, (w, A) in enumerate(walls)]

    return [*out, across_gap(s, "rotor", "teeth", 0.14, 0.1, g)]


def losses(s: Skeleton, d: Draw) -> list[Loss]:
    R, cage = R20 * d.factor("copper", 0.04), 640.0 * d.factor("cage", 0.15)
    kh, ke = 330.0 * d.factor("iron", 0.15), 260.0 * d.factor("eddy", 0.2)

    def iron(T: Array, u: Inputs) -> Array:
        f = abs(u["speed_rpm"]) / RATED
        return (kh * f + ke * f**1.9) * (1.0 - 0.0004 * (T - 40.0))

    def bars(T: Array, u: Inputs) -> Array:
        slip = min(abs(u["speed_rpm"]) / 100.0, 1.0)  # direct current at standstill induces nothing
        return slip * cage * np.maximum(u["current_A"] ** 2 - 900.0, 0.0) / 5500.0 * (1.0 + 0.004 * (T - 60.0))

    out = [
        Loss("slot", s.cells("slot"), np.full(6, 0.52 / 6), joule(R)),
        Loss("teeth", s.cells("teeth"), np.full(6, 0.55 / 6), iron),
        Loss("yoke", s.cells("yoke"), np.full(6, 0.45 / 6), iron),
        Loss("bars", s.cells("rotor"), np.full(6, 1 / 6), bars),
    ]
    for end, *_ in ENDS:
        grease = bearing(55.0 * d.factor(f"grease-{end}", 0.25), RATED, 0.007, 1.2, 50.0)
        out.append(Loss(f"coil.{end}", s.cells(f"coil.{end}"), np.full(4, 0.24 / 4), joule(R)))
        out.append(Loss(f"grease.{end}", s.cells(f"bearing.{end}"), np.full(2, 0.5), grease))
    return out


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


READ = {"slot": 0.5, "coil.de": 0.5, "yoke": 0.6, "frame": 0.5, "shield.de": 0.4, "shield.nde": 0.4}
READ |= {"bearing.de": 0.7, "feet": 0.4}


MILL = Archetype(
    name="mill",
    bodies=bodies,
    joints=joints,
    terms=(outside, inside, losses),
    plans=(
        Plan("dc heating", "calibrate", 120.0, direct),
        Plan("stand", "calibrate", 120.0, stand),
        Plan("towed", "calibrate", 100.0, towed),
        Plan("shift", "validate", 120.0, shift),
        Plan("late shift", "hold-out", 120.0, shift),
    ),
    thermometers={body: Spot(body, x) for body, x in READ.items()},
    baths={"bench": Spot("slab", 0.1)},
    missing=(
        Hidden("road wind@n11", lambda a: airflow("shield.de", a, 0.35), 30.0),
        Hidden("shaft fan@n11", lambda a: spinning("shield.de", a), 20.0),
        Hidden("coupling heat@n9", lambda a: joined("bearing.de", a), 8.0),
        Hidden("draught@n13", lambda a: draught("frame", a), 30.0),
        Hidden("windage@n6", lambda a: heating("rotor", a, (3.0, 2.75)), 200.0),
        Hidden("friction@n9", lambda a: heating("bearing.de", a, (5 / 3, 1.3), fade=0.004), 150.0),
        Hidden("ac copper@n1", lambda a: heating("slot", a, (2.0, 1.85), (2.0, 2.0), fade=0.002), 900.0),
        Hidden("inverter iron@n4", lambda a: switched("teeth", a / 4000.0, "switching_Hz"), 500.0),
        Hidden("no tempco@n1", lambda a: warming("slot", 3.0 * R20, a), ALPHA, no_tempco("copper")),
    ),
    faults={
        "sensor.gain@n5": lambda seed: faults.gain("yoke", -0.1),
        "sensor.lag@n2": lambda seed: faults.slow("coil.de", 240.0),
        "sensor.stem@n9": lambda seed: faults.stem("bearing.de", 0.25),
        "sensor.bias@n13": lambda seed: faults.bias("frame", 4.0),
        "sensor.swap@n11|n12": lambda seed: faults.swapped("shield.de", "shield.nde"),
        "time.offset@stand": lambda seed: Change(in_test={"stand": faults.clock(READ, 300.0)}),
        "input.factor@current_A": lambda seed: Change(in_test={"stand": faults.factor("current_A", 1.15)}),
        "ambient.offset@ambient": lambda seed: faults.offset("T_ambient", 5.0),
        "frozen@n12": lambda seed: faults.frozen("shield.nde", 0.4),
    },
    foreign={
        "cable at n3": lambda seed: foreign.cable("coil.nde", 9.0, 8000.0),
        "splash at n13": lambda seed: foreign.gusts("frame", 900.0, seed),
        "rub at n10": lambda seed: foreign.rub("bearing.nde", "rotor", "frame", 60.0),
        "heater at n12": lambda seed: foreign.hot_spell("shield.nde", 250.0),
    },
    absorbed={
        "frame joint": lambda seed: Change({"press": 0.25}),
        "slot wall": lambda seed: Change({"wall": 0.35}),
        "fan": lambda seed: Change({"fan": 0.5}),
        "loss.iron": lambda seed: Change({"iron": 2.2, "eddy": 2.2}),
    },
    tense=("press", "wall", "fan", "iron", "cage", "legs", "seat-de", "still"),
    parts={**NODES, "n7": "shaft"},
    passing=(
        Hidden("draught@n13", lambda a: draught("frame", a), 60.0),
        Hidden("draught@n11", lambda a: draught("shield.de", a), 20.0),
        Hidden("heat@n12", lambda a: heating("shield.nde", a), 400.0),
        Hidden("cover@n12", lambda a: covered(("hood",), a), 0.9),
        Hidden("meter@current_A", lambda a: less("current_A", -a), 0.25, least=METER),
    ),
    logger=Logger(30.0, 10.0, 0.1, (10.0, 40.0), 0.1),
    called={body: node for node, body in NODES.items()},
    words={
        "coupling heat@n9": ("conduction.shaft@n7", "conduction.shaft@n9"),
        "draught@n13": ("convection.constant@n13", "convection.constant@n14"),
        "windage@n6": ("windage@n6",),
        "no tempco@n1": ("copper.feedback@copper",),
    },
    spans={"n7": (0.0, 0.5), "n13": (0.0, 0.5)},
)
