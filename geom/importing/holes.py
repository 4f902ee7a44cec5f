"""Holes of pyleecan's classes by their own letters: magnets, and the air beside them, of one pole."""

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass

from geom.description.profile import Loop
from geom.importing.plane import Place, Point, Sizes, arc, crossing, loop_through, mirror, on_circle


@dataclass(frozen=True)
class Hole:
    """magnets : loops where magnets lie, in the order of magnet_0, magnet_1 ...;  air : the rest of the hole"""

    magnets: tuple[Loop, ...]
    air: tuple[Loop, ...]


def _both(magnets: list[Loop], air: list[Loop]) -> Hole:
    """As drawn below the middle, and mirror: magnet_0 lies below."""
    pairs = tuple(m for magnet in magnets for m in (magnet, mirror(magnet)))
    return Hole(pairs, tuple(a for loop in air for a in (loop, mirror(loop))))


def _along(start: complex, angle: float, *points: complex) -> list[complex]:
    """Points given along and across a direction (rad) from a start."""
    return [start + p * cmath.exp(1j * angle) for p in points]


def _m50(place: Place, d: Sizes) -> Hole:
    """Two magnets in a V, each in a seat, the tips of the hole along a rib of constant width."""
    r, h, deep = place.radius - d["H1"], place.half, d["H3"] - d["H2"]
    z9 = math.sqrt(r**2 - d["W0"] ** 2 / 4) - 0.5j * d["W0"]
    z8 = place.radius - d["H0"] - 0.5j * d["W1"]
    slope = math.atan((d["H0"] - place.radius + z9.real) / ((d["W0"] - d["W1"]) / 2))
    z7 = z8 - deep / math.cos(slope)
    corners = (d["W2"], d["W2"] - 1j * deep, d["W2"] - 1j * d["H3"])
    (top1, seat1, low1), (top2, seat2, low2) = (
        _along(z8, cmath.phase(z9 - z8), *(c + shift for c in corners)) for shift in (0.0, d["W4"])
    )
    rib = cmath.exp(-1j * h)
    z1 = r * cmath.exp(1j * (math.asin(d["W3"] / 2 / r) - h))
    z11, z10 = z1 + d["H4"] * rib, z9 + d["H4"] * rib
    z2 = crossing(seat1, seat2, z1, z1 + rib)
    magnet = loop_through([low1, low2, seat2, top2, top1, seat1])
    tip = loop_through([z1, z2, seat2, top2, z9, (z10, arc(z10, z11)), z11])
    return _both([magnet], [tip, loop_through([seat1, z7, z8, top1])])


def _m51(place: Place, d: Sizes) -> Hole:
    """Three magnets in a U: one across, one along either side."""
    r, half = place.radius - d["H1"], d["W1"] / 2
    rise = r * math.sin(half) - d["W0"] / 2
    lean = math.pi / 2 - math.atan((r * math.cos(half) - place.radius + d["H0"]) / rise)
    alpha = math.pi / 2 - lean
    z2 = place.radius - d["H0"] + 0.5j * d["W0"]
    side = cmath.exp(1j * lean)
    z5, z10 = r * cmath.exp(1j * half), z2 + 1j * d["H2"] * side
    z6, outer = on_circle(z10, z10 + side, r)[0], z2 - d["H2"] + 1j * math.tan(alpha / 2) * d["H2"]

    def beside(start: float, length: float) -> Loop:
        corners = (0.0, length, length + 1j * d["H2"], 1j * d["H2"])
        return loop_through([z2 + (start + corner) * side for corner in corners])

    high = z2 - 1j * d["W2"]
    low = high - 1j * d["W3"]
    across = loop_through([low, low - d["H2"], high - d["H2"], high])
    upper: list[Point] = [(z2, 0.0), (z5, arc(z5, z6)), (z6, 0.0), (outer, 0.0)]
    lower: list[Point] = [(outer.conjugate(), 0.0), (z6.conjugate(), arc(z5, z6)), (z5.conjugate(), 0.0)]
    whole = loop_through([*upper, *lower, z2.conjugate()])
    return Hole((mirror(beside(d["W6"], d["W7"])), across, beside(d["W4"], d["W5"])), (whole,))


def _m52(place: Place, d: Sizes) -> Hole:
    """One flat magnet in a seat, between ribs of constant width."""
    r = place.radius - d["H0"]
    z1 = r * cmath.exp(1j * (place.half - math.asin(d["W3"] / 2 / r)))
    low = z1.real - d["H1"]
    wide = z1.imag - math.tan(place.half) * (d["H1"] - d["H2"]) - d["W0"] / 2
    a, top = low + 0.5j * d["W0"], z1.real + 0.5j * d["W0"]
    seat = low + d["H2"] + 0.5j * d["W0"]
    tip = loop_through([seat, top, z1, seat + 1j * wide])
    return Hole((loop_through([a.conjugate(), top.conjugate(), top, a]),), (tip, mirror(tip)))


