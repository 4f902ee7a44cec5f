"""Slots of pyleecan's classes by their own letters: steps down from the surface, or corners where edges are arcs."""

import cmath
import math
from collections.abc import Callable

from geom.importing.plane import Place, Point, Sizes, Slot, arc, loop_through

# Depth and width of each corner, from the surface on, and the corner where the winding begins.
STEPS = {
    "SlotW10": ("0:W0 H0:W0 H0+H1:W1 H0+H1:W0 H0+H1+H2:W2", 3),
    "SlotW13": ("0:W0 H0:W0 H0+H1:W1 H0+H1:W2 H0+H1+H2:W3", 3),
    "SlotW21": ("0:W0 H0:W0 H0+H1:W1 H0+H1+H2:W2", 2),
    "SlotW27": ("0:W0 H0:W0 H0:W1 H0+H1:W2 H0+H1+H2:W3", 2),
    "SlotW29": ("0:W0 H0:W0 H0:W1 H0+H1:W1 H0+H1:W2 H0+H1+H2:W2", 4),
    "SlotM16": ("0:W0 H0:W0 H0:W1 H0+H1:W1", 2),
}


def _steps(place: Place, sizes: Sizes, text: str) -> list[Point]:
    out: list[Point] = []
    for corner in text.split():
        depth, width = corner.split(":")
        start = place.on_surface(sizes["W0"]).real
        down = sum(sizes[key] for key in depth.split("+") if key != "0")
        out.append((start + place.way * down + 0.5j * sizes[width], 0.0))
    return out


def _w11(place: Place, d: Sizes) -> Slot:
    """Straight sides with a rounded corner on either side of the bottom."""
    half, r = _steps(place, d, "0:W0 H0:W0 H0+H1:W1"), place.way * d["R1"]
    last = half[-1][0] + place.way * d["H2"] + 0.5j * (d["W2"] - d["W1"])
    z, end = last - r, last - 1j * d["R1"]
    return Slot([*half, (z, arc(z, end, z - 1j * d["R1"])), (end, 0.0)], 0.0, 2)


def _w12(place: Place, d: Sizes) -> Slot:
    """A round hole over a round-bottomed bar."""
    z1, s = place.on_surface(2 * d["R2"]), place.way
    z2, z4 = z1 + s * d["H0"], z1 + s * (d["H0"] + 2 * d["R1"] + d["H1"])
    half = [(z1, 0.0), (z2, -float(s)), (z2 + 2 * s * d["R1"], 0.0), (z4, 0.0)]
    return Slot(half, float(s), 2)


def _w14(place: Place, d: Sizes) -> Slot:
    """Between parallel teeth, with a bottom of two straight lines."""
    z1, s = place.on_surface(d["W0"]), place.way
    z3 = place.beside_tooth(z1.real + s * (d["H0"] + d["H1"]), d["W3"])
    z4 = z3 + s * d["H3"] * cmath.exp(1j * place.half)
    middle = (z4 * cmath.exp(-1j * place.half)).real / math.cos(place.half)
    return Slot([(z, 0.0) for z in (z1, z1 + s * d["H0"], z3, z4, complex(middle))], 0.0, 2)


def _w15(place: Place, d: Sizes) -> Slot:
    """Between parallel teeth, all four corners rounded."""
    h, z1 = cmath.exp(1j * place.half), place.on_surface(d["W0"])
    z2, deep = place.radius + d["H0"] + 1j * z1.imag, place.radius + d["H0"] + d["H1"] + d["H2"]
    low = d["W3"] / 2 + d["R2"]
    c2 = place.from_tooth(math.sqrt((deep - d["R2"]) ** 2 - low**2) + 1j * low)
    c1 = place.beside_tooth(place.radius + d["H0"] + d["H1"], d["W3"] + 2 * d["R1"])
    flank1, flank2 = (c + 1j * r * h for c, r in ((c1, d["R1"]), (c2, d["R2"])))
    away, r = z2 - c1, d["R1"]
    touch = c1 + r * cmath.exp(1j * (cmath.phase(away) + math.acos(min(r / abs(away), 1.0))))
    below = c1 + r * cmath.exp(1j * (cmath.phase(away) - math.acos(min(r / abs(away), 1.0))))
    touch = touch if touch.real < below.real else below
    z8 = c2 * deep / abs(c2)
    half = [
        (z1, 0.0),
        (z2, 0.0),
        (touch, arc(touch, flank1, c1)),
        (flank1, 0.0),
        (flank2, arc(flank2, z8, c2)),
        (z8, 0),
    ]
    return Slot(half, arc(z8.conjugate(), z8), 1)


