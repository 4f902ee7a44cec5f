"""The true fan-cooled induction motor, 7.5 kW, 132 frame: 103 cells. Position 0 is the drive end, 1 the fan's."""

import numpy as np

from hidden.truth import faults, films, foreign
from hidden.truth.archetype import Archetype, Hidden, Plan, Spot
from hidden.truth.body import Body, Joint, Skeleton
from hidden.truth.change import Change
from hidden.truth.draw import Draw
from hidden.truth.effects import METER, airflow, bridge, covered, draught, fading, heating, less, spinning, stirred_gap
from hidden.truth.machine import Array, Film, Loss
from hidden.truth.profile import Rng, levels, steady, until

RATED = 1500.0
COPPER, STEEL, ALUMINIUM = -2e-4, -8e-4, -1e-4
ENDS = (("de", 0.0), ("nde", 1.0))


def bodies(d: Draw) -> list[Body]:
    C = d.capacity
    side = [
        b
        for end, _ in ENDS
        for b in (
            Body(f"winding.{end}", C(f"winding.{end}", 850.0), 5, 0.12, COPPER),
            Body(f"stub.{end}", 300.0, 4, 1.6, STEEL),
            Body(f"flange.{end}", C(f"flange.{end}", 1500.0), 6, 0.1, ALUMINIUM),
            Body(f"bearing.{end}", 220.0, 2, 0.2),
            Body(f"air.{end}", 20.0),
        )
    ]
    return [
        Body("slot", C("winding.slot", 1700.0), 11, 0.18, COPPER),
        Body("teeth", C("core", 4100.0), 11, 9.0, STEEL),
        Body("yoke", C("core", 5500.0), 11, 6.0, STEEL),
        Body("rotor", C("rotor", 9000.0), 11, 0.35, ALUMINIUM),
        Body("housing", C("housing", 6000.0), 11, 0.35, ALUMINIUM),
        *side,
        Body("bench", 6400.0, 6, 0.25),
        Body("bench.deep", 41600.0, 6, 1.6),
    ]


def joints(d: Draw) -> list[Joint]:
    G = d.conductance
    side = [
        j
        for end, x in ENDS
        for j in (
            Joint(f"slot-{end}", "slot", f"winding.{end}", G(f"slot-{end}", 30.0, 0.1), (x, 0.0)),
            Joint(f"rotor-{end}", "rotor", f"stub.{end}", 20.0, (x, 0.0)),
            Joint(f"shaft-{end}", f"stub.{end}", f"bearing.{end}", G(f"shaft-{end}", 9.0, 0.2), (1.0, 1.0)),
            Joint(f"seat-{end}", f"bearing.{end}", f"flange.{end}", G(f"seat-{end}", 12.0, 0.25), (0.0, 1.0)),
            Joint(f"spigot-{end}", f"flange.{end}", "housing", G(f"spigot-{end}", 14.0, 0.25), (0.0, x)),
        )
    ]
    return [
        Joint("liner", "slot", "teeth", G("liner", 45.0, 0.2), slope=5e-4),
        Joint("lamination", "teeth", "yoke", G("lamination", 260.0, 0.1), slope=STEEL),
        Joint("fit", "yoke", "housing", G("fit", 70.0, 0.25), slope=1e-3),
        *side,
        Joint("feet", "housing", "bench", G("feet", 1.6, 0.25), (0.5, 0.0)),
        Joint("bed", "bench", "bench.deep", 6.0, (1.0, 0.0)),
    ]


def outside(s: Skeleton, d: Draw) -> list[Film]:
    """Fan air decays along the fins towards the drive end; still air and radiation beside it."""
    fan, power = 26.0 * d.factor("fan", 0.15), d.between("fan.power", 0.68, 0.82)
    still, emissivity = 0.8 * d.factor("still", 0.15), min(0.8 * d.factor("paint", 0.05), 0.95)
    x = (np.arange(11) + 0.5) / 11
    decay = np.exp(-0.5 * (1.0 - x))
    decay = decay / decay.mean()

    def fins(T: Array, Ta: Array, u) -> Array:
        blown = fan * decay * (u["speed_rpm"] / RATED) ** power
        clean = 1.0 - u.get("fade.housing", 0.0)
        return clean * (
            films.mixed(blown, still * films.cylinder_still(T, Ta, 0.26)) + 0.8 * films.radiation(T, Ta, emissivity)
        )

    shield = films.free_film(films.plate_still, 0.25, still, emissivity)
    cowl = 35.0 * d.factor("cowl", 0.2)

    def hooded(T: Array, Ta: Array, u) -> Array:
        return films.mixed(cowl * (u["speed_rpm"] / RATED) ** power, 0.6 * films.plate_still(T, Ta, 0.25))

    ring = 0.06 * np.arange(6, 0, -1) / 21.0 * d.factor("face", 0.1)
    return [
        Film("fins", s.cells("housing"), "T_ambient", np.full(11, 0.05), fins),
        Film("shield", s.cells("flange.de"), "T_ambient", ring, shield),
        Film("hood", s.cells("flange.nde"), "T_ambient", ring, hooded),
        Film("bed.air", s.cells("bench"), "T_ambient", np.full(6, 0.01), lambda T, Ta, u: 8.0),
    ]


