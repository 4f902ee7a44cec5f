"""The true water-jacket magnet motor, 60 kW peak, potted end windings: 111 cells. Water runs from position 0 to 1."""

import numpy as np

from hidden.truth import faults, films, foreign
from hidden.truth.archetype import Archetype, Hidden, Plan, Spot
from hidden.truth.body import Body, Joint, Skeleton
from hidden.truth.change import Change
from hidden.truth.draw import Draw
from hidden.truth.effects import METER, airflow, covered, draught, heating, less, stirred_gap
from hidden.truth.machine import Array, Film, Inputs, Loss, Stream
from hidden.truth.profile import Rng, levels, steady, until

RATED = 4000.0
COPPER, STEEL, ALUMINIUM = -2e-4, -8e-4, -1e-4
ENDS = (("de", 0.0), ("nde", 1.0))


def bodies(d: Draw) -> list[Body]:
    C = d.capacity
    side = [
        b
        for end, _ in ENDS
        for b in (
            Body(f"winding.{end}", C(f"winding.{end}", 800.0), 5, 0.1, COPPER),
            Body(f"stub.{end}", 300.0, 4, 1.2, STEEL),
            Body(f"shield.{end}", C(f"shield.{end}", 2000.0), 6, 0.12, ALUMINIUM),
            Body(f"bearing.{end}", 200.0, 2, 0.2),
            Body(f"air.{end}", 20.0),
        )
    ]
    return [
        Body("slot", C("winding.slot", 1300.0), 11, 0.12, COPPER),
        Body("teeth", C("stator", 3500.0), 11, 9.0, STEEL),
        Body("yoke", C("stator", 4500.0), 11, 7.0, STEEL),
        Body("magnets", C("magnets", 650.0), 11, 20.0),
        Body("rotor", C("rotor", 5300.0), 11, 3.0, STEEL),
        Body("housing", C("housing", 8000.0), 11, 0.12, ALUMINIUM),
        Body("water", 1700.0, 8, 1e4, c_slope=1e-3),
        *side,
        Body("bench", 9000.0, 5, 0.2),
        Body("bench.deep", 60000.0, 5, 0.8),
    ]


def joints(d: Draw) -> list[Joint]:
    G = d.conductance
    side = [
        j
        for end, x in ENDS
        for j in (
            Joint(f"slot-{end}", "slot", f"winding.{end}", G(f"slot-{end}", 40.0, 0.1), (x, 0.0)),
            Joint(f"potting-{end}", f"winding.{end}", "housing", G(f"potting-{end}", 5.0, 0.25), (0.6, x)),
            Joint(f"rotor-{end}", "rotor", f"stub.{end}", 15.0, (x, 0.0)),
            Joint(f"shaft-{end}", f"stub.{end}", f"bearing.{end}", G(f"shaft-{end}", 8.0, 0.2), (1.0, 1.0)),
            Joint(f"seat-{end}", f"bearing.{end}", f"shield.{end}", G(f"seat-{end}", 12.0, 0.2), (0.0, 1.0)),
            Joint(f"spigot-{end}", f"shield.{end}", "housing", G(f"spigot-{end}", 20.0, 0.25), (0.0, x)),
        )
    ]
    return [
        Joint("liner", "slot", "teeth", G("liner", 60.0, 0.2), slope=5e-4),
        Joint("lamination", "teeth", "yoke", G("lamination", 320.0, 0.1), slope=STEEL),
        Joint("fit", "yoke", "housing", G("fit", 160.0, 0.25), slope=1e-3),
        Joint("glue", "magnets", "rotor", G("glue", 45.0, 0.2)),
        *side,
        Joint("mount", "shield.de", "bench", G("mount", 3.0, 0.25), (0.1, 0.0)),
        Joint("bed", "bench", "bench.deep", 8.0, (1.0, 0.0)),
    ]


def surfaces(s: Skeleton, d: Draw) -> list[Film]:
    """Room on housing and shields, water on the jacket, both end spaces, the gap."""
    still, emissivity = 0.9 * d.factor("still", 0.15), 0.7
    wall = 0.075 * d.factor("jacket", 0.15)
    weight = np.linspace(1.0 + d.times.get("patchy", 0.0), 1.0 - d.times.get("patchy", 0.0), 8)

    def drum(T: Array, Ta: Array, u: Inputs) -> Array:
        clean = 1.0 - u.get("fade.housing", 0.0)
        return clean * (still * films.cylinder_still(T, Ta, 0.25) + films.radiation(T, Ta, emissivity))

    shield = films.free_film(films.plate_still, 0.24, still, emissivity)

    def wet(T: Array, Tf: Array, u: Inputs) -> Array:
        return weight * films.channel(0.5 * (T + Tf), u["flow_l_min"], 1.2e-4, 0.010)

    housing = s.cells("housing")[[0, 2, 3, 5, 6, 7, 9, 10]]
    out = [
        Film("drum", s.cells("housing"), "T_ambient", np.full(11, 0.32 / 11), drum),
        Film("jacket", housing, s.cells("water"), np.full(8, wall / 8), wet),
    ]
    ring = 0.06 * np.arange(6, 0, -1) / 21.0 * d.factor("face", 0.1)
    out += [Film(f"shield.{end}", s.cells(f"shield.{end}"), "T_ambient", ring, shield) for end, _ in ENDS]
    return [*out, *inside(s, d)]


