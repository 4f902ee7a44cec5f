"""The true oil-sprayed hairpin motor, 80 kW peak: four layers of bars, nozzles, cooler and tank. 85 cells.

Position 0 is the weld side, 1 the bend side; layer 1 lies at the bottom of the slot. The rotor flings oil about.
"""

from dataclasses import dataclass

import numpy as np

from hidden.truth import faults, films, foreign
from hidden.truth.archetype import Archetype, Hidden, Plan, Spot
from hidden.truth.body import Body, Cells, Joint, Skeleton
from hidden.truth.change import Change
from hidden.truth.draw import Draw
from hidden.truth.effects import METER, airflow, bridge, covered, draught, heating, less
from hidden.truth.machine import Array, Film, Inputs, Loss
from hidden.truth.profile import Rng, levels, steady, until
from hidden.truth.readings import Logger

RATED, R20, LAYERS = 5000.0, 9e-3, (1, 2, 3, 4)
COPPER, STEEL, ALUMINIUM = -2e-4, -8e-4, -1e-4
SIDES = (
    ("weld", "front", 0.0, 0.04),
    ("bend", "rear", 0.999, 0.035),
)  # cover behind it, place, face under nozzles (m2)
OIL, AIR = 28.0, 130.0  # W/K of a litre of oil per minute, of the cooler's air


def viscosity(T: Array) -> Array:
    """Kinematic (mm2/s) of a thin gear oil: Vogel 1921 through 29 at 40 degC and 6.5 at 100 degC."""
    return 29.0 * np.exp(656.0 * (1.0 / (np.clip(T, -20.0, 180.0) + 95.0) - 1.0 / 135.0))


@dataclass(frozen=True)
class OilLoop:
    """Tank, both sides' nozzles, what drips off, cooler and back; the cooler works between mean temperatures."""

    sides: tuple[Cells, Cells]
    back: tuple[int, int, int]  # dripped off, cooled, tank
    flow: float
    weld: float
    UA: float

    def into(self, q: Array, T: Array, u: Inputs) -> None:
        (warm, cooled, tank), mcp = self.back, OIL * self.flow * max(u["flow_l_min"], 0.05)
        for cells, share in zip(self.sides, (self.weld, 1.0 - self.weld), strict=True):
            before = np.concatenate([[T[tank]], T[cells[:-1]]])
            q[cells] += share * mcp * (before - T[cells])
            q[warm] += share * mcp * (T[cells[-1]] - T[warm])
        wall = 1.0 / (self.UA * (u["flow_l_min"] / 8.0) ** 0.1 + 0.1)
        q[cooled] += mcp * (T[warm] - T[cooled]) - (T[warm] - u["T_ambient"]) / (wall + 0.5 / mcp + 0.5 / AIR)
        q[tank] += mcp * (T[cooled] - T[tank])


def bodies(d: Draw) -> list[Body]:
    C = d.capacity
    side = [
        b
        for end, cover, *_ in SIDES
        for b in (
            Body(f"{end}", C("ends", 800.0 if end == "weld" else 700.0), 5, 0.06, COPPER),
            Body(f"{cover}", C("covers", 2600.0), 5, 0.12, ALUMINIUM),
            Body(f"oil.{end}", 25.0, 3, 1e4),
        )
    ]
    return [
        *(Body(f"layer.{m}", C("layers", 420.0), 6, 0.12, COPPER) for m in LAYERS),
        Body("teeth", C("core", 4500.0), 6, 4.0, STEEL),
        Body("yoke", C("core", 7500.0), 6, 3.0, STEEL),
        Body("magnets", C("rotor", 900.0), 6, 9.0),
        Body("rotor", C("rotor", 6100.0), 6, 1.5, STEEL),
        Body("housing", C("housing", 9000.0), 8, 0.1, ALUMINIUM),
        *side,
        Body("tank", 4100.0),
        Body("warm", 120.0),
        Body("cooled", 120.0),
    ]