def _w16(place: Place, d: Sizes) -> Slot:
    """Round-shouldered, between parallel teeth of a rotor."""
    top, s, h = place.radius + place.way * d["H0"], place.way, place.half
    flat, low = top + s * d["R1"], d["W3"] / 2 + d["R1"]
    centre = place.from_tooth(math.sqrt(flat**2 - low**2) + 1j * low)
    z1, z2 = (r * cmath.exp(0.5j * d["W0"]) for r in (place.radius, top))
    z3, z4 = centre * top / abs(centre), centre + 1j * d["R1"] * cmath.exp(1j * h)
    deep = top + s * d["H2"]
    z5 = deep * cmath.exp(1j * (h - math.asin(d["W3"] / 2 / deep)))
    half = [(z1, 0.0), (z2, arc(z2, z3)), (z3, arc(z3, z4, centre)), (z4, 0.0), (z5, 0.0)]
    return Slot(half, arc(z5.conjugate(), z5), 2, True)


def _w22(place: Place, d: Sizes) -> Slot:
    """Along radii and circles."""
    top = place.radius + place.way * d["H0"]
    deep = top + place.way * d["H2"]
    z1, z2 = (r * cmath.exp(0.5j * d["W0"]) for r in (place.radius, top))
    z3, z4 = (r * cmath.exp(0.5j * d["W2"]) for r in (top, deep))
    return Slot([(z1, 0.0), (z2, arc(z2, z3)), (z3, 0.0), (z4, 0.0)], arc(z4.conjugate(), z4), 2, True)


def _w23(place: Place, d: Sizes) -> Slot:
    """Straight sides, or parallel teeth, and a bottom around the axis."""
    s, angle = place.way, cmath.phase(place.on_surface(d["W0"]))
    z1, z2 = (r * cmath.exp(1j * angle) for r in (place.radius, place.radius + s * d["H0"]))
    x3 = z2.real + s * d["H1"]
    if d.get("is_cstt_tooth"):
        z3 = place.beside_tooth(x3, d["W3"])
        z4 = z3 + s * d["H2"] * cmath.exp(1j * place.half)
    else:
        z3, rise = x3 + 0.5j * d["W1"], (d["W2"] - d["W1"]) / 2
        z4 = z3 + s * math.sqrt(d["H2"] ** 2 - rise**2) + 1j * rise
    return Slot([(z, 0.0) for z in (z1, z2, z3, z4)], arc(z4.conjugate(), z4), 2)


def _w24(place: Place, d: Sizes) -> Slot:
    """Open, between parallel teeth."""
    deep = place.radius + place.way * d["H2"]
    z1, z2 = (r * cmath.exp(1j * (place.half - math.asin(d["W3"] / 2 / r))) for r in (place.radius, deep))
    return Slot([(z1, 0.0), (z2, 0.0)], arc(z2.conjugate(), z2), 0, True)


def _w25(place: Place, d: Sizes) -> Slot:
    """Between teeth with parallel sides and wider tips."""
    t1 = place.on_surface(d["W4"])
    t2 = t1 + place.way * d["H1"]
    t3 = abs(t2) * cmath.exp(1j * math.asin(d["W3"] / 2 / abs(t2)))
    z1, z2, z3, z4 = (place.from_tooth(t) for t in (t1, t2, t3, t3 + place.way * d["H2"]))
    return Slot([(z1, 0.0), (z2, arc(z2, z3)), (z3, 0.0), (z4, 0.0)], arc(z4.conjugate(), z4), 2, True)


def _w26(place: Place, d: Sizes) -> Slot:
    """Two circles and their common tangents: bars of a cage."""
    s, z1 = place.way, place.on_surface(d["W0"])
    z2 = z1 + s * d["H0"]
    centre = z2.real + s * math.sqrt(d["R1"] ** 2 - d["W0"] ** 2 / 4)
    z3, z4 = centre + 1j * d["R1"], centre + s * d["H1"] + 1j * d["R2"]
    return Slot([(z1, 0.0), (z2, arc(z2, z3, centre)), (z3, 0.0), (z4, 0.0)], float(s), 1)


