"""The true axial-flux motor, 12 kW: a stator disc between two rotor discs, an external blower with a switch. 57 cells.

Bodies run from the hub (0) to the rim (1). Air enters at the hub and is thrown out between the discs.
"""

import numpy as np

from hidden.truth import faults, foreign
from hidden.truth.archetype import Archetype, Hidden, Plan, Spot, no_tempco
from hidden.truth.body import Body, Joint, Skeleton
from hidden.truth.change import Change
from hidden.truth.draw import Draw
from hidden.truth.effects import METER, airflow, blown, bridge, covered, draught, heating, less, spinning, warming
from hidden.truth.films import ALPHA, air, bearing, free_film, joule, plate_still
from hidden.truth.machine import Array, Film, Inputs, Loss, Stream
from hidden.truth.profile import Rng, levels, steady, until
from hidden.truth.readings import Logger

R20, RIM, SIDES = 0.028, 0.14, ("left", "right")


def bodies(d: Draw) -> list[Body]:
    def C(key: str, value: float) -> float:
        return d.capacity(key, value, 0.06)

    side = [
        b
        for s in SIDES
        for b in (
            Body(f"rotor.{s}", C("rotor", 1900.0), 5, 0.35, -8e-4),
            Body(f"magnets.{s}", C("magnets", 520.0), 5, 4.0),
            Body(f"cover.{s}", C("cover", 2100.0), 5, 0.12, -1e-4),
            Body(f"air.{s}", 12.0, 3, 1e4),
        )
    ]
    return [
        Body("coils", C("coils", 1500.0), 6, 0.15, -2e-4),
        Body("teeth", C("teeth", 1700.0), 6, 0.5),
        Body("ring", C("ring", 2600.0), 4, 0.06, -1e-4),
        Body("shaft", C("shaft", 900.0), 5, 1.5, -8e-4),
        *side,
    ]


def joints(d: Draw) -> list[Joint]:
    G = d.conductance
    side = [
        j
        for k, s in enumerate(SIDES)
        for j in (
            Joint(f"glue-{s}", f"magnets.{s}", f"rotor.{s}", G(f"glue-{s}", 30.0, 0.2)),
            Joint(f"hub-{s}", f"rotor.{s}", "shaft", G(f"hub-{s}", 6.0), (0.0, float(k))),
            Joint(f"bearing-{s}", "shaft", f"cover.{s}", G(f"bearing-{s}", 1.6), (float(k), 0.0)),
            Joint(f"rim-{s}", f"cover.{s}", "ring", G(f"rim-{s}", 14.0), (1.0, 0.5)),
        )
    ]
    return [
        Joint("resin", "coils", "teeth", G("resin", 55.0, 0.2), slope=5e-4),
        Joint("clamp", "teeth", "ring", G("clamp", 22.0), (1.0, 0.5)),
        *side,
    ]