def joints(d: Draw) -> list[Joint]:
    G = d.conductance
    walls = [Joint(f"wall-{m}", f"layer.{m}", "teeth", G("wall", 26.0, 0.2), slope=4e-4) for m in LAYERS]
    side = [
        j
        for end, cover, x, _ in SIDES
        for j in (
            *(Joint(f"{end}-{m}", f"layer.{m}", end, G("overhang", 22.0, 0.15), (x, 0.0)) for m in LAYERS),
            Joint(f"bearing-{end}", "rotor", cover, G(f"bearing-{end}", 1.0), (x, 0.999)),
            Joint(f"spigot-{end}", cover, "housing", G(f"spigot-{end}", 24.0), (0.0, x)),
        )
    ]
    return [
        *(Joint(f"enamel-{m}", f"layer.{m}", f"layer.{m + 1}", G("enamel", 55.0, 0.2)) for m in LAYERS[:-1]),
        *walls,
        Joint("bottom", "layer.1", "yoke", G("wall", 34.0, 0.2), slope=4e-4),
        Joint("back", "teeth", "yoke", G("back", 300.0, 0.1), slope=STEEL),
        Joint("fit", "yoke", "housing", G("fit", 180.0), slope=1e-3),
        Joint("glue", "magnets", "rotor", G("glue", 60.0, 0.2)),
        *side,
    ]


def surfaces(s: Skeleton, d: Draw) -> list[Film]:
    """Oil on end windings with flow, viscosity and what the rotor flings; on covers, rotor ends and the tank's wall."""
    still, spray, fling = d.factor("still", 0.15), d.factor("spray", 0.2), 0.35 * d.factor("fling", 0.25)
    wet, g = d.factor("wet covers", 0.2), 0.8e-3 / d.factor("gap", 0.15)

    def flung(u: Inputs) -> float:
        return (abs(u["speed_rpm"]) / RATED) ** 0.7

    def sprayed(T: Array, To: Array, u: Inputs) -> Array:
        thin = (29.0 / viscosity(0.3 * T + 0.7 * To)) ** 0.24
        return 490.0 * spray * (u["flow_l_min"] / 8.0) ** 0.35 * thin * (1.0 + fling * flung(u))

    def ends(T: Array, To: Array, u: Inputs) -> Array:
        return d.factor("wet rotor", 0.25) * (12.0 + 110.0 * flung(u) ** 0.8) * (29.0 / viscosity(To)) ** 0.1

    drum = films.free_film(films.cylinder_still, 0.25, still, 0.8)
    plate = films.free_film(films.plate_still, 0.22, still, 0.8)

    def washed(T: Array, To: Array, u: Inputs) -> float:
        return 85.0 * wet * (u["flow_l_min"] / 8.0) ** 0.2

    out = [
        Film("drum", s.cells("housing"), "T_ambient", np.full(8, 0.35 / 8), drum),
        Film("tank wall", s.cells("housing")[2:6], s.cells("tank"), np.full(4, 0.05 / 4), lambda T, To, u: 90.0 * wet),
        films.across_gap(s, "magnets", "teeth", 0.09, 0.08, g),
    ]
    for end, cover, x, area in SIDES:
        oil, face = s.cells(f"oil.{end}"), s.cells(cover)
        out += [
            Film(f"spray.{end}", s.cells(end), oil[[0, 0, 1, 1, 2]], np.full(5, area / 5), sprayed),
            Film(f"flung.{end}", np.array([s.cell("rotor", x)]), oil[[1]], np.array([0.03]), ends),
            Film(f"wet.{end}", face, oil[[2]], np.full(5, 0.05 / 5), washed),
            Film(f"plate.{end}", face, "T_ambient", np.full(5, 0.07 / 5), plate),
        ]
    return out