def _w28(place: Place, d: Sizes) -> Slot:
    """Between parallel teeth, with round shoulders and a round bottom."""
    s, z1 = place.way, place.on_surface(d["W0"])
    z2 = z1 + s * d["H0"]
    t2, low = place.from_tooth(z2), d["W3"] / 2 + d["R1"]
    t3 = t2.real + s * math.sqrt(d["R1"] ** 2 - (t2.imag - low) ** 2) + 0.5j * d["W3"]
    z3, z4, centre = (place.from_tooth(t) for t in (t3, t3 + s * d["H3"], t3.real + 1j * low))
    return Slot([(z1, 0.0), (z2, arc(z2, z3, centre)), (z3, 0.0), (z4, 0.0)], float(s), 2)


def _w30(place: Place, d: Sizes) -> Slot:
    """Between parallel teeth, flat under the tooth tips and at the bottom, with rounded corners."""
    s, z1, flank = place.way, place.on_surface(d["W0"]), 1j * cmath.exp(1j * place.half)
    z2 = z1 + s * d["H0"]
    (a, r), (b, q) = (
        (place.beside_tooth(x, d["W3"] + 2 * radius), radius)
        for x, radius in ((z2.real + s * d["R1"], d["R1"]), (z2.real + s * (d["H1"] - d["R2"]), d["R2"]))
    )
    z3, z4, z5, z6 = a - s * r, a + r * flank, b + q * flank, b + s * q
    half = [(z1, 0.0), (z2, 0.0), (z3, arc(z3, z4, a)), (z4, 0.0), (z5, arc(z5, z6, b)), (z6, 0.0)]
    return Slot(half, 0.0, 2)


def _double_cage(place: Place, d: Sizes) -> Slot:
    """A round bar over a deep one with a neck between them."""
    s, z1 = place.way, place.on_surface(d["W1"])
    c1, r1, r2 = z1.real + s * d["H1"], d["D1"] / 2, d["D2"] / 2
    c2, neck = c1 + s * d["H2"], d["W2"] / 2
    z2 = c1 - s * math.sqrt(r1**2 - d["W1"] ** 2 / 4) + 1j * z1.imag
    z3, z4 = (c + side * s * math.sqrt(r**2 - neck**2) + 1j * neck for c, side, r in ((c1, 1, r1), (c2, -1, r2)))
    z5, z6 = c2 + 1j * r2, c2 + s * d["H3"] + 1j * d["R3"]
    half = [(z1, 0.0), (z2, arc(z2, z3, c1)), (z3, 0.0), (z4, arc(z4, z5, c2)), (z5, 0.0), (z6, 0.0)]
    return Slot(half, float(s), 1)


def _lsrpm(place: Place, d: Sizes) -> Slot:
    """Open, between parallel teeth: a coil side along either tooth, with a rounded corner, behind a damper."""
    low, s, r = d["W3"] / 2, place.way, place.way * d["R1"]
    high = low + d["W1"]
    x = (place.radius + s * d["H2"] - high * math.sin(place.half)) / math.cos(place.half)
    z1 = math.sqrt(place.radius**2 - low**2) + 1j * low
    corners = (z1, z1 + s * d["H3"], x - r + 1j * low, x + 1j * (low + d["R1"]), x + 1j * high)
    a, b, c, e, f = (place.from_tooth(t) for t in corners)
    centre = place.from_tooth(x - r + 1j * (low + d["R1"]))
    return Slot([(a, 0.0), (b, 0.0), (c, arc(c, e, centre)), (e, 0.0), (f, 0.0)], 0.0, 1)


def _pole(place: Place, d: Sizes, shoe: list[Point], z5: complex, rest: list[Point]) -> Slot:
    """Between two salient poles: coils on either side of each, beside its body."""
    wide = (d["W1"] - d["W2"]) / 2 - d["W3"]
    a, b = shoe[-1][0] - d["H3"], z5 + d["H4"]
    coil = loop_through([place.from_tooth(t) for t in (a, b, b + 1j * wide, a + 1j * wide)])
    other = loop_through([place.from_tooth(t).conjugate() for t in (a, a + 1j * wide, b + 1j * wide, b)])
    half = [(place.from_tooth(t), -bulge) for t, bulge in [*shoe, (z5, 0.0), *rest]]
    return Slot(half, 0.0, 0, filling=(coil, other))