def films(s: Skeleton, d: Draw) -> list[Film]:
    """Free discs (von Karman: Nu = 0.36 Re^0.5, 0.0151 Re^0.8 when turbulent) and walls washed by what they throw."""
    out, still = [], d.factor("still", 0.15)
    level = d.factor("discs", 0.15)

    def disc(T: Array, Ta: Array, u: Inputs) -> Array:
        k, nu, _, _ = air(0.5 * (T + Ta))
        Re = (abs(u["speed_rpm"]) * np.pi / 30.0 + 1.0) * RIM**2 / nu
        return level * k / RIM * ((0.36 * Re**0.5) ** 4 + (0.0151 * Re**0.8) ** 4) ** 0.25

    def washed(T: Array, Ta: Array, u: Inputs) -> Array:
        return 6.0 + 26.0 * level * u["blower_on"] + 0.4 * disc(T, Ta, u)

    outer = free_film(plate_still, 0.3, still, 0.8)
    for side in SIDES:
        air_cells = s.cells(f"air.{side}")
        for body, A, h in (
            ("coils", 0.018, washed),
            ("teeth", 0.026, washed),
            (f"magnets.{side}", 0.04, disc),
            (f"rotor.{side}", 0.03, disc),
            (f"cover.{side}", 0.05, washed),
        ):
            cells = s.cells(body)
            near = air_cells[np.arange(cells.size) * 3 // cells.size]
            out.append(Film(f"{body} in {side}", cells, near, np.full(cells.size, A / cells.size), h))
        out.append(Film(f"outer {side}", s.cells(f"cover.{side}"), "T_ambient", np.full(5, 0.06 / 5), outer))
    return [*out, Film("rim", s.cells("ring"), "T_ambient", np.full(4, 0.09 / 4), outer)]


def losses(s: Skeleton, d: Draw) -> list[Loss]:
    R, iron, eddy = R20 * d.factor("copper", 0.04), 130.0 * d.factor("iron", 0.15), 28.0 * d.factor("eddy", 0.2)

    def core(T: Array, u: Inputs) -> float:
        f = abs(u["speed_rpm"]) / 3000.0
        return iron * (0.4 * f**1.05 + 0.6 * f**1.8)

    def magnets(T: Array, u: Inputs) -> float:
        return eddy * (abs(u["speed_rpm"]) / 3000.0) ** 1.8

    out = [
        Loss("coils", s.cells("coils"), np.full(6, 1 / 6), joule(R)),
        Loss("core", s.cells("teeth"), np.full(6, 1 / 6), core),
    ]
    for side in SIDES:
        P = 14.0 * d.factor(f"grease-{side}", 0.25)
        end = s.cells("shaft")[[0]] if side == "left" else s.cells("shaft")[[-1]]
        out.append(Loss(f"grease {side}", end, np.ones(1), bearing(P, 3000.0)))
        out.append(Loss(f"eddy {side}", s.cells(f"magnets.{side}"), np.full(5, 0.2), magnets))
    return out


def streams(s: Skeleton, d: Draw) -> list[Stream]:
    blower, pumping = 0.016 * d.factor("blower", 0.1), 0.006 * d.factor("pumping", 0.2)

    def mcp(T: Array, u: Inputs) -> float:
        """Of what the blower and the discs' own pumping move."""
        flow = 2e-3 + blower * u["blower_on"] + pumping * abs(u["speed_rpm"]) / 3000.0
        return flow * 352.98 / (u["T_ambient"] + 273.15) * 1006.0

    return [Stream(s.cells(f"air.{side}"), "T_ambient", mcp) for side in SIDES]


def drive(current: Array, speed: Array, blower: Array, wind: Array) -> dict[str, Array]:
    return {"current_A": current, "speed_rpm": speed, "blower_on": blower, "vehicle_speed_mps": wind}


def turns(at: Array, rng: Rng, minutes: float) -> Array:
    """A blower switched on and off about every so many minutes."""
    return (levels(at, rng, 0.0, 1.0, minutes) > 0.5).astype(float)


def locked(rng: Rng, at: Array) -> dict[str, Array]:
    on = (at > 1500.0).astype(float)
    return drive(levels(at, rng, 40.0, 62.0, 15.0) * until(at, 45.0, 1.0), steady(at, 0.0), on, steady(at, 0.0))


def bench(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(
        levels(at, rng, 30.0, 80.0, 8.0), levels(at, rng, 600.0, 3600.0, 10.0), turns(at, rng, 12.0), steady(at, 0.0)
    )


def coast(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(steady(at, 1.0), levels(at, rng, 500.0, 4000.0, 12.0), turns(at, rng, 15.0), steady(at, 0.0))


def road(rng: Rng, at: Array) -> dict[str, Array]:
    wind = levels(at, rng, 0.0, 22.0, 4.0)
    return drive(levels(at, rng, 10.0, 95.0, 3.0), levels(at, rng, 300.0, 4000.0, 5.0), turns(at, rng, 10.0), wind)


DISC = Archetype(
    name="disc",
    bodies=bodies,
    joints=joints,
    terms=(films, streams, losses),
    plans=(
        Plan("locked rotor", "calibrate", 80.0, locked),
        Plan("bench", "calibrate", 80.0, bench),
        Plan("coast", "calibrate", 60.0, coast),
        Plan("road", "validate", 80.0, road),
        Plan("road back", "hold-out", 80.0, road),
    ),
    thermometers={n: Spot(n, 0.5) for n in ("coils", "teeth", "ring", "cover.left", "cover.right")},
    missing=(
        Hidden("road wind@ring", lambda a: airflow("ring", a), 20.0),
        Hidden("shaft fan@cover.right", lambda a: spinning("cover.right", a), 10.0),
        Hidden("draught@cover.left", lambda a: draught("cover.left", a), 10.0),
        Hidden("windage@rotor.left", lambda a: heating("rotor.left", a, (3.0, 2.8)), 30.0),
        Hidden("ac copper@coils", lambda a: heating("coils", a, (2.0, 1.85), (2.0, 2.0), fade=0.002), 300.0),
        Hidden("load loss@magnets.left", lambda a: heating("magnets.left", a, (2.0, 1.8), (2.0, 2.0)), 60.0),
        Hidden("bridge@coils-ring", lambda a: bridge("leads", a, "coils", "ring", (0.9, 0.5)), 12.0),
        Hidden("no tempco@coils", lambda a: warming("coils", 3.0 * R20, a), ALPHA, no_tempco("joule")),
    ),
    faults={
        "sensor.gain@coils": lambda seed: faults.gain("coils", -0.08),
        "sensor.lag@coils": lambda seed: faults.slow("coils", 100.0),
        "sensor.swap@cover_L|cover_R": lambda seed: faults.swapped("cover.left", "cover.right"),
        "sensor.drift@stator_ring": lambda seed: faults.drift("ring", 5.0),
        "sensor.stem@teeth": lambda seed: faults.stem("teeth", 0.2),
        "time.offset@bench": lambda seed: Change(
            in_test={"bench": faults.clock(("coils", "teeth", "ring", "cover.left", "cover.right"), -180.0)}
        ),
        "input.factor@current_A": lambda seed: faults.factor("current_A", 0.88),
        "ambient.offset@ambient": lambda seed: faults.offset("T_ambient", -4.0),
        "clipped@coils": lambda seed: faults.clipped("coils", 0.6),
    },
    foreign={
        "cable at coils": lambda seed: foreign.cable("coils", 3.0, 1500.0),
        "splash at stator_ring": lambda seed: foreign.gusts("ring", 150.0, seed),
        "demagnetisation at pm_R": lambda seed: foreign.runaway("magnets.right", 60.0, 45.0),
    },
    absorbed={
        "coil joint": lambda seed: Change({"resin": 0.3}),
        "loss.iron": lambda seed: Change({"iron": 2.2}),
        "discs": lambda seed: Change({"discs": 0.45}),
    },
    tense=("resin", "clamp", "discs", "iron", "blower", "still", "rim-left", "hub-right"),
    parts={
        "coils": "coils",
        "teeth": "teeth",
        "stator_ring": "ring",
        "shaft": "shaft",
        "disc_L": "rotor.left",
        "disc_R": "rotor.right",
        "pm_L": "magnets.left",
        "pm_R": "magnets.right",
        "cover_L": "cover.left",
        "cover_R": "cover.right",
    },
    passing=(
        Hidden("draught@ring", lambda a: draught("ring", a), 30.0),
        Hidden("side blower@cover.right", lambda a: blown("cover.right", a, "blower_on"), 20.0),
        Hidden("heat@cover.left", lambda a: heating("cover.left", a), 150.0),
        Hidden("blower slower@air", lambda a: less("blower_on", a), 1.5),
        Hidden("cover@ring", lambda a: covered(("rim",), a), 0.9),
        Hidden("meter@current_A", lambda a: less("current_A", a), 0.5, least=METER),
    ),
    logger=Logger(20.0, 5.0, 0.1, (3.0, 12.0), 0.08),
    called={"ring": "stator_ring", "cover.left": "cover_L", "cover.right": "cover_R"},
    words={
        "windage@rotor.left": ("windage@disc_L", "windage@pm_L"),
        "load loss@magnets.left": ("loss.rotor.load@pm_L",),
        "bridge@coils-ring": ("coupling@coils|stator_ring",),
        "no tempco@coils": ("copper.feedback@joule",),
        "side blower@cover.right": ("convection.constant@cover_R",),
        "blower slower@air": ("input.factor@blower_on",),
    },
)
