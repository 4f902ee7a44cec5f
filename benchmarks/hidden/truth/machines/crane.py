"""The true crane motor, 22 kW, cage rotor on an inverter, blower with a switch, air through its rotor: 72 cells.

Position 0 is the drive end, 1 the blower's. The inverter weakens the field above 1500 rpm; its pulses heat copper and
iron while it switches, at standstill as well.
"""

import numpy as np

from hidden.truth import faults, foreign
from hidden.truth.archetype import Archetype, Hidden, Plan, Spot, no_tempco
from hidden.truth.body import Body, Joint, Skeleton
from hidden.truth.change import Change
from hidden.truth.draw import Draw
from hidden.truth.effects import METER, covered, draught, heating, joined, less, spinning, switched, warming
from hidden.truth.films import ALPHA, across_gap, bearing, bertotti, free_film, joule, plate_still, radiation
from hidden.truth.machine import Array, Film, Inputs, Loss
from hidden.truth.profile import Rng, levels, steady, until
from hidden.truth.readings import Logger

RATED, R1, R2, PULSES = 1500.0, 0.17, 0.11, 4000.0
COPPER, STEEL, CAST = -2e-4, -8e-4, -5e-4
ENDS = (("de", 0.0), ("fan", 0.999))


def bodies(d: Draw) -> list[Body]:
    C = d.capacity
    side = [
        b
        for end, _ in ENDS
        for b in (
            Body(f"head.{end}", C("heads", 1500.0), 4, 0.1, COPPER),
            Body(f"bearing.{end}", C("bearing", 450.0), 2, 0.1),
            Body(f"shield.{end}", C("shield", 4200.0), 5, 0.15, CAST),
            Body(f"air.{end}", 30.0),
        )
    ]
    return [
        Body("slot", C("slot", 2700.0), 6, 0.1, COPPER),
        Body("teeth", C("core", 7800.0), 6, 4.0, STEEL),
        Body("yoke", C("core", 16500.0), 6, 3.0, STEEL),
        Body("cage", C("cage", 4300.0), 7, 0.12, COPPER),
        Body("rotor", C("rotor", 13500.0), 6, 0.5, STEEL),
        Body("shaft", C("rotor", 4200.0), 7, 4.0, STEEL),
        Body("frame", C("frame", 14500.0), 10, 0.3, CAST),
        *side,
    ]


def joints(d: Draw) -> list[Joint]:
    G = d.conductance
    side = [
        j
        for end, x in ENDS
        for j in (
            Joint(f"overhang-{end}", "slot", f"head.{end}", G("overhang", 30.0, 0.15), (x, 0.0)),
            Joint(f"journal-{end}", "shaft", f"bearing.{end}", G(f"journal-{end}", 7.0), (x, 0.0)),
            Joint(f"seat-{end}", f"bearing.{end}", f"shield.{end}", G(f"seat-{end}", 16.0), (1.0, 1.0)),
            Joint(f"spigot-{end}", f"shield.{end}", "frame", G(f"spigot-{end}", 24.0), (0.0, x)),
        )
    ]
    return [
        Joint("wall", "slot", "teeth", G("wall", 95.0, 0.2), slope=4e-4),
        Joint("back", "teeth", "yoke", G("back", 330.0, 0.1), slope=STEEL),
        Joint("press", "yoke", "frame", G("press", 210.0), slope=1e-3),
        Joint("bars", "cage", "rotor", G("bars", 300.0), slope=5e-4),
        Joint("fit", "rotor", "shaft", G("fit", 60.0)),
        *side,
    ]


def films(s: Skeleton, d: Draw) -> list[Film]:
    """The blower's air fades along the ribs and mixes with still air by fourth powers; both end spaces share air."""
    level, still, cowl = 27.0 * d.factor("blower", 0.12), d.factor("still", 0.15), 34.0 * d.factor("cowl", 0.2)
    fade = 0.6 + 0.4 * (np.arange(10) + 0.5) / 10
    fade = fade / fade.mean()

    face = free_film(plate_still, 0.35, still, 0.9)

    def ribs(T: Array, Ta: Array, u: Inputs) -> Array:
        calm = 0.6 * still * plate_still(T, Ta, 0.3) + 0.35 * radiation(T, Ta, 0.9)
        return (calm**4 + (level * fade * u["blower_on"]) ** 4) ** 0.25

    def hood(T: Array, Ta: Array, u: Inputs) -> Array:
        return ((0.5 * face(T, Ta, u)) ** 4 + (cowl * u["blower_on"]) ** 4) ** 0.25

    out = [
        Film("ribs", s.cells("frame"), "T_ambient", np.full(10, 0.11), ribs),
        Film("face", s.cells("shield.de"), "T_ambient", np.full(5, 0.022), face),
        Film("hood", s.cells("shield.fan"), "T_ambient", np.full(5, 0.02), hood),
    ]
    k = 15.0 * d.factor("end spaces", 0.2)

    def stirred(T: Array, Ta: Array, u: Inputs) -> float:
        return k * (1.0 + 0.55 * (abs(u["speed_rpm"]) / 1000.0 * 8.2) ** 0.75)

    for end, x in ENDS:
        walls = ((s.cells(f"head.{end}"), 0.11), (s.cells(f"shield.{end}")[1:], 0.08))
        walls += ((np.array([s.cell("cage", x)]), 0.06), (np.array([s.cell("frame", x)]), 0.05))
        air = s.cells(f"air.{end}")
        out += [
            Film(f"space.{end}.{k}", w, air, np.full(w.size, A / w.size), stirred) for k, (w, A) in enumerate(walls)
        ]
    g = 0.5e-3 / d.factor("gap", 0.15)
    holes = Film(
        "holes", s.cells("air.de"), s.cells("air.fan"), np.ones(1), lambda T, Ta, u: 3.0 + 0.02 * u["speed_rpm"]
    )
    return [*out, holes, across_gap(s, "cage", "teeth", 0.11, 0.085, g)]