def _m53(place: Place, d: Sizes) -> Hole:
    """Two magnets in a V, the tips of the hole ended by a circle."""
    r, w, deep = place.radius - d["H1"], d["W4"], d["H2"] - d["H3"]
    z7 = place.radius - d["H0"] - 0.5j * d["W1"]
    z6, z8 = z7 - 1j * deep * math.cos(w), z7 + deep * math.sin(w)
    near, far = d["W2"], d["W2"] + d["W3"]
    seat1, low1, top1 = _along(z6, -w, near, near - 1j * d["H3"], near + 1j * deep)
    seat2, low2, top2 = _along(z6, -w, far, far - 1j * d["H3"], far + 1j * deep)
    z11, z1 = (on_circle(a, b, r)[0] for a, b in ((z8, top2), (z6, seat2)))
    magnet = loop_through([low1, low2, seat2, top2, top1, seat1])
    tip = loop_through([seat2, (z1, arc(z1, z11)), z11, top2])
    return _both([magnet], [tip, loop_through([z7, z6, seat1, top1, z8])])


def _m54(place: Place, d: Sizes) -> Hole:
    """A barrier between two circles around a point beyond the surface."""
    centre = place.radius - d["H0"] + d["R1"]
    a, b = (centre + r * cmath.exp(1j * (math.pi + d["W0"] / 2)) for r in (d["R1"], d["R1"] + d["H1"]))
    out, back = arc(b, b.conjugate(), centre), arc(a.conjugate(), a, centre)
    return Hole((), (loop_through([(b, out), (b.conjugate(), 0.0), (a.conjugate(), back), (a, 0.0)]),))


def _m57(place: Place, d: Sizes) -> Hole:
    """Two magnets in a V without seats, the tips of the hole along ribs of constant width."""
    r, h, alpha = place.radius - d["H1"], place.half, (math.pi - d["W0"]) / 2
    z1 = r * cmath.exp(-1j * (h - math.asin(d["W3"] / 2 / r)))
    z4 = z1.real - math.tan(alpha) * (abs(z1.imag) - d["W1"] / 2) - 0.5j * d["W1"]
    z5 = z4 - d["H2"] / math.cos(alpha)
    lean = cmath.phase(z1 - z4)
    z8 = crossing(z5, z5 + cmath.exp(1j * lean), z1, z1 - cmath.exp(-1j * h))
    along = ((z8 - z4) * cmath.exp(-1j * lean)).real
    far, near = along - d["W2"], along - d["W2"] - d["W4"]
    z2, z7, z3, z6 = _along(z4, lean, far, far - 1j * d["H2"], near, near - 1j * d["H2"])
    magnet = loop_through([z6, z7, z2, z3])
    return _both([magnet], [loop_through([z8, z1, z2, z7]), loop_through([z5, z6, z3, z4])])


def _m58(place: Place, d: Sizes) -> Hole:
    """One flat magnet between two round ends."""
    r0, z2 = d["R0"], place.radius - d["H0"] + 0.5j * d["W0"]
    centre, z5 = (place.radius - d["H1"] - r0) * cmath.exp(0.5j * d["W3"]), z2 - d["H2"]
    z3, z4 = _touch(z2, centre, r0, 1), _touch(z5, centre, r0, -1)
    sweep = cmath.phase((z4 - centre) / (z3 - centre)) % (2 * math.pi)
    bulge = math.tan(sweep / 4)
    lower: list[Point | complex] = [z5.conjugate(), (z4.conjugate(), bulge), z3.conjugate(), z2.conjugate()]
    whole: list[Point | complex] = [z2, (z3, bulge), z4, z5, *lower]
    a, b = z2 - 1j * d["W2"], z2 - 1j * (d["W2"] + d["W1"])
    return Hole((loop_through([a, a - d["H2"], b - d["H2"], b]),), (loop_through(whole),))


def _touch(point: complex, centre: complex, radius: float, sign: int) -> complex:
    """Where a tangent from the point touches a circle: on its outer side for +1."""
    away = point - centre
    turn = math.acos(min(radius / abs(away), 1.0))
    both = [centre + radius * cmath.exp(1j * (cmath.phase(away) + s * turn)) for s in (1, -1)]
    return max(both, key=lambda z: sign * z.real)


def _m60(place: Place, d: Sizes) -> Hole:
    """Two holes in a V with round ends, a magnet in the middle of each."""
    w, h0, long = d["W0"] / 2, d["H0"], d["W2"] - d["H0"]
    # as drawn with the middle of the pole upwards; the left hole begins at its inner end
    start = -d["W3"] / 2 + 1j * (h0 / (2 * math.sin(w)) + d["W3"] / 2 / math.tan(w))
    end = start + long * (-math.sin(w) + 1j * math.cos(w))
    way = (start - end) / abs(start - end)
    corner = end + (-0.5 * h0 - 0.5j * h0) * way
    lift = math.sqrt((place.radius - d["H1"]) ** 2 - corner.real**2) - corner.imag

    def placed(p: complex) -> complex:
        return (end + p * way + 1j * lift) * -1j

    a = (long - d["W1"]) / 2
    magnet = loop_through([placed(p) for p in (a, a - 1j * h0, a + d["W1"] - 1j * h0, a + d["W1"])])
    hole = [placed(p) for p in (0.0, -1j * h0, long - 1j * h0, long)]
    whole = loop_through([(hole[0], 1.0), hole[1], (hole[2], 1.0), hole[3]])
    return Hole((mirror(magnet), magnet), (whole, mirror(whole)))


