"""The true water-jacket magnet motor, 60 kW peak, potted end windings: 111 cells. Water runs from position 0 to 1."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hidden.truth.body import Body, Joint, Skeleton, skeleton
from hidden.truth.change import Change
from hidden.truth.draw import Draw
from hidden.truth.films import channel, cylinder_still, gap, plate_still, radiation, stirred
from hidden.truth.losses import bertotti, copper, friction
from hidden.truth.machine import Film, Inputs, Loss, Machine

Array = NDArray[np.float64]
RATED = 4000.0
COPPER, STEEL, ALUMINIUM = -2e-4, -8e-4, -1e-4
ENDS = (("de", 0.0), ("nde", 1.0))


@dataclass(frozen=True)
class Stream:
    """Water through cells one after the other; its heat capacity flow (W/K) is that of the recorded litres per minute
    times `share`."""

    name: str
    cells: NDArray[np.int64]
    share: float

    def into(self, q: Array, T: Array, u: Inputs) -> None:
        mcp = self.share * u["flow_l_min"] / 60000.0 * 1055.0 * 3380.0
        before = np.concatenate([[u["T_coolant"]], T[self.cells[:-1]]])
        q[self.cells] += mcp * (before - T[self.cells])


def bodies(d: Draw) -> list[Body]:
    def C(key: str, value: float) -> float:
        return value * d.factor(f"capacity.{key}", 0.05)

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
    def G(key: str, value: float, sd: float) -> float:
        return value * d.factor(key, sd)

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


def films(s: Skeleton, d: Draw) -> list[Film]:
    """Room on housing and shields, water on the jacket, both end spaces, the gap."""
    still, emissivity = 0.9 * d.factor("still", 0.15), 0.7
    wall = 0.075 * d.factor("jacket", 0.15)
    weight = np.linspace(1.0 + d.times.get("patchy", 0.0), 1.0 - d.times.get("patchy", 0.0), 8)

    def drum(T: Array, Ta: Array, u: Inputs) -> Array:
        clean = 1.0 - u.get("fade.housing", 0.0)
        return clean * (still * cylinder_still(T, Ta, 0.25) + radiation(T, Ta, emissivity))

    def shield(T: Array, Ta: Array, u: Inputs) -> Array:
        return still * plate_still(T, Ta, 0.24) + radiation(T, Ta, emissivity)

    def wet(T: Array, Tf: Array, u: Inputs) -> Array:
        return weight * channel(0.5 * (T + Tf), u["flow_l_min"], 1.2e-4, 0.010)

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

        def h(T: Array, Ta: Array, u: Inputs, k1: float = k1, k2: float = k2) -> float:
            return stirred(u["speed_rpm"], 0.07, k1, k2)

        walls = (
            (s.cells(f"winding.{end}"), 0.02),
            (s.cells(f"shield.{end}")[2:], 0.04),
            (np.array([s.cell("rotor", x)]), 0.025),
        )
        air = s.cells(f"air.{end}")
        out += [Film(f"end.{end}.{k}", w, air, np.full(w.size, A / w.size), h) for k, (w, A) in enumerate(walls)]
    g = 0.8e-3 / d.factor("gap", 0.15)

    def film(T: Array, Ta: Array, u: Inputs) -> Array:
        return gap(0.5 * (T + Ta), u["speed_rpm"], 0.075, g)

    return [*out, Film("gap", s.cells("magnets"), s.cells("teeth"), np.full(11, 0.09 / 11), film)]


def losses(s: Skeleton, d: Draw) -> list[Loss]:
    R = 8e-3 * d.factor("copper", 0.04)
    kh, ke, kx = 160.0 * d.factor("iron", 0.15), 190.0 * d.factor("eddy", 0.2), 50.0 * d.factor("excess", 0.3)
    km = 40.0 * d.factor("magnet", 0.2)

    def winding(T: Array, u: Inputs) -> Array:
        return copper(R, u["current_A"], T)

    def iron(T: Array, u: Inputs) -> Array:
        return bertotti(T, u["speed_rpm"] / RATED, kh, ke, kx)

    out = [
        Loss("slot", s.cells("slot"), np.full(11, 0.5 / 11), winding),
        Loss("teeth", s.cells("teeth"), np.full(11, 0.6 / 11), iron),
        Loss("yoke", s.cells("yoke"), np.full(11, 0.4 / 11), iron),
        Loss(
            "eddy",
            s.cells("magnets"),
            np.full(11, 1 / 11),
            lambda T, u: km * (u["speed_rpm"] / RATED) ** 1.9 / (1.0 + 0.0005 * (T - 40.0)),
        ),
    ]
    for end, _ in ENDS:
        P = 22.0 * d.factor(f"bearing.{end}", 0.25)

        def grease(T: Array, u: Inputs, P: float = P) -> Array:
            return friction(T, u["speed_rpm"] / RATED, P, 0.004)

        out.append(Loss(f"end.{end}", s.cells(f"winding.{end}"), np.full(5, 0.25 / 5), winding))
        out.append(Loss(f"grease.{end}", s.cells(f"bearing.{end}"), np.full(2, 0.5), grease))
    return out


def machine(d: Draw, change: Change) -> Machine:
    """The machine of one draw with what is hidden in it."""
    s = skeleton([*bodies(d), *change.bodies], [*joints(d), *change.joints])
    water = Stream("water", s.cells("water"), d.factor("flow", 0.03))
    return Machine(s, (*films(s, d), water, *losses(s, d), *change.terms(s)))
