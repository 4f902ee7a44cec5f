"""The true incubator, 0.1 kW: a heated plate and a rack in a stirred, insulated chamber; nothing turns. 30 cells."""

import numpy as np

from hidden.truth import faults, foreign
from hidden.truth.archetype import Archetype, Hidden, Plan, Spot
from hidden.truth.body import Body, Cells, Joint, Skeleton
from hidden.truth.change import Change
from hidden.truth.draw import Draw
from hidden.truth.effects import METER, bridge, covered, draught, heating, less, room_air, switched, to_room
from hidden.truth.films import free_film, plate_still
from hidden.truth.machine import Array, Film, Inputs, Loss
from hidden.truth.profile import Rng, steady
from hidden.truth.readings import Logger

WATTS, STIRRER = 90.0, 2.5


def bodies(d: Draw) -> list[Body]:
    def C(key: str, value: float) -> float:
        return d.capacity(key, value, 0.07)

    return [
        Body("plate", C("plate", 420.0), 4, 0.15),
        Body("air", 45.0, 3, 1e4),
        Body("inner", C("inner", 700.0), 5, 0.5),
        Body("foam", C("foam", 260.0), 5, 0.02),
        Body("outer", C("outer", 900.0), 5, 0.6),
        Body("rack", C("rack", 1500.0), 4, 0.6),
        Body("lid", C("lid", 450.0), 4, 1.5),
    ]


def joints(d: Draw) -> list[Joint]:
    foam = 2.2 * d.factor("foam", 0.15)
    return [
        Joint("foam.in", "inner", "foam", 2.0 * foam, slope=2e-3),
        Joint("foam.out", "foam", "outer", 2.0 * foam),
        Joint("hinge", "lid", "outer", 0.25 * d.factor("hinge", 0.3), (0.0, 0.2)),
        Joint("feet", "plate", "inner", 0.35 * d.factor("feet", 0.25), (0.0, 0.0)),
    ]


def films(s: Skeleton, d: Draw) -> list[Film]:
    """The stirrer trebles every film inside; outside the room's still air and radiation."""
    still, stir = d.factor("still", 0.12), 2.3 * d.factor("stirred", 0.15)

    def inside(h0: float):
        def h(T: Array, Ta: Array, u) -> Array:
            return h0 * (1.0 + stir * u["fan_on"]) * (1.0 + 0.03 * ((T - Ta) ** 2 + 4.0) ** 0.25)

        return h

    outside = free_film(plate_still, 0.35, still, 0.9)

    air, out = s.cells("air"), []
    for body, area, h0 in (("plate", 0.06, 9.0), ("inner", 0.5, 4.2), ("rack", 0.35, 5.4), ("lid", 0.1, 3.6)):
        for part, own in zip(np.array_split(s.cells(body), 3), air, strict=True):
            each = np.full(part.size, area * d.factor(f"inside.{body}", 0.12) / s.cells(body).size)
            out.append(Film(f"{body} inside", part, np.array([own]), each, inside(h0)))
    return [
        *out,
        Film("outside", s.cells("outer"), "T_ambient", np.full(5, 0.1), outside),
        Film("top", s.cells("lid"), "T_ambient", np.full(4, 0.03), outside),
        *_mixing(air),
    ]


def _mixing(air: Cells) -> list[Film]:
    """Layers of air change places, faster when stirred."""
    return [
        Film("mixing", air[[k]], air[[k + 1]], np.ones(1), lambda T, Ta, u: 3.0 + 25.0 * u["fan_on"]) for k in (0, 1)
    ]


def losses(s: Skeleton, d: Draw) -> list[Loss]:
    watts = WATTS * d.factor("heater", 0.05)

    def heater(T: Array, u: Inputs) -> Array:
        return watts * u["heater_on"] * (1.0 - 2e-4 * (T - 40.0))

    return [
        Loss("heater", s.cells("plate"), np.full(4, 0.25), heater),
        Loss("stirrer", s.cells("air"), np.full(3, 1 / 3), lambda T, u: STIRRER * u["fan_on"]),
    ]


def switching(at: Array, rng: Rng, on: tuple[float, float], off: tuple[float, float]) -> Array:
    """0 and 1, held for minutes drawn between these."""
    ends, state = [0.0], []
    while ends[-1] <= at[-1]:
        state.append(float(len(state) % 2 == 0))
        ends.append(ends[-1] + 60.0 * rng.uniform(*(on if state[-1] else off)))
    return np.array(state)[np.searchsorted(ends, at, side="right") - 1]


def drive(heater: Array, fan: Array) -> dict[str, Array]:
    return {"heater_on": heater, "fan_on": fan}


