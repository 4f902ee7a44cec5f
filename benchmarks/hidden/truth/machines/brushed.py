"""The true series-wound brushed motor, 15 kW, 103 cells: air is blown from the commutator's end (1) to the other."""

import numpy as np

from hidden.truth import faults, foreign
from hidden.truth.archetype import Archetype, Hidden, Plan, Spot
from hidden.truth.body import Body, Joint, Skeleton
from hidden.truth.change import Change
from hidden.truth.draw import Draw
from hidden.truth.effects import METER, airflow, bridge, covered, draught, fading, heating, less, stirred_gap
from hidden.truth.films import ALPHA, across_gap, bearing, cylinder_still, free_film, plate_still, radiation, steel
from hidden.truth.machine import Array, Film, Inputs, Loss, Stream
from hidden.truth.profile import Rng, levels, steady, until

RATED, BLOWN = 1000.0, 400.0
COPPER, STEEL, IRON = -2e-4, -8e-4, -9e-4
ENDS = (("de", 0.0), ("nde", 1.0))


def bodies(d: Draw) -> list[Body]:
    C = d.capacity
    side = [
        b
        for end, _ in ENDS
        for b in (
            Body(f"stub.{end}", 500.0, 4, 1.0, STEEL),
            Body(f"bearing.{end}", 300.0, 2, 0.2),
            Body(f"flange.{end}", C(f"flange.{end}", 3000.0), 6, 0.2, IRON),
        )
    ]
    return [
        Body("armature", C("armature", 5000.0), 11, 0.08, COPPER),
        Body("core", C("rotor", 12000.0), 11, 2.0, STEEL),
        Body("commutator", C("commutator", 2500.0), 4, 0.06, COPPER),
        Body("poles", C("poles", 10000.0), 11, 3.0, STEEL),
        Body("field", C("field", 6000.0), 11, 0.4, COPPER),
        Body("yoke", C("yoke", 18000.0), 11, 0.5, STEEL),
        *side,
        Body("air", 60.0, 10, 1e4),
        Body("bench", 6400.0, 5, 0.25),
        Body("bench.deep", 41600.0, 5, 1.6),
    ]


def joints(d: Draw) -> list[Joint]:
    G = d.conductance
    side = [
        j
        for end, x in ENDS
        for j in (
            Joint(f"rotor-{end}", "core", f"stub.{end}", 15.0, (x, 0.0)),
            Joint(f"shaft-{end}", f"stub.{end}", f"bearing.{end}", G(f"shaft-{end}", 8.0, 0.2), (1.0, 1.0)),
            Joint(f"seat-{end}", f"bearing.{end}", f"flange.{end}", G(f"seat-{end}", 10.0, 0.2), (0.0, 1.0)),
            Joint(f"spigot-{end}", f"flange.{end}", "yoke", G(f"spigot-{end}", 15.0, 0.25), (0.0, x)),
        )
    ]
    return [
        Joint("liner", "armature", "core", G("liner", 90.0, 0.2), slope=5e-4),
        Joint("risers", "armature", "commutator", G("risers", 20.0, 0.15), (1.0, 0.0)),
        Joint("hub", "commutator", "core", G("hub", 6.0, 0.25), (0.5, 1.0)),
        Joint("coil", "field", "poles", G("coil", 30.0, 0.25)),
        Joint("bolts", "poles", "yoke", G("bolts", 120.0, 0.25), slope=1e-3),
        *side,
        Joint("feet", "yoke", "bench", G("feet", 2.0, 0.25), (0.5, 0.0)),
        Joint("bed", "bench", "bench.deep", 6.0, (1.0, 0.0)),
    ]