def _w60(place: Place, d: Sizes) -> Slot:
    """Salient poles with round tops."""
    centre = place.radius - d["R1"]
    z2 = centre + math.sqrt(d["R1"] ** 2 - d["W1"] ** 2 / 4) + 0.5j * d["W1"]
    z3 = z2 - d["H1"]
    z4 = z3.real + 0.5j * d["W2"]
    z5 = z4 - d["H2"]
    top = complex(place.radius)
    bottom = (z5.real / math.cos(place.half)) * cmath.exp(1j * place.half)
    return _pole(place, d, [(top, arc(top, z2, centre)), (z2, 0.0), (z3, 0.0), (z4, 0.0)], z5, [(bottom, 0.0)])


def _w61(place: Place, d: Sizes) -> Slot:
    """Salient poles with straight shoes."""
    z1 = place.on_surface(d["W0"])
    z2 = z1.real - d["H0"] + 0.5j * d["W1"]
    z3 = z2 - d["H1"]
    z4 = z3.real + 0.5j * d["W2"]
    return _pole(place, d, [(z1, 0.0), (z2, 0.0), (z3, 0.0), (z4, 0.0)], z4 - d["H2"], [])


CURVED: dict[str, Callable[[Place, Sizes], Slot]] = {
    "SlotW11": _w11,
    "SlotW12": _w12,
    "SlotW14": _w14,
    "SlotW15": _w15,
    "SlotW16": _w16,
    "SlotW22": _w22,
    "SlotW23": _w23,
    "SlotW24": _w24,
    "SlotW25": _w25,
    "SlotW26": _w26,
    "SlotW28": _w28,
    "SlotW30": _w30,
    "SlotDC": _double_cage,
    "SlotW60": _w60,
    "SlotW61": _w61,
    "SlotWLSRPM": _lsrpm,
}


def slot_of(kind: str, place: Place, sizes: Sizes) -> Slot:
    """The slot of a class.  kind : one of STEPS or CURVED; KeyError for a size that is not there."""
    if kind not in STEPS:
        return CURVED[kind](place, sizes)
    text, first = STEPS[kind]
    return Slot(_steps(place, sizes, text), 0.0, first)


def magnet_of(kind: str, place: Place, d: Sizes) -> Slot:
    """A magnet on the surface, or let into it: the cut in the iron and the magnet itself.  kind : one of MAGNETS"""
    s, rounded = -place.way, kind in ("SlotM11", "SlotM14", "SlotM15", "SlotM18")
    deep = 0.0 if kind == "SlotM18" else d["H0"]
    width = 2 * place.half if kind == "SlotM18" else d["Wmag"]
    if rounded:
        angle = width if kind == "SlotM18" else d["W0"]
        z1, z2 = (r * cmath.exp(0.5j * angle) for r in (place.radius, place.radius - s * deep))
        low = abs(z2)
        a = low * cmath.exp(1j * (math.asin(width / 2 / low) if kind == "SlotM15" else width / 2))
        bottom, foot = arc(z2.conjugate(), z2), arc(a.conjugate(), a)
    else:
        z1 = place.on_surface(d["W0"])
        z2 = z1 - s * deep
        low, a, bottom, foot = z2.real, z2.real + 0.5j * width, 0.0, 0.0
    b, centre = _magnet_top(kind, low, s, d["Hmag"], width, d)
    top = 0.0 if kind == "SlotM10" else arc(b, b.conjugate(), centre)
    magnet = loop_through([(a.conjugate(), foot), (a, 0.0), (b, top), (b.conjugate(), 0.0)])
    return Slot([(z1, 0.0), (z2, 0.0)], bottom, 0, filling=(magnet,))


def _magnet_top(kind: str, low: float, s: int, height: float, width: float, d: Sizes) -> tuple[complex, complex]:
    """The upper corner at the air gap, and the centre of the arc from it to the lower one."""
    high = low + s * height
    if kind in ("SlotM11", "SlotM18"):
        return high * cmath.exp(0.5j * width), 0.0
    if kind == "SlotM10":
        return high + 0.5j * width, 0.0
    if kind == "SlotM12":
        return high * cmath.exp(1j * math.asin(width / 2 / high)), 0.0
    centre = high - s * d["Rtopm"]
    if kind == "SlotM14":  # sides along radii: the ray at half the width meets the circle
        ray = cmath.exp(0.5j * width)
        along = centre * ray.real
        return ray * (along + s * math.sqrt(along**2 - centre**2 + d["Rtopm"] ** 2)), complex(centre)
    return centre + s * math.sqrt(d["Rtopm"] ** 2 - width**2 / 4) + 0.5j * width, complex(centre)


MAGNETS = ("SlotM10", "SlotM11", "SlotM12", "SlotM13", "SlotM14", "SlotM15", "SlotM18")