def inside(s: Skeleton, d: Draw) -> list[Film]:
    out = []
    for end, x in ENDS:
        k1, k2 = 15.0 * d.factor(f"endspace.{end}", 0.2), d.between(f"stir.{end}", 0.2, 0.4)
        h = films.stirred(0.07, k1, k2)
        walls = (
            (s.cells(f"winding.{end}"), 0.02),
            (s.cells(f"shield.{end}")[2:], 0.04),
            (np.array([s.cell("rotor", x)]), 0.025),
        )
        air = s.cells(f"air.{end}")
        out += [Film(f"end.{end}.{k}", w, air, np.full(w.size, A / w.size), h) for k, (w, A) in enumerate(walls)]
    g = 0.8e-3 / d.factor("gap", 0.15)

    return [*out, films.across_gap(s, "magnets", "teeth", 0.09, 0.075, g)]


def losses(s: Skeleton, d: Draw) -> list[Loss]:
    R = 8e-3 * d.factor("copper", 0.04)
    iron = films.steel(d, RATED, 160.0, 190.0, 50.0)
    eddy = films.magnet_eddy(40.0 * d.factor("magnet", 0.2), RATED)
    out = [
        Loss("slot", s.cells("slot"), np.full(11, 0.5 / 11), films.joule(R)),
        Loss("teeth", s.cells("teeth"), np.full(11, 0.6 / 11), iron),
        Loss("yoke", s.cells("yoke"), np.full(11, 0.4 / 11), iron),
        Loss("eddy", s.cells("magnets"), np.full(11, 1 / 11), eddy),
    ]
    for end, _ in ENDS:
        P = 22.0 * d.factor(f"bearing.{end}", 0.25)
        out.append(Loss(f"end.{end}", s.cells(f"winding.{end}"), np.full(5, 0.25 / 5), films.joule(R)))
        out.append(Loss(f"grease.{end}", s.cells(f"bearing.{end}"), np.full(2, 0.5), films.bearing(P, RATED, 0.004)))
    return out


def streams(s: Skeleton, d: Draw) -> list[Stream]:
    share = d.factor("flow", 0.03)  # of the recorded litres per minute
    return [Stream(s.cells("water"), "T_coolant", lambda T, u: share * u["flow_l_min"] / 60000.0 * 1055.0 * 3380.0)]


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


NODES = ("winding.slot", "winding.de", "winding.nde", "stator", "magnets", "rotor", "housing")
NODES += ("shield.de", "shield.nde")
PARTS = {n: {"winding.slot": "slot", "stator": "yoke"}.get(n, n) for n in NODES}

JACKET = Archetype(
    name="jacket",
    bodies=bodies,
    joints=joints,
    terms=(surfaces, streams, losses),
    plans=(
        Plan("standstill", "calibrate", 75.0, direct),
        Plan("load", "calibrate", 75.0, load),
        Plan("speeds", "calibrate", 75.0, speeds),
        Plan("road", "validate", 75.0, road),
        Plan("road-2", "hold-out", 75.0, road),
    ),
    thermometers={n: Spot(PARTS[n], 0.5) for n in NODES if n not in ("winding.nde", "rotor")},
    baths={"bench": Spot("bench", 0.1)},
    missing=(
        Hidden("convection@shield.de", lambda a: airflow("shield.de", a), 30.0),
        Hidden("convection@housing", lambda a: airflow("housing", a), 80.0),
        Hidden("convection.constant@shield.nde", lambda a: draught("shield.nde", a), 20.0),
        Hidden("windage@rotor", lambda a: heating("rotor", a, (3.0, 2.8)), 10.0),  # 240 degC in the magnets
        Hidden("loss.rotor@magnets", lambda a: heating("magnets", a, (2.0, 1.8), fade=0.001), 60.0),
        Hidden("loss.rotor.load@magnets", lambda a: heating("magnets", a, (2.0, 1.8), (2.0, 2.0)), 60.0),
        Hidden("copper.ac@winding.slot", lambda a: heating("slot", a, (2.0, 1.8), (2.0, 2.0), fade=0.002), 60.0),
        Hidden("gap.convection@magnets|stator", lambda a: stirred_gap(a, "magnets", "teeth"), 30.0),
        Hidden("loss.constant@shield.nde", lambda a: heating("shield.nde", a), 200.0),
    ),
    faults={
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
    },
    foreign={
        "cable at winding.nde": lambda seed: foreign.cable("winding.nde", 8.0, 4000.0),
        "demagnetisation at magnets": lambda seed: foreign.runaway("magnets", 60.0, 50.0),
        "splash at shield.de": lambda seed: foreign.gusts("shield.de", 300.0, seed),
        "rub at shield.nde": lambda seed: foreign.rub("bearing.nde", "rotor", "housing", 30.0),
    },
    absorbed={
        "link.fit": lambda seed: Change({"fit": 0.2}),
        "link.liner": lambda seed: Change({"liner": 0.25}),
        "link.jacket": lambda seed: Change({"jacket": 0.3}),
        "loss.iron": lambda seed: Change({"iron": 2.2, "eddy": 2.2}),
    },
    tense=("fit", "liner", "jacket", "iron", "glue", "mount", "spigot-de", "potting-de", "gap", "magnet"),
    parts=PARTS,
    passing=(
        Hidden("convection.constant@housing", lambda a: draught("housing", a), 60.0),
        Hidden("convection.constant@shield.nde", lambda a: draught("shield.nde", a), 20.0),
        Hidden("loss.constant@shield.nde", lambda a: heating("shield.nde", a), 200.0),
        Hidden("pump@coolant", lambda a: less("flow_l_min", a), 1.5),
        Hidden("cover@housing", lambda a: covered(("drum",), a), 0.9),
        Hidden("meter@current_A", lambda a: less("current_A", a), 0.5, least=METER),
    ),
    words={"pump@coolant": ("flow@stream.coolant", "input.factor@flow_l_min")},
)