def losses(s: Skeleton, d: Draw) -> list[Loss]:
    """Bertotti at the flux that is left; bars at the current that slip drives; pulses by how far they are open."""
    R, bars = R1 * d.factor("copper", 0.04), R2 * d.factor("cage", 0.12)
    kh, ke, kx = 150.0 * d.factor("iron", 0.15), 120.0 * d.factor("eddy", 0.2), 40.0 * d.factor("excess", 0.3)
    pulses, stray = 45.0 * d.factor("pulses", 0.25), 60.0 * d.factor("stray", 0.25)

    def iron(T: Array, u: Inputs) -> Array:
        f, B = abs(u["speed_rpm"]) / RATED, u["flux_percent"] / 100.0
        return bertotti(T, f, kh * B**1.8, ke * B**2, kx * B**1.5)

    def ripple(T: Array, u: Inputs) -> float:
        m = min(abs(u["speed_rpm"]) / RATED, 1.0)
        return pulses * u["switching_Hz"] / PULSES * (0.55 + 1.8 * m * (1.0 - m))

    def load(T: Array, u: Inputs) -> float:
        return stray * (u["rotor_A"] / 40.0) ** 2 * (abs(u["speed_rpm"]) / RATED) ** 1.3

    rings = np.array([1.6, 1.0, 1.0, 1.0, 1.0, 1.0, 1.6])
    out = [
        Loss("slot", s.cells("slot"), np.full(6, 0.5 / 6), joule(R)),
        Loss("teeth", s.cells("teeth"), np.full(6, 0.5 / 6), iron),
        Loss("yoke", s.cells("yoke"), np.full(6, 0.5 / 6), iron),
        Loss("bars", s.cells("cage"), rings / rings.sum(), joule(bars, "rotor_A")),
        Loss("stray", s.cells("cage"), np.full(7, 0.6 / 7), load),
        Loss("stray teeth", s.cells("teeth"), np.full(6, 0.4 / 6), load),
        Loss("pulses", s.cells("teeth"), np.full(6, 0.65 / 6), ripple),
        Loss("pulses in copper", s.cells("slot"), np.full(6, 0.35 / 6), ripple),
    ]
    for end, _ in ENDS:
        P = 24.0 * d.factor(f"grease-{end}", 0.25)
        out.append(Loss(f"head.{end}", s.cells(f"head.{end}"), np.full(4, 0.25 / 4), joule(R)))
        out.append(Loss(f"grease.{end}", s.cells(f"bearing.{end}"), np.full(2, 0.5), bearing(P, RATED)))
    return out


def drive(current: Array, speed: Array, blower: Array) -> dict[str, Array]:
    """Flux falls above the rated speed, and with it the 15 A that magnetise; the rest of the current is the bars'."""
    flux = np.minimum(1.0, RATED / np.maximum(speed, 1.0))
    bars = np.where(speed > 0.0, 0.95 * np.sqrt(np.maximum(current**2 - (15.0 * flux) ** 2, 0.0)), 0.0)
    out = {"current_A": current, "rotor_A": bars, "speed_rpm": speed, "flux_percent": 100.0 * flux}
    return {**out, "switching_Hz": PULSES * (current > 0.0), "blower_on": blower}


def turns(at: Array, rng: Rng, minutes: float) -> Array:
    return (levels(at, rng, 0.0, 1.0, minutes) > 0.4).astype(float)


def direct(rng: Rng, at: Array) -> dict[str, Array]:
    current = levels(at, rng, 28.0, 38.0, 25.0) * until(at, 60.0, 1.0)
    return drive(current, steady(at, 0.0), (at > 2100.0).astype(float))