def films(s: Skeleton, d: Draw) -> list[Film]:
    """What the blown air washes, what the room cools, and the gap."""
    power, level = d.between("fan.power", 0.68, 0.82), d.factor("fan", 0.12)
    air = s.cells("air")

    def blown(h0: float):
        def h(T: Array, Ta: Array, u: Inputs) -> Array:
            return h0 * level * (u["fan_flow_m3h"] / BLOWN) ** power * (1.0 + 5e-4 * (0.5 * (T + Ta) - 40.0))

        return h

    long = np.array([9, 8, 7, 6, 5, 5, 4, 3, 2, 1, 0])  # air enters at position 1
    walls = (("armature", 0.2, 80.0), ("field", 0.15, 60.0), ("poles", 0.1, 60.0), ("yoke", 0.12, 30.0))
    # Eleven cells on ten of air: the middle two share one.
    out = [Film(name, s.cells(name), air[long], np.full(11, A / 11), blown(h0)) for name, A, h0 in walls]
    out += [Film("commutator", s.cells("commutator"), air[[2, 1, 1, 0]], np.full(4, 0.05 / 4), blown(90.0))]
    for end, cell in (("de", 9), ("nde", 0)):
        inner = s.cells(f"flange.{end}")[2:]
        out.append(Film(f"inner.{end}", inner, air[[cell]], np.full(inner.size, 0.07 / inner.size), blown(40.0)))
    g = 2e-3 / d.factor("gap", 0.15)

    return [*out, *outside(s, d), across_gap(s, "core", "poles", 0.1, 0.1, g)]


def outside(s: Skeleton, d: Draw) -> list[Film]:
    still, emissivity = 0.9 * d.factor("still", 0.15), 0.85

    def frame(T: Array, Ta: Array, u: Inputs) -> Array:
        clean = 1.0 - u.get("fade.yoke", 0.0)
        return clean * (still * cylinder_still(T, Ta, 0.32) + radiation(T, Ta, emissivity))

    shield = free_film(plate_still, 0.3, still, emissivity)
    ring = 0.07 * np.arange(6, 0, -1) / 21.0 * d.factor("face", 0.1)
    ends = [Film(f"shield.{end}", s.cells(f"flange.{end}"), "T_ambient", ring, shield) for end, _ in ENDS]
    return [Film("frame", s.cells("yoke"), "T_ambient", np.full(11, 0.45 / 11), frame), *ends]


def losses(s: Skeleton, d: Draw) -> list[Loss]:
    Ra, Rf = 0.03 * d.factor("copper.armature", 0.04), 0.02 * d.factor("copper.field", 0.04)
    core = steel(d, RATED, 70.0, 40.0, 15.0)
    drop, rub = 2.0 * d.factor("drop", 0.1), 60.0 * d.factor("rub", 0.2)

    def brushes(T: Array, u: Inputs) -> Array:
        """The drop falls a little as the film on the copper warms; friction with speed."""
        contact = drop * abs(u["current_A"]) * (1.0 - 0.001 * (T - 60.0))
        return contact + rub * (u["speed_rpm"] / RATED) * (1.0 - 0.001 * (T - 60.0))

    def direct(R: float):
        return lambda T, u: R * u["current_A"] ** 2 * (1.0 + ALPHA * (T - 20.0))

    def iron(share: float):
        return lambda T, u: share * core(T, u)

    even = np.full(11, 1 / 11)
    out = [
        Loss("armature", s.cells("armature"), even, direct(Ra)),
        Loss("field", s.cells("field"), even, direct(Rf)),
        Loss("core", s.cells("core"), even, iron(0.8)),
        Loss("faces", s.cells("poles"), even, iron(0.2)),
        Loss("brushes", s.cells("commutator"), np.full(4, 0.25), brushes),
    ]
    for end, _ in ENDS:
        P = 15.0 * d.factor(f"bearing.{end}", 0.25)
        out.append(Loss(f"grease.{end}", s.cells(f"bearing.{end}"), np.full(2, 0.5), bearing(P, RATED)))
    return out


def streams(s: Skeleton, d: Draw) -> list[Stream]:
    share = d.factor("flow", 0.03)  # of the recorded m3/h

    def mcp(T: Array, u: Inputs) -> float:
        return share * u["fan_flow_m3h"] / 3600.0 * 352.98 / (u["T_ambient"] + 273.15) * 1006.0

    return [Stream(s.cells("air"), "T_ambient", mcp)]


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