def losses(s: Skeleton, d: Draw) -> list[Loss]:
    """Eddies grow from layer to layer and fall as copper warms; ends carry direct current's loss only."""
    R, ac = R20 * d.factor("copper", 0.04), 0.22 * d.factor("ac", 0.2)
    iron = films.steel(d, RATED, 150.0, 160.0, 45.0)
    eddy = films.magnet_eddy(70.0 * d.factor("magnet", 0.2), RATED)
    out = [
        Loss("teeth", s.cells("teeth"), np.full(6, 0.6 / 6), iron),
        Loss("yoke", s.cells("yoke"), np.full(6, 0.4 / 6), iron),
        Loss("magnets", s.cells("magnets"), np.full(6, 1 / 6), eddy),
    ]
    for m in LAYERS:

        def bars(T: Array, u: Inputs, k: float = ac * (m * (m - 1) / 3.0 + 4.0 / 45.0)) -> Array:
            more = k * (abs(u["speed_rpm"]) / 6000.0) ** 1.85 * (1.0 - 0.003 * (T - 60.0))
            return films.copper(R, u["current_A"], T) + 3.0 * R * u["current_A"] ** 2 * more

        out.append(Loss(f"layer.{m}", s.cells(f"layer.{m}"), np.full(6, 0.15 / 6), bars))
    for end, cover, x, _ in SIDES:
        grease = films.bearing(30.0 * d.factor(f"grease-{end}", 0.25), RATED, 0.004)
        share = (0.53 if end == "weld" else 0.47) * 0.4
        out += [
            Loss(f"{end}", s.cells(end), np.full(5, share / 5), films.joule(R)),
            Loss(f"grease.{end}", np.array([s.cell(cover, 0.999), s.cell("rotor", x)]), np.array([0.7, 0.3]), grease),
        ]
    return out


def oil(s: Skeleton, d: Draw) -> list[OilLoop]:
    sides = s.cells("oil.weld"), s.cells("oil.bend")
    back = s.cell("warm", 0), s.cell("cooled", 0), s.cell("tank", 0)
    weld, UA = d.between("weld share", 0.47, 0.53), 60.0 * d.factor("cooler", 0.15)
    return [OilLoop(sides, back, d.factor("flow", 0.03), weld, UA)]


def drive(current: Array, speed: Array, flow: Array, wind: Array) -> dict[str, Array]:
    return {"current_A": current, "speed_rpm": speed, "flow_l_min": flow, "vehicle_speed_mps": wind}


def direct(rng: Rng, at: Array) -> dict[str, Array]:
    current = levels(at, rng, 160.0, 240.0, 15.0) * until(at, 50.0, 1.0)
    return drive(current, steady(at, 0.0), steady(at, 8.0), steady(at, 0.0))


def load(rng: Rng, at: Array) -> dict[str, Array]:
    flow = np.where(at > 2400.0, 7.0, 11.0)
    return drive(levels(at, rng, 100.0, 260.0, 9.0), steady(at, 4000.0), flow, steady(at, 0.0))


def speeds(rng: Rng, at: Array) -> dict[str, Array]:
    return drive(
        levels(at, rng, 60.0, 160.0, 12.0), levels(at, rng, 1000.0, 9000.0, 8.0), steady(at, 8.0), steady(at, 0.0)
    )


def passes(rng: Rng, at: Array) -> dict[str, Array]:
    current, speed = levels(at, rng, 50.0, 250.0, 3.0), levels(at, rng, 800.0, 8000.0, 5.0)
    return drive(current, speed, levels(at, rng, 6.5, 12.0, 14.0), levels(at, rng, 0.0, 25.0, 4.0))


READ = {**dict.fromkeys(("layer.1", "layer.4", "weld", "bend", "yoke", "housing", "tank"), 0.5), "front": 0.4}
CALLED = {"layer.1": "layer 1", "layer.4": "layer 4", "weld": "weld side", "bend": "bend side", "yoke": "core"}
CALLED |= {"front": "front cover", "tank": "spray.reservoir"}
PARTS = {node: body for body, node in CALLED.items() if body != "tank"}
PARTS |= {"rotor": "rotor", "housing": "housing", "rear cover": "rear", "layer 2": "layer.2", "layer 3": "layer.3"}


