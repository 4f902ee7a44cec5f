"""A dimensioned drawing of a machine (SVG): cross-section and section along the axis, from the same profiles."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

from geom.palette import colour
from geom.profile import ArcGrid, Loop, edges

if TYPE_CHECKING:
    from geom.machine import Machine

MARGIN = 60.0  # mm around and between the two views


@dataclass(frozen=True)
class Box:
    """Extent of a view (mm)."""

    x0: float
    y0: float
    x1: float
    y1: float


def drawing_of(machine: Machine, at_z: float | None = None) -> str:
    """SVG text; the cross-section is cut at at_z (m), the middle of the machine if None.

    Left: section normal to the axis. Right: section along the axis, x = 0. Dimensions in mm.
    """
    spans = [part.span for part in machine.parts]
    z0, z1 = min(a for a, _ in spans) * 1e3, max(b for _, b in spans) * 1e3
    where = (z0 + z1) / 2e3 if at_z is None else at_z
    _, across, _ = machine.extent
    low, high = _heights(machine)
    front = Box(-across * 500, low, across * 500, high)
    shift = front.x1 + 2 * MARGIN - z0
    width, height = shift + z1 + MARGIN - front.x0 + MARGIN, high - low + 2 * MARGIN
    body = [
        *_cross_section(machine, where),
        f'<g transform="translate({shift:.2f} 0)">',
        *_axial_section(machine),
        "</g>",
    ]
    body += [*_dimensions(front), *_dimensions(Box(shift + z0, low, shift + z1, high))]
    view = f"{front.x0 - MARGIN:.1f} {-high - MARGIN:.1f} {width:.1f} {height:.1f}"
    return "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{view}" font-family="sans-serif" font-size="16">',
        f"<title>{escape(machine.name)}: section at z = {where * 1e3:.0f} mm, and along the axis; mm</title>",
        '<rect x="-100%" y="-100%" width="300%" height="300%" fill="white"/>',
        *body,
        "</svg>\n",
    ])  # fmt: skip


def thumbnail_of(machine: Machine) -> str:
    """A small SVG of the section across the axis and the section along it, without dimensions."""
    spans = [part.span for part in machine.parts]
    z0, z1 = min(a for a, _ in spans) * 1e3, max(b for _, b in spans) * 1e3
    low, high = _heights(machine)
    across = machine.extent[1] * 1e3
    gap = 0.08 * across
    view = f"{-across / 2:.1f} {-high:.1f} {across + gap + z1 - z0:.1f} {high - low:.1f}"
    body = [*_cross_section(machine, (z0 + z1) / 2e3), f'<g transform="translate({across / 2 + gap - z0:.1f} 0)">']
    text = "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{view}" width="320" height="160">',
        f"<title>{escape(machine.name)}</title>",
        *body,
        *_axial_section(machine),
        "</g>",
        "</svg>\n",
    ])  # fmt: skip
    return re.sub(r"(\.\d)\d+", r"\1", text)


def _heights(machine: Machine) -> tuple[float, float]:
    ys = [y * 1e3 for _, _, _, spans in _bars(machine) for pair in spans for y in pair]
    profiles = [profile for part in machine.parts for profile, _, _ in part.prisms]
    grid = ArcGrid(profiles, 72)
    bounds = [profile.to_polygon(grid).bounds for profile in profiles]
    return min([*ys, *(b[1] * 1e3 for b in bounds)]), max([*ys, *(b[3] * 1e3 for b in bounds)])


def _cross_section(machine: Machine, z: float) -> list[str]:
    return [
        _shape(part.name, part.material, " ".join(path(loop) for loop in profile.loops))
        for part in machine.parts
        for profile, z0, z1 in part.prisms
        if z0 <= z < z1
    ]


def path(loop: Loop) -> str:
    """SVG path of a loop in mm, arcs exact, y upwards."""
    corners = [(x * 1e3, -y * 1e3) for x, y, _ in loop]
    text = [f"M{corners[0][0]:.3f} {corners[0][1]:.3f}"]
    for (x, y), (_, arc) in zip([*corners[1:], corners[0]], edges(loop)):
        if arc is None:
            text.append(f"L{x:.3f} {y:.3f}")
        else:
            flags = f"{int(abs(arc.sweep) > math.pi)} {int(arc.sweep < 0)}"
            text.append(f"A{arc.radius * 1e3:.3f} {arc.radius * 1e3:.3f} 0 {flags} {x:.3f} {y:.3f}")
    return "".join(text) + "Z"


def _axial_section(machine: Machine) -> list[str]:
    return [
        _shape(name, material, f"M{z0 * 1e3:.2f} {-b * 1e3:.2f}H{z1 * 1e3:.2f}V{-a * 1e3:.2f}H{z0 * 1e3:.2f}Z")
        for name, material, (z0, z1), spans in _bars(machine)
        for a, b in spans
    ]


def _bars(machine: Machine) -> list[tuple[str, str, tuple[float, float], list[tuple[float, float]]]]:
    """Name, material, axial range and the intervals of y that each prism takes in the plane x = 0 (m)."""
    import shapely

    profiles = list(dict.fromkeys(profile for part in machine.parts for profile, _, _ in part.prisms))
    grid, knife = ArcGrid(profiles, 180), shapely.LineString([(1e-7, -10.0), (1e-7, 10.0)])
    cuts = {profile: shapely.get_parts(profile.to_polygon(grid).intersection(knife)) for profile in profiles}
    return [
        (part.name, part.material, (z0, z1), [(cut.bounds[1], cut.bounds[3]) for cut in cuts[profile] if cut.length])
        for part in machine.parts
        for profile, z0, z1 in part.prisms
    ]


def _shape(name: str, material: str, d: str) -> str:
    rgb = ",".join(str(round(255 * value)) for value in colour(material))
    style = f'fill="rgb({rgb})" fill-rule="evenodd" stroke="#333" stroke-width="0.4"'
    return f'<path d="{d}" {style}><title>{escape(name)}</title></path>'


def _dimensions(box: Box) -> list[str]:
    """Width below and height beside a view."""
    below, beside = -box.y0 + MARGIN / 2, box.x1 + MARGIN / 3
    middle = ((box.x0 + box.x1) / 2, -(box.y0 + box.y1) / 2)
    across = f'<path d="M{box.x0:.1f} {below:.1f}H{box.x1:.1f}" stroke="black"/>'
    up = f'<path d="M{beside:.1f} {-box.y0:.1f}V{-box.y1:.1f}" stroke="black"/>'
    return [
        across,
        f'<text x="{middle[0]:.1f}" y="{below - 4:.1f}" text-anchor="middle">{box.x1 - box.x0:.0f}</text>',
        up,
        f'<text transform="translate({beside - 4:.1f} {middle[1]:.1f}) rotate(-90)" text-anchor="middle">'
        f"{box.y1 - box.y0:.0f}</text>",
    ]