NODES = ("winding.armature", "rotor", "commutator", "poles", "winding.field", "yoke", "flange.de", "flange.nde")
PARTS = {n: {"winding.armature": "armature", "rotor": "core", "winding.field": "field"}.get(n, n) for n in NODES}

BRUSHED = Archetype(
    name="brushed",
    bodies=bodies,
    joints=joints,
    terms=(films, streams, losses),
    plans=(
        Plan("locked", "calibrate", 75.0, direct),
        Plan("load", "calibrate", 75.0, load),
        Plan("speeds", "calibrate", 75.0, speeds),
        Plan("road", "validate", 75.0, road),
        Plan("road-2", "hold-out", 75.0, road),
    ),
    thermometers={
        **{n: Spot(PARTS[n], 0.5) for n in NODES if n not in ("winding.armature", "rotor")},
        "air.de": Spot("air", 0.8),
    },
    baths={"bench": Spot("bench", 0.1)},
    missing=(
        Hidden("convection@flange.de", lambda a: airflow("flange.de", a), 20.0),
        Hidden("convection@yoke", lambda a: airflow("yoke", a), 60.0),
        Hidden("conduction.bench@flange.de", lambda a: bridge("foot", a, "flange.de", "bench", (0.5, 0.1)), 15.0),
        Hidden("convection.constant@flange.nde", lambda a: draught("flange.nde", a), 15.0),
        Hidden("brush.drop@commutator", lambda a: heating("commutator", a, (0, 0), (1.0, 0.9), fade=0.001), 400.0),
        Hidden("brush.friction@commutator", lambda a: heating("commutator", a, (1.0, 0.9), fade=0.001), 300.0),
        Hidden("windage@rotor", lambda a: heating("core", a, (3.0, 2.8)), 200.0),
        Hidden(
            "copper.ac@winding.armature", lambda a: heating("armature", a, (2.0, 1.8), (2.0, 2.0), fade=0.002), 600.0
        ),
        Hidden("gap.convection@poles|rotor", lambda a: stirred_gap(a, "core", "poles"), 40.0),
        Hidden("loss.constant@flange.de", lambda a: heating("flange.de", a), 200.0),
        Hidden("fouling@yoke", lambda a: fading("yoke", a), 0.8),
    ),
    faults={
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
    },
    foreign={
        "cable at winding.field": lambda seed: foreign.cable("field", 10.0, 6000.0),
        "splash at yoke": lambda seed: foreign.gusts("yoke", 500.0, seed),
        "rub at flange.de": lambda seed: foreign.rub("bearing.de", "core", "yoke", 60.0),
        "heater at flange.nde": lambda seed: foreign.hot_spell("flange.nde", 120.0),
    },
    absorbed={
        "link.bolts": lambda seed: Change({"bolts": 0.2}),
        "link.coil": lambda seed: Change({"coil": 0.3}),
        "fan.flow": lambda seed: Change({"fan": 0.5}),
        "loss.brushes": lambda seed: Change({"drop": 2.0, "rub": 2.0}),
    },
    tense=("bolts", "coil", "fan", "iron", "hub", "feet", "spigot-de", "rub", "still", "capacity.yoke"),
    doubted={"capacity.yoke": 0.08},
    parts=PARTS,
    passing=(
        Hidden("convection.constant@yoke", lambda a: draught("yoke", a), 60.0),
        Hidden("convection.constant@flange.nde", lambda a: draught("flange.nde", a), 15.0),
        Hidden("loss.constant@flange.de", lambda a: heating("flange.de", a), 200.0),
        Hidden("fan slower@air", lambda a: less("fan_flow_m3h", a), 1.5),
        Hidden("cover@yoke", lambda a: covered(("frame",), a), 0.9),
        Hidden("meter@current_A", lambda a: less("current_A", a), 0.5, least=METER),
    ),
    words={"fan slower@air": ("flow@stream.fan", "flow@fan.flow", "input.factor@fan_flow_m3h")},
)