HAIRPIN = Archetype(
    name="hairpin",
    bodies=bodies,
    joints=joints,
    terms=(surfaces, oil, losses),
    plans=(
        Plan("direct current", "calibrate", 75.0, direct),
        Plan("load", "calibrate", 75.0, load),
        Plan("speeds", "calibrate", 75.0, speeds),
        Plan("mountain pass", "validate", 75.0, passes),
        Plan("way home", "hold-out", 75.0, passes),
    ),
    thermometers={body: Spot(body, x) for body, x in READ.items()},
    missing=(
        Hidden("road wind@housing", lambda a: airflow("housing", a), 60.0),
        Hidden("draught@rear", lambda a: draught("rear", a), 20.0),
        Hidden("windage@rotor", lambda a: heating("rotor", a, (3.0, 2.8)), 15.0),
        Hidden("load loss@magnets", lambda a: heating("magnets", a, (2.0, 1.8), (2.0, 2.0)), 60.0),
        Hidden("ac copper@layer.4", lambda a: heating("layer.4", a, (2.0, 1.8), (2.0, 2.0), fade=0.002), 60.0),
        Hidden("loop currents@layer.1", lambda a: heating("layer.1", a, current=(2.0, 2.0)), 150.0),
        Hidden("terminals@weld", lambda a: bridge("terminals", a, "weld", "housing", (0.9, 0.1)), 15.0),
        Hidden("blocked nozzles@weld", lambda a: covered(("spray.weld",), a), 0.9),
        Hidden("heat@front", lambda a: heating("front", a), 200.0),
    ),
    faults={
        "sensor.gain@core": lambda seed: faults.gain("yoke", -0.12),
        "sensor.lag@weld side": lambda seed: faults.slow("weld", 100.0),
        "sensor.stem@layer 4": lambda seed: faults.stem("layer.4", 0.2),
        "sensor.swap@bend side|weld side": lambda seed: faults.swapped("weld", "bend"),
        "sensor.drift@housing": lambda seed: faults.drift("housing", 5.0),
        "time.offset@load": lambda seed: Change(in_test={"load": faults.clock(READ, 150.0)}),
        "input.factor@current_A": lambda seed: Change(in_test={"load": faults.factor("current_A", 1.15)}),
        "ambient.offset@ambient": lambda seed: faults.offset("T_ambient", 5.0),
        "frozen@front cover": lambda seed: faults.frozen("front", 0.5),
    },
    foreign={
        "cable at bend side": lambda seed: foreign.cable("bend", 7.0, 3000.0),
        "splash at housing": lambda seed: foreign.gusts("housing", 700.0, seed),
        "demagnetisation at rotor": lambda seed: foreign.runaway("magnets", 80.0, 60.0),
        "heater at front cover": lambda seed: foreign.hot_spell("front", 200.0),
    },
    absorbed={
        "housing fit": lambda seed: Change({"fit": 0.2}),
        "slot sides": lambda seed: Change({"wall": 0.3}),
        "film.spray": lambda seed: Change({"spray": 0.35}),
        "loss.iron": lambda seed: Change({"iron": 2.2, "eddy": 2.2}),
    },
    tense=("fit", "wall", "spray", "cooler", "iron", "ac", "wet rotor", "still"),
    doubted={"wet rotor": 0.25},
    parts=PARTS,
    passing=(
        Hidden("draught@housing", lambda a: draught("housing", a), 60.0),
        Hidden("heat@front", lambda a: heating("front", a), 250.0),
        Hidden("pump@oil", lambda a: less("flow_l_min", a), 1.0),
        Hidden("cover@housing", lambda a: covered(("drum",), a), 0.9),
        Hidden("meter@current_A", lambda a: less("current_A", a), 0.5, least=METER),
    ),
    logger=Logger(20.0, 5.0, 0.1, (2.0, 12.0), 0.08),
    called=CALLED,
    words={
        "draught@rear": ("convection.constant@rear cover",),
        "load loss@magnets": ("loss.rotor.load@rotor",),
        "loop currents@layer.1": ("loss.winding@layer 1", "loss.factor@loss:copper 1"),
        "terminals@weld": ("coupling@weld side|housing", "coupling@housing|weld side"),
        "pump@oil": ("flow@circuit.spray", "input.factor@flow_l_min"),
    },
)