def still(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(np.where(at < 4200.0, 1.0, 0.0), steady(at, 0.0))


def stirred(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(switching(at, rng, (6.0, 15.0), (3.0, 8.0)), steady(at, 1.0))


def both(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(switching(at, rng, (4.0, 12.0), (2.0, 6.0)), switching(at, rng, (10.0, 20.0), (8.0, 15.0)))


INCUBATOR = Archetype(
    name="incubator",
    bodies=bodies,
    joints=joints,
    terms=(films, losses),
    plans=(
        Plan("heat up and cool", "calibrate", 120.0, still),
        Plan("stirred", "calibrate", 90.0, stirred),
        Plan("night", "calibrate", 120.0, both),
        Plan("day", "validate", 90.0, both),
        Plan("weekend", "hold-out", 120.0, both),
    ),
    thermometers={
        "plate": Spot("plate", 0.5),
        "air": Spot("air", 0.5),
        "rack": Spot("rack", 0.5),
        "outer": Spot("outer", 0.4),
    },
    missing=(
        Hidden("draught@outer", lambda a: draught("outer", a), 8.0),
        Hidden("leak@air", lambda a: room_air("air", a), 3.0),
        Hidden("bridge@plate-outer", lambda a: bridge("screws", a, "plate", "outer", (0.5, 0.5)), 3.0),
        Hidden("lamp@outer", lambda a: heating("outer", a), 60.0),
        Hidden(
            "sleeve@lid", lambda a: to_room("lid", lambda T, Ta, u: a * (((T - Ta) ** 2 + 4.0) / 1600.0) ** 0.17), 6.0
        ),
        Hidden("bridge@plate-rack", lambda a: bridge("shelf", a, "plate", "rack", (0.9, 0.1)), 4.0),
    ),
    faults={
        "sensor.gain@rack": lambda seed: faults.gain("rack", -0.12),
        "sensor.lag@chamber": lambda seed: faults.slow("air", 150.0),
        "sensor.stem@plate": lambda seed: faults.stem("plate", 0.2),
        "sensor.swap@chamber|rack": lambda seed: faults.swapped("air", "rack"),
        "sensor.drift@shell": lambda seed: faults.drift("outer", 3.0),
        "time.offset@night": lambda seed: Change(
            in_test={"night": faults.clock(("plate", "air", "rack", "outer"), 240.0)}
        ),
        "input.factor@heater_on": lambda seed: Change(in_test={"stirred": faults.factor("heater_on", 1.25)}),
        "ambient.offset@ambient": lambda seed: faults.offset("T_ambient", 4.0),
        "clipped@plate": lambda seed: faults.clipped("plate", 0.65),
    },
    foreign={
        "cable at rack": lambda seed: foreign.cable("rack", 1.2, 900.0),
        "splash at shell": lambda seed: foreign.gusts("outer", 90.0, seed),
        "heater at rack": lambda seed: foreign.hot_spell("rack", 14.0),
    },
    absorbed={
        "link.foam": lambda seed: Change({"foam": 2.5}),
        "capacity.rack": lambda seed: Change({"capacity.rack": 1.9}),
    },
    tense=("foam", "stirred", "still", "hinge", "feet", "capacity.rack"),
    parts={"plate": "plate", "chamber": "air", "wall": "inner", "shell": "outer", "rack": "rack", "lid": "lid"},
    passing=(
        Hidden("lid open@air", lambda a: room_air("air", a), 12.0),
        Hidden("draught@outer", lambda a: draught("outer", a), 12.0),
        Hidden("lamp@outer", lambda a: heating("outer", a), 80.0),
        Hidden("second heater@rack", lambda a: switched("rack", a, "heater_on"), 40.0),
        Hidden("stirrer slower@air", lambda a: less("fan_on", a), 1.5),
        Hidden("cover@outer", lambda a: covered(("outside",), a), 0.9),
        Hidden("meter@heater_on", lambda a: less("heater_on", a), 0.7, least=METER),
    ),
    logger=Logger(20.0, 10.0, 0.25, (2.0, 20.0), 0.15),
    called={"air": "chamber", "outer": "shell"},
    words={
        "leak@air": ("convection.constant@chamber", "convection.buoyant@chamber", "heat@chamber"),
        "lid open@air": ("convection.constant@chamber", "convection.buoyant@chamber", "heat@chamber"),
        "bridge@plate-outer": ("coupling@plate|shell",),
        "sleeve@lid": ("convection.buoyant@lid", "convection.constant@lid"),
        "bridge@plate-rack": ("coupling@plate|rack",),
        "second heater@rack": ("loss.constant@rack", "heat@rack"),
        "stirrer slower@air": ("input.factor@fan_on",),
    },
)
