"""The true series-wound brushed motor, 15 kW, 103 cells: air is blown from the commutator's end (1) to the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hidden.truth.body import Body, Joint, Skeleton, skeleton
from hidden.truth.change import Change
from hidden.truth.draw import Draw
from hidden.truth.films import cylinder_still, gap, plate_still, radiation
from hidden.truth.losses import ALPHA, bertotti, friction
from hidden.truth.machine import Film, Inputs, Loss, Machine

Array = NDArray[np.float64]
RATED, BLOWN = 1000.0, 400.0
COPPER, STEEL, IRON = -2e-4, -8e-4, -9e-4
ENDS = (("de", 0.0), ("nde", 1.0))


@dataclass(frozen=True)
class Draught:
    """Air through cells one after the other, `share` of the recorded m3/h, as dense as at the inlet."""

    name: str
    cells: NDArray[np.int64]
    share: float

    def into(self, q: Array, T: Array, u: Inputs) -> None:
        mcp = self.share * u["fan_flow_m3h"] / 3600.0 * 352.98 / (u["T_ambient"] + 273.15) * 1006.0
        before = np.concatenate([[u["T_ambient"]], T[self.cells[:-1]]])
        q[self.cells] += mcp * (before - T[self.cells])


def bodies(d: Draw) -> list[Body]:
    def C(key: str, value: float) -> float:
        return value * d.factor(f"capacity.{key}", 0.05)

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
    def G(key: str, value: float, sd: float) -> float:
        return value * d.factor(key, sd)

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
    out = [_along(s, name, air[long], A / 11, blown(h0)) for name, A, h0 in walls]
    out += [Film("commutator", s.cells("commutator"), air[[2, 1, 1, 0]], np.full(4, 0.05 / 4), blown(90.0))]
    for end, cell in (("de", 9), ("nde", 0)):
        inner = s.cells(f"flange.{end}")[2:]
        out.append(Film(f"inner.{end}", inner, air[[cell]], np.full(inner.size, 0.07 / inner.size), blown(40.0)))
    g = 2e-3 / d.factor("gap", 0.15)

    def film(T: Array, Ta: Array, u: Inputs) -> Array:
        return gap(0.5 * (T + Ta), u["speed_rpm"], 0.1, g)

    return [*out, *outside(s, d), Film("gap", s.cells("core"), s.cells("poles"), np.full(11, 0.1 / 11), film)]


def _along(s: Skeleton, body: str, air: NDArray[np.int64], area: float, h) -> Film:
    """Eleven cells on ten of air: the middle two share one."""
    return Film(body, s.cells(body), air, np.full(11, area), h)


def outside(s: Skeleton, d: Draw) -> list[Film]:
    still, emissivity = 0.9 * d.factor("still", 0.15), 0.85

    def frame(T: Array, Ta: Array, u: Inputs) -> Array:
        clean = 1.0 - u.get("fade.yoke", 0.0)
        return clean * (still * cylinder_still(T, Ta, 0.32) + radiation(T, Ta, emissivity))

    def shield(T: Array, Ta: Array, u: Inputs) -> Array:
        return still * plate_still(T, Ta, 0.3) + radiation(T, Ta, emissivity)

    ring = 0.07 * np.arange(6, 0, -1) / 21.0 * d.factor("face", 0.1)
    ends = [Film(f"shield.{end}", s.cells(f"flange.{end}"), "T_ambient", ring, shield) for end, _ in ENDS]
    return [Film("frame", s.cells("yoke"), "T_ambient", np.full(11, 0.45 / 11), frame), *ends]


def losses(s: Skeleton, d: Draw) -> list[Loss]:
    Ra, Rf = 0.03 * d.factor("copper.armature", 0.04), 0.02 * d.factor("copper.field", 0.04)
    kh, ke, kx = 70.0 * d.factor("iron", 0.15), 40.0 * d.factor("eddy", 0.2), 15.0 * d.factor("excess", 0.3)
    drop, rub = 2.0 * d.factor("drop", 0.1), 60.0 * d.factor("rub", 0.2)

    def brushes(T: Array, u: Inputs) -> Array:
        """The drop falls a little as the film on the copper warms; friction with speed."""
        contact = drop * abs(u["current_A"]) * (1.0 - 0.001 * (T - 60.0))
        return contact + rub * (u["speed_rpm"] / RATED) * (1.0 - 0.001 * (T - 60.0))

    def direct(R: float):
        return lambda T, u: R * u["current_A"] ** 2 * (1.0 + ALPHA * (T - 20.0))

    def iron(share: float):
        return lambda T, u: share * bertotti(T, u["speed_rpm"] / RATED, kh, ke, kx)

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

        def grease(T: Array, u: Inputs, P: float = P) -> Array:
            return friction(T, u["speed_rpm"] / RATED, P)

        out.append(Loss(f"grease.{end}", s.cells(f"bearing.{end}"), np.full(2, 0.5), grease))
    return out


def machine(d: Draw, change: Change) -> Machine:
    """The machine of one draw with what is hidden in it."""
    s = skeleton([*bodies(d), *change.bodies], [*joints(d), *change.joints])
    draught = Draught("air", s.cells("air"), d.factor("flow", 0.03))
    return Machine(s, (*films(s, d), draught, *losses(s, d), *change.terms(s)))