def _m61(place: Place, d: Sizes) -> Hole:
    """A U: magnets across on either side of a rib, and along either side."""
    spoke = cmath.exp(1j * place.half)
    z1 = place.radius - d["H0"] + 0.5j * d["W0"]
    z2 = z1 + d["H1"]
    low, high = (-0.5j * w * spoke for w in (d["W3"], d["W3"] + 2 * d["H1"]))
    z6, z3 = crossing(z1, z1 + 1j, low, low + spoke), crossing(z2, z2 + 1j, high, high + spoke)
    reach = place.radius - d["H2"]
    z5, z4 = (on_circle(a, a + spoke, reach)[0] for a in (z6, z3))
    whole = loop_through([z1, z2, z3, (z4, arc(z4, z5)), z5, z6])
    across = loop_through([z1, z2, z2 + 1j * d["W1"], z1 + 1j * d["W1"]])
    middle = (z3 + z4) / 2
    a, b = middle - d["W2"] / 2 * spoke, middle + d["W2"] / 2 * spoke
    along = loop_through([a, b, b + 1j * d["H1"] * spoke, a + 1j * d["H1"] * spoke])
    return Hole((across, along, mirror(across), mirror(along)), (whole, mirror(whole)))


def _m62(place: Place, d: Sizes) -> Hole:
    """One buried magnet that fills its hole: along circles, or straight."""
    r = place.radius - d["H1"]
    if d.get("W0_is_rad"):
        a, b = ((r - x) * cmath.exp(0.5j * d["W0"]) for x in (0.0, d["H0"]))
    else:
        a = math.sqrt(r**2 - d["W0"] ** 2 / 4) + 0.5j * d["W0"]
        b = a - d["H0"]
    loop = loop_through(
        [(b.conjugate(), 0.0), (a.conjugate(), arc(a.conjugate(), a)), (a, 0.0), (b, arc(b, b.conjugate()))]
    )
    return Hole((loop,), ())


def _m63(place: Place, d: Sizes) -> Hole:
    """One buried magnet with a flat bottom that fills its hole, its top flat or round."""
    r = place.radius - d["H1"]
    top = r if d.get("top_flat") else math.sqrt(r**2 - d["W0"] ** 2 / 4)
    a = top + 0.5j * d["W0"]
    up = 0.0 if d.get("top_flat") else arc(a.conjugate(), a)
    return Hole((loop_through([(a - d["H0"]).conjugate(), (a.conjugate(), up), a, a - d["H0"]]),), ())


def _lsrpm(place: Place, d: Sizes) -> Hole:
    """One magnet that is narrower at its foot, with air at either end, all four corners of the hole rounded."""
    r, foot, side = d["R1"], d["R3"], cmath.exp(-1j * d["W1"])
    c1 = (foot + r) * cmath.exp(1j * (math.asin((r + d["W2"]) / (r + foot)) - d["W1"]))
    z1, start = c1 * foot / abs(c1), 1j * d["W2"] * side
    z2 = start + ((c1 - start) / side).real * side
    z3 = on_circle(start, start + side, d["R2"])[0]
    z5 = place.radius - d["H1"] - 0.5j * d["W0"]
    z4 = min((_touch(z3, z5 - r, r, sign) for sign in (1, -1)), key=lambda z: z.imag)
    lower: list[Point | complex] = [(z1, arc(z1, z2, c1)), z2, z3]
    upper: list[Point | complex] = [z3.conjugate(), (z2.conjugate(), arc(z1, z2, c1))]
    low = loop_through([*lower, *upper, (z1.conjugate(), arc(z1.conjugate(), z1))])
    tip: list[Point | complex] = [(z4, arc(z4, z5, z5 - r)), z5, (z5.conjugate(), arc(z4, z5, z5 - r)), z4.conjugate()]
    return Hole((loop_through([z3, z4, z4.conjugate(), z3.conjugate()]),), (low, loop_through(tip)))


HOLES: dict[str, Callable[[Place, Sizes], Hole]] = {
    "HoleM50": _m50,
    "HoleM51": _m51,
    "HoleM52": _m52,
    "HoleM53": _m53,
    "HoleM54": _m54,
    "HoleM57": _m57,
    "HoleM58": _m58,
    "HoleM60": _m60,
    "HoleM61": _m61,
    "HoleM62": _m62,
    "HoleM63": _m63,
    "HoleMLSRPM": _lsrpm,
}
