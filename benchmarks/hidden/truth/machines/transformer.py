"""The true dry-type transformer, 50 kVA: cast coils on three limbs, air that rises in their ducts, two stages of fans.

62 cells. Position 0 is the bottom; the coils of both outer limbs are one body, as all phases carry the same current.
"""

import numpy as np

from hidden.truth import faults, foreign
from hidden.truth.archetype import Archetype, Hidden, Plan, Spot, no_tempco
from hidden.truth.body import Body, Joint, Skeleton
from hidden.truth.change import Change
from hidden.truth.draw import Draw
from hidden.truth.effects import METER, bridge, covered, draught, fading, heating, less, warming
from hidden.truth.films import ALPHA, plate_still, radiation
from hidden.truth.machine import Array, Film, Inputs, Loss, Stream
from hidden.truth.profile import Rng, levels, steady
from hidden.truth.readings import Logger

R_LV, R_HV = 0.030, 0.034  # ohm per phase, both seen from the low-voltage side
COILS = (("mid", 1.0), ("outer", 2.0))  # limbs that each stands for


def bodies(d: Draw) -> list[Body]:
    def C(key: str, value: float) -> float:
        return d.capacity(key, value, 0.06)

    coils = [
        b
        for at, n in COILS
        for b in (
            Body(f"limb.{at}", C("limbs", 9000.0 * n), 5, 0.12 / n, -5e-4),
            Body(f"lv.{at}", C("lv", 2600.0 * n), 7, 0.12 / n, -2e-4),
            Body(f"hv.{at}", C("hv", 5200.0 * n), 7, 0.8 / n),
            Body(f"duct.{at}", 6.0 * n, 5, 1e4),
        )
    ]
    return [*coils, Body("yoke", C("yoke", 21000.0), 8, 0.5, -5e-4), Body("clamp", C("clamp", 6500.0), 6, 0.6)]


def joints(d: Draw) -> list[Joint]:
    limbs = [
        Joint(f"corner-{at}", f"limb.{at}", "yoke", 9.0 * n * d.factor("corners", 0.2), (0.9, 0.5)) for at, n in COILS
    ]
    blocks = [
        Joint(f"block-{at}", f"hv.{at}", "clamp", 0.4 * n * d.factor("blocks", 0.3), (0.0, 0.5)) for at, n in COILS
    ]
    return [*limbs, *blocks, Joint("tie", "yoke", "clamp", 7.0 * d.factor("tie", 0.25))]


