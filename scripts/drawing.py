"""A dimensioned drawing of a machine (SVG): cross-section and section along the axis, from the same profiles."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from html import escape

from geom.description.geometry import Geometry
from geom.description.machine import Machine
from geom.description.part import Part
from geom.description.roles import Role
from geom.drawings.views import Views, fill, middle_level

mm = 1e3
_THIN = 'stroke="#777" stroke-width="0.5"'


@dataclass(frozen=True)
class Pen:
    """Draws dimension lines; unit : height of the text (mm)."""

    unit: float

    def level(self, x0: float, x1: float, y: float, top: float, text: str) -> str:
        """A horizontal dimension at y, its ends carried down from `top`."""
        ends = "".join(f"M{x:.1f} {top:.1f}V{y + 0.3 * self.unit:.1f}" for x in (x0, x1))
        return f'<path d="{ends}" {_THIN}/>{self._line(f"M{x0:.1f} {y:.1f}H{x1:.1f}")}' + self.text(
            (x0 + x1) / 2, y - 0.3 * self.unit, text, "middle"
        )

    def upright(self, y0: float, y1: float, x: float, left: float, text: str) -> str:
        """A vertical dimension at x, its ends carried over from `left`."""
        ends = "".join(f"M{left:.1f} {y:.1f}H{x + 0.3 * self.unit:.1f}" for y in (y0, y1))
        place = f'transform="translate({x - 0.3 * self.unit:.1f} {(y0 + y1) / 2:.1f}) rotate(-90)"'
        return (
            f'<path d="{ends}" {_THIN}/>{self._line(f"M{x:.1f} {y0:.1f}V{y1:.1f}")}'
            f'<text {place} text-anchor="middle">{escape(text)}</text>'
        )

    def text(self, x: float, y: float, text: str, anchor: str = "start") -> str:
        return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(text)}</text>'

    def _line(self, d: str) -> str:
        return f'<path d="{d}" stroke="black" stroke-width="0.7" marker-start="url(#tip)" marker-end="url(#tip)"/>'


def drawing_of(machine: Machine, at_z: float | None = None) -> str:
    """SVG text; the cross-section is cut at at_z (m), the middle of the machine if None.

    Left: section normal to the axis. Right: section along the axis, x = 0. Dimensions in mm; a legend of materials.
    """
    views = Views(machine, middle_level(machine) if at_z is None else at_z)
    z0, z1 = views.span
    low, high = views.heights
    unit = max(views.width + z1 - z0, high - low) / 65
    pen, gap = Pen(unit), (2 * len(diameters(machine)) + 6) * unit
    shift = views.width / 2 + gap - z0
    body = [
        *views.across(),
        f'<g transform="translate({shift:.1f} 0)">',
        *views.along(),
        *_along(machine, views, pen),
        "</g>",
        pen.level(-views.width / 2, views.width / 2, 2.2 * unit - low, -low, f"{views.width:.0f}"),
        pen.upright(-high, -low, views.width / 2 + 2 * unit, views.width / 2, f"{high - low:.0f}"),
    ]
    left, top, bottom = -views.width / 2 - 2 * unit, -high - 2 * unit, -low + (2.2 * len(lengths(machine)) + 2) * unit
    legend = list(_legend(machine, views, pen, left + 2 * unit, bottom))
    width, height = views.width + gap + z1 - z0 + 5 * unit, bottom + 1.6 * unit * len(legend) - top
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{left:.1f} {top:.1f} {width:.1f} {height:.1f}" '
            f'font-family="sans-serif" font-size="{unit:.1f}">',
            f"<title>{escape(machine.name)}: section at z = {views.z * mm:.0f} mm, and along the axis; mm</title>",
            '<marker id="tip" viewBox="-10 -3 10 6" markerWidth="9" markerHeight="5" orient="auto-start-reverse">'
            '<path d="M-10 -2.5L0 0L-10 2.5Z"/></marker>',
            f'<rect x="{left:.1f}" y="{top:.1f}" width="100%" height="100%" fill="white"/>',
            *body,
            *legend,
            "</svg>\n",
        ]
    )


def _along(machine: Machine, views: Views, pen: Pen) -> Iterator[str]:
    """Dimensions of the section along the axis: diameters to its left, lengths below."""
    low, (z0, _) = views.heights[0], views.span
    for i, (word, diameter) in enumerate(diameters(machine)):
        r, x = diameter * mm / 2, z0 - (1.5 + 2 * i) * pen.unit
        yield pen.upright(-r, r, x, z0, f"{word} \N{DIAMETER SIGN} {diameter * mm:.4g}")
    for i, (word, a, b) in enumerate(lengths(machine)):
        yield pen.level(a * mm, b * mm, -low + 2.2 * (i + 1) * pen.unit, -low, f"{word} {(b - a) * mm:.4g}")


def _legend(machine: Machine, views: Views, pen: Pen, x: float, y: float) -> Iterator[str]:
    """What is counted, then every material with its parts."""
    by_material: dict[str, list[str]] = {}
    for part in views.parts:
        by_material.setdefault(part.material, []).append(part.name)
    rows = [
        ("", counts(machine)),
        *((material, f"{material}: {', '.join(names)}") for material, names in by_material.items()),
    ]
    for i, (material, text) in enumerate(row for row in rows if row[1]):
        at = y + 1.6 * pen.unit * i
        box = f'<rect x="{x:.1f}" y="{at:.1f}" width="{1.6 * pen.unit:.1f}" height="{pen.unit:.1f}" stroke="#333" '
        swatch = f'{box}stroke-width="0.4" fill="{fill(material)}"/>' if material else ""
        yield swatch + pen.text(x + (2.2 * pen.unit if material else 0), at + 0.85 * pen.unit, text)


Diameter = tuple[str, float]  # what, m
Length = tuple[str, float, float]  # what, from, to (m)


def diameters(machine: Machine) -> list[Diameter]:
    """Round things, smallest first."""
    parts = {part.name: part for part in machine.parts}
    word_of = {
        "shaft": "shaft",
        "bearing.left": "bearing",
        "rotor.core": "rotor",
        "yoke": "yoke",
        "stator.core": "laminations",
    }
    profiles = {word: [p for p, _, _ in parts[name].prisms] for name, word in word_of.items() if name in parts}
    by_word = {w: 2 * max(math.hypot(x, y) for p in of for x, y, _ in p.outer) for w, of in profiles.items()}
    if "rotor" in by_word and (stator := getattr(machine.geometry, "stator", None)):
        by_word["bore"] = by_word["rotor"] + 2 * stator.air_gap
    return sorted(by_word.items(), key=lambda d: d[1])


def lengths(machine: Machine) -> list[Length]:
    """Along the axis, shortest first: stack, over the end windings, over the end-caps, overall."""
    words = {"stack": Role.ROTOR, "end windings": Role.WINDING, "end-caps": Role.END_SHIELD}
    spans = {word: _span([p for p in machine.parts if p.role is role]) for word, role in words.items()}
    spans["overall"] = _span(list(machine.parts))
    measures = [(word, *span) for word, span in spans.items() if span is not None]
    return sorted(measures, key=lambda length: length[2] - length[1])


def counts(machine: Machine) -> str:
    """Slots, poles, bars, fins and the air gap in words."""
    return ", ".join(_counted(machine.geometry))


def _counted(g: Geometry | None) -> Iterator[str]:
    if g is None:
        return
    for group in ("stator", "rotor", "commutator", "housing"):
        for key in ("slots", "poles", "bars", "ducts", "fins"):
            number = getattr(getattr(g, group, None), key, 0)
            if number and (key != "fins" or getattr(g.housing, "kind", "axial-fins").endswith("fins")):
                yield f"{number} {'commutator ' if group == 'commutator' else ''}{key}"
    if hasattr(g, "stator"):
        yield f"air gap {g.stator.air_gap * 1e3:g} mm"


def _span(parts: list[Part]) -> tuple[float, float] | None:
    if not parts:
        return None
    return min(p.span[0] for p in parts), max(p.span[1] for p in parts)