def stand(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(levels(at, rng, 22.0, 50.0, 12.0), levels(at, rng, 300.0, 1500.0, 15.0), turns(at, rng, 20.0))


def empty(rng: Rng, at: Array) -> dict[str, Array]:
    speed = levels(at, rng, 400.0, 3000.0, 12.0)
    return drive(15.5 * np.minimum(1.0, RATED / speed), speed, turns(at, rng, 18.0))


def ships(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(levels(at, rng, 16.0, 58.0, 3.0), levels(at, rng, 200.0, 2600.0, 4.0), turns(at, rng, 10.0))


CALLED = {"slot": "winding", "head.de": "heads", "yoke": "core", "shield.de": "front", "shield.fan": "rear"}
CALLED["bearing.de"] = "front bearing"
READ = {"slot": 0.5, "head.de": 0.5, "yoke": 0.6, "frame": 0.5, "shield.de": 0.4, "shield.fan": 0.4, "bearing.de": 0.7}
PARTS = {**{node: body for body, node in CALLED.items()}, "cage": "cage", "rotor": "rotor", "frame": "frame"}
PARTS["rear bearing"] = "bearing.fan"


CRANE = Archetype(
    name="crane",
    bodies=bodies,
    joints=joints,
    terms=(films, losses),
    plans=(
        Plan("direct current", "calibrate", 100.0, direct),
        Plan("stand", "calibrate", 100.0, stand),
        Plan("empty hook", "calibrate", 90.0, empty),
        Plan("first ship", "validate", 100.0, ships),
        Plan("second ship", "hold-out", 100.0, ships),
    ),
    thermometers={body: Spot(body, x) for body, x in READ.items()},
    missing=(
        Hidden("draught@frame", lambda a: draught("frame", a), 30.0),
        Hidden("shaft fan@shield.de", lambda a: spinning("shield.de", a), 20.0),
        Hidden("coupling heat@bearing.de", lambda a: joined("bearing.de", a), 8.0),
        Hidden("windage@cage", lambda a: heating("cage", a, (3.0, 2.75)), 100.0),
        Hidden("friction@bearing.fan", lambda a: heating("bearing.fan", a, (5 / 3, 1.3), fade=0.004), 150.0),
        Hidden("ac copper@slot", lambda a: heating("slot", a, (2.0, 1.85), (2.0, 2.0), fade=0.002), 900.0),
        Hidden("load loss@cage", lambda a: heating("cage", a, (2.0, 1.8), (2.0, 2.0)), 900.0),
        Hidden("pulses@cage", lambda a: switched("cage", a / PULSES, "switching_Hz"), 300.0),
        Hidden("no tempco@slot", lambda a: warming("slot", 3.0 * R1, a), ALPHA, no_tempco("copper")),
    ),
    faults={
        "sensor.gain@core": lambda seed: faults.gain("yoke", -0.1),
        "sensor.lag@heads": lambda seed: faults.slow("head.de", 200.0),
        "sensor.stem@front bearing": lambda seed: faults.stem("bearing.de", 0.25),
        "sensor.swap@front|rear": lambda seed: faults.swapped("shield.de", "shield.fan"),
        "sensor.bias@frame": lambda seed: faults.bias("frame", 4.0),
        "time.offset@stand": lambda seed: Change(in_test={"stand": faults.clock(READ, 240.0)}),
        "input.factor@current_A": lambda seed: Change(in_test={"stand": faults.factor("current_A", 1.15)}),
        "ambient.offset@ambient": lambda seed: faults.offset("T_ambient", 5.0),
        "frozen@rear": lambda seed: faults.frozen("shield.fan", 0.4),
    },
    foreign={
        "cable at heads": lambda seed: foreign.cable("head.de", 7.0, 5000.0),
        "splash at frame": lambda seed: foreign.gusts("frame", 700.0, seed),
        "rub at rear bearing": lambda seed: foreign.rub("bearing.fan", "rotor", "frame", 60.0),
        "heater at front": lambda seed: foreign.hot_spell("shield.de", 200.0),
    },
    absorbed={
        "frame joint": lambda seed: Change({"press": 0.25}),
        "slot wall": lambda seed: Change({"wall": 0.35}),
        "blower": lambda seed: Change({"blower": 0.5}),
        "loss.iron": lambda seed: Change({"iron": 2.2, "eddy": 2.2}),
    },
    tense=("press", "wall", "blower", "iron", "cage", "bars", "still", "stray"),
    parts=PARTS,
    passing=(
        Hidden("draught@frame", lambda a: draught("frame", a), 60.0),
        Hidden("heat@shield.de", lambda a: heating("shield.de", a), 300.0),
        Hidden("cover@frame", lambda a: covered(("ribs",), a), 0.9),
        Hidden("blower slower@frame", lambda a: less("blower_on", a), 1.5),
        Hidden("meter@current_A", lambda a: less("current_A", -a), 0.25, least=METER),
    ),
    logger=Logger(30.0, 5.0, 0.1, (10.0, 30.0), 0.1),
    called=CALLED,
    words={
        "coupling heat@bearing.de": ("conduction.shaft@front bearing", "conduction.shaft@rotor"),
        "windage@cage": ("windage@cage", "windage@rotor"),
        "friction@bearing.fan": ("bearing.friction@rear bearing", "loss.factor@loss:rear grease"),
        "pulses@cage": ("iron.pwm@cage", "iron.pwm@rotor"),
        "no tempco@slot": ("copper.feedback@copper",),
        "blower slower@frame": ("input.factor@blower_on",),
    },
)