def inside(s: Skeleton, d: Draw) -> list[Film]:
    """Both end spaces, each with its air, and the gap."""
    out = []
    for end, x in ENDS:
        k2 = d.between(f"stir.{end}", 0.2, 0.4)
        k1 = 15.0 * d.factor(f"endspace.{end}", 0.2)
        h = films.stirred(0.06, k1, k2)
        air = s.cells(f"air.{end}")
        walls = (
            (s.cells(f"winding.{end}"), 0.08),
            (s.cells(f"flange.{end}")[2:], 0.05),
            (np.array([s.cell("rotor", x)]), 0.03),
            (np.array([s.cell("housing", x)]), 0.03),
        )
        out += [Film(f"end.{end}.{k}", w, air, np.full(w.size, A / w.size), h) for k, (w, A) in enumerate(walls)]
    g = 0.5e-3 / d.factor("gap", 0.15)

    return [*out, films.across_gap(s, "rotor", "teeth", 0.068, 0.06, g)]


def losses(s: Skeleton, d: Draw) -> list[Loss]:
    R1, R2 = 0.5 * d.factor("copper", 0.04), 0.3 * d.factor("cage", 0.12)
    iron = films.steel(d, RATED, 80.0, 50.0, 20.0)
    out = [
        Loss("slot", s.cells("slot"), np.full(11, 0.45 / 11), films.joule(R1)),
        Loss("teeth", s.cells("teeth"), np.full(11, 0.55 / 11), iron),
        Loss("yoke", s.cells("yoke"), np.full(11, 0.45 / 11), iron),
        Loss("cage", s.cells("rotor"), np.full(11, 1 / 11), films.joule(R2, "rotor_A")),
    ]
    for end, _ in ENDS:
        P = 14.0 * d.factor(f"bearing.{end}", 0.25)
        out.append(Loss(f"end.{end}", s.cells(f"winding.{end}"), np.full(5, 0.275 / 5), films.joule(R1)))
        out.append(Loss(f"grease.{end}", s.cells(f"bearing.{end}"), np.full(2, 0.5), films.bearing(P, RATED)))
    return out


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


NODES = ("winding.slot", "winding.de", "winding.nde", "core", "rotor", "housing")
NODES += ("flange.de", "flange.nde", "bearing.de", "bearing.nde")
PARTS = {n: {"winding.slot": "slot", "core": "yoke"}.get(n, n) for n in NODES}

TEFC = Archetype(
    name="tefc",
    bodies=bodies,
    joints=joints,
    terms=(outside, inside, losses),
    plans=(
        Plan("standstill", "calibrate", 75.0, direct),
        Plan("load", "calibrate", 75.0, load),
        Plan("speeds", "calibrate", 75.0, speeds),
        Plan("road", "validate", 75.0, road),
        Plan("road-2", "hold-out", 75.0, road),
    ),
    thermometers={
        **{
            n: Spot(PARTS[n], 0.5) for n in ("winding.slot", "winding.de", "core", "housing", "flange.de", "flange.nde")
        },
        "bearing.de": Spot("bearing.de", 0.3),
    },
    baths={"bench": Spot("bench", 0.1)},
    missing=(
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
    ),
    faults={
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
    },
    foreign={
        "cable at winding.nde": lambda seed: foreign.cable("winding.nde", 6.0, 4000.0),
        "splash at housing": lambda seed: foreign.gusts("housing", 300.0, seed),
        "rub at bearing.de": lambda seed: foreign.rub("bearing.de", "rotor", "housing", 40.0),
        "heater at flange.nde": lambda seed: foreign.hot_spell("flange.nde", 60.0),
    },
    absorbed={
        "link.fit": lambda seed: Change({"fit": 0.25}),
        "link.liner": lambda seed: Change({"liner": 0.25}),
        "loss.cage": lambda seed: Change({"cage": 2.0}),
        "link.fins-fan": lambda seed: Change({"fan": 0.45}),
    },
    tense=("fit", "liner", "fan", "iron", "seat-de", "feet", "capacity.housing", "cage", "spigot-de", "still"),
    doubted={"capacity.housing": 0.1},
    parts=PARTS,
    passing=(
        Hidden("convection.constant@housing", lambda a: draught("housing", a), 60.0),
        Hidden("convection.constant@flange.de", lambda a: draught("flange.de", a), 15.0),
        Hidden("loss.constant@flange.nde", lambda a: heating("flange.nde", a), 100.0),
        Hidden("cover@housing", lambda a: covered(("fins",), a), 0.9),
        Hidden("meter@current_A", lambda a: less("current_A", a), 0.5, least=METER),
    ),
)