def films(s: Skeleton, d: Draw) -> list[Film]:
    """Ducts by their own air and by radiation from wall to wall; the first stage of fans washes the faces, too."""
    still, blown = d.factor("still", 0.12), d.factor("blown", 0.15)

    def duct(T: Array, Ta: Array, u: Inputs) -> Array:
        fans = (1.1 * u["stage1_on"] + 0.8 * u["stage2_on"]) ** 0.7
        return 3.2 * still * ((T - Ta) ** 2 + 1.0) ** 0.1 + 7.0 * blown * fans

    def face(T: Array, Ta: Array, u: Inputs) -> Array:
        free = still * plate_still(T, Ta, 0.5)
        return (free**3 + (5.0 * blown * u["stage1_on"]) ** 3) ** (1 / 3) + radiation(T, Ta, 0.75)

    def dusty(T: Array, Ta: Array, u: Inputs) -> Array:
        return (1.0 - u.get("fade.hv.outer", 0.0)) * face(T, Ta, u)

    def grey(T: Array, Ta: Array, u: Inputs) -> Array:
        return radiation(T, Ta, 0.7)

    out = []
    for at, n in COILS:
        limb, lv, hv, air = (s.cells(f"{body}.{at}") for body in ("limb", "lv", "hv", "duct"))
        near = air[np.arange(7) * 5 // 7]
        out += [
            Film(f"lv.{at} in duct", lv, near, np.full(7, 0.26 * n / 7), duct),
            Film(f"hv.{at} in duct", hv, near, np.full(7, 0.3 * n / 7), duct),
            Film(f"lv.{at} on hv", lv, hv, np.full(7, 0.26 * n / 7), grey),
            Film(
                f"gap.{at}", limb, lv[[0, 2, 3, 4, 6]], np.full(5, 0.2 * n * d.factor("slit", 0.25) / 5), lambda *_: 9.0
            ),
            Film(
                f"face.{at}", hv, "T_ambient", np.full(7, (0.3 if at == "mid" else 0.84) / 7), dusty if n > 1 else face
            ),
        ]
    return [
        *out,
        Film("yoke", s.cells("yoke"), "T_ambient", np.full(8, 0.5 / 8), face),
        Film("clamp", s.cells("clamp"), "T_ambient", np.full(6, 0.3 / 6), face),
    ]


def losses(s: Skeleton, d: Draw) -> list[Loss]:
    """Eddies in the coils fall as they warm; iron follows the voltage to the 2.7; stray flux heats the clamp."""
    R = {"lv": R_LV * d.factor("lv", 0.04), "hv": R_HV * d.factor("hv", 0.04)}
    eddy, iron, stray = {"lv": 0.09, "hv": 0.05}, 290.0 * d.factor("iron", 0.12), 26.0 * d.factor("stray", 0.25)

    def core(T: Array, u: Inputs) -> Array:
        return iron * (u["voltage_V"] / 400.0) ** 2.7 * (1.0 - 4e-4 * (T - 50.0))

    out = [
        Loss("yoke", s.cells("yoke"), np.full(8, 0.42 / 8), core),
        Loss("stray", s.cells("clamp"), np.full(6, 1 / 6), lambda T, u: stray * (u["current_A"] / 70.0) ** 2),
    ]
    for at, n in COILS:
        out.append(Loss(f"limb.{at}", s.cells(f"limb.{at}"), np.full(5, 0.58 * n / 15), core))
        for coil in ("lv", "hv"):

            def joule(T: Array, u: Inputs, R: float = R[coil], e: float = eddy[coil]) -> Array:
                warm = 1.0 + ALPHA * (T - 20.0)
                return 3.0 * R * u["current_A"] ** 2 * (warm + e / warm)

            out.append(Loss(f"{coil}.{at}", s.cells(f"{coil}.{at}"), np.full(7, n / 21), joule))
    return out


def streams(s: Skeleton, d: Draw) -> list[Stream]:
    draws, blows = d.factor("chimney", 0.15), d.factor("blown", 0.15)

    def rising(n: float):
        """As much air as warm air draws (root of the rise), and what both fans blow."""

        def mcp(T: Array, u: Inputs) -> float:
            drawn = n * draws * max(float(T.mean()) - u["T_ambient"] + 1.0, 0.1) ** 0.5
            return drawn + (9.0 * n * blows * u["stage1_on"] + 6.5 * n * blows * u["stage2_on"])

        return mcp

    return [Stream(s.cells(f"duct.{a}"), "T_ambient", rising(n)) for a, n in COILS]


def drive(current: Array, voltage: Array, one: Array, two: Array) -> dict[str, Array]:
    return {"current_A": current, "voltage_V": voltage, "stage1_on": one, "stage2_on": one * two}


def turns(at: Array, rng: Rng, minutes: float, share: float = 0.5) -> Array:
    return (levels(at, rng, 0.0, 1.0, minutes) < share).astype(float)


def no_load(rng: Rng, at: Array) -> dict[str, Array]:
    late = (at > 7200.0).astype(float)
    return drive(steady(at, 0.0), levels(at, rng, 380.0, 430.0, 60.0), late, steady(at, 0.0))


def shorted(rng: Rng, at: Array) -> dict[str, Array]:
    """Some volts drive the rated current; then off, fans on at the end."""
    on, late = (at < 7800.0), (at > 5400.0).astype(float)
    return drive(levels(at, rng, 62.0, 76.0, 50.0) * on, 16.0 * on, late, (at > 9000.0).astype(float))


def heat_run(rng: Rng, at: Array) -> dict[str, Array]:
    volts = levels(at, rng, 385.0, 420.0, 45.0)
    return drive(levels(at, rng, 40.0, 90.0, 35.0), volts, turns(at, rng, 30.0), turns(at, rng, 30.0))


def works(rng: Rng, at: Array) -> dict[str, Array]:
    volts = levels(at, rng, 385.0, 420.0, 20.0)
    return drive(levels(at, rng, 10.0, 105.0, 8.0), volts, turns(at, rng, 20.0), turns(at, rng, 20.0))


READ = {"lv.mid": 0.6, "lv.outer": 0.5, "hv.mid": 0.5, "hv.outer": 0.5, "yoke": 0.5, "clamp": 0.5}
CALLED = {"lv.mid": "LV middle", "lv.outer": "LV outer", "hv.mid": "HV middle", "hv.outer": "HV outer"}


TRANSFORMER = Archetype(
    name="transformer",
    bodies=bodies,
    joints=joints,
    terms=(films, streams, losses),
    plans=(
        Plan("no load", "calibrate", 180.0, no_load),
        Plan("short circuit", "calibrate", 180.0, shorted),
        Plan("heat run", "calibrate", 180.0, heat_run),
        Plan("Monday", "validate", 180.0, works),
        Plan("Tuesday", "hold-out", 180.0, works),
    ),
    thermometers={body: Spot(body, x) for body, x in READ.items()},
    missing=(
        Hidden("draught@hv.outer", lambda a: draught("hv.outer", a), 15.0),
        Hidden("cable@lv.outer", lambda a: draught("lv.outer", a), 10.0),
        Hidden("lamp@clamp", lambda a: heating("clamp", a), 150.0),
        Hidden("harmonics@hv.mid", lambda a: heating("hv.mid", a, current=(2.0, 1.9)), 400.0),
        Hidden("harmonics@lv.outer", lambda a: heating("lv.outer", a, current=(2.0, 1.9)), 600.0),
        Hidden("bridge@clamp-lv.outer", lambda a: bridge("blocks", a, "clamp", "lv.outer", (0.5, 0.0)), 8.0),
        Hidden("dust@hv.outer", lambda a: fading("hv.outer", a), 0.5),
        Hidden("no tempco@lv", lambda a: warming("lv.outer", 2.0 * R_LV, a), ALPHA, no_tempco("low")),
    ),
    faults={
        "sensor.gain@LV middle": lambda seed: faults.gain("lv.mid", -0.1),
        "sensor.lag@LV outer": lambda seed: faults.slow("lv.outer", 400.0),
        "sensor.stem@HV middle": lambda seed: faults.stem("hv.mid", 0.25),
        "sensor.swap@HV middle|HV outer": lambda seed: faults.swapped("hv.mid", "hv.outer"),
        "sensor.drift@yoke": lambda seed: faults.drift("yoke", 2.5),
        "time.offset@heat run": lambda seed: Change(in_test={"heat run": faults.clock(READ, 420.0)}),
        "input.factor@current_A": lambda seed: Change(in_test={"heat run": faults.factor("current_A", 1.15)}),
        "ambient.offset@ambient": lambda seed: faults.offset("T_ambient", 5.0),
        "frozen@clamp": lambda seed: faults.frozen("clamp", 0.4),
    },
    foreign={
        "cable at LV outer": lambda seed: foreign.cable("lv.outer", 5.0, 6000.0),
        "splash at HV outer": lambda seed: foreign.gusts("hv.outer", 500.0, seed),
        "heater at clamp": lambda seed: foreign.hot_spell("clamp", 120.0),
    },
    absorbed={
        "link.tie": lambda seed: Change({"tie": 0.25}),
        "chimney": lambda seed: Change({"chimney": 0.45}),
        "loss.iron": lambda seed: Change({"iron": 2.0}),
    },
    tense=("tie", "chimney", "still", "blown", "iron", "corners", "slit"),
    parts={**{node: body for body, node in CALLED.items()}, "yoke": "yoke", "clamp": "clamp", "limbs": "limb.outer"},
    passing=(
        Hidden("draught@hv.outer", lambda a: draught("hv.outer", a), 20.0),
        Hidden("lamp@clamp", lambda a: heating("clamp", a), 200.0),
        Hidden("cover@hv.outer", lambda a: covered(("face.outer",), a), 0.9),
        Hidden("stage slower@ducts", lambda a: less("stage1_on", a), 1.5),
        Hidden("meter@current_A", lambda a: less("current_A", -a), 0.3, least=METER),
    ),
    logger=Logger(60.0, 10.0, 0.1, (15.0, 60.0), 0.1),
    called=CALLED,
    words={
        "cable@lv.outer": ("conduction.cable@LV outer", "convection.constant@LV outer"),
        "bridge@clamp-lv.outer": ("coupling@clamp|LV outer", "coupling@LV outer|clamp"),
        "no tempco@lv": ("copper.feedback@low",),
        "stage slower@ducts": ("input.factor@stage1_on",),
    },
)
