"""The two sections of a machine as SVG shapes (mm, y downwards), from the profiles that are meshed."""

import math
from dataclasses import dataclass
from functools import cached_property
from html import escape
from typing import Any

from geom.description.machine import Machine
from geom.description.materials import colour
from geom.description.part import Part
from geom.description.profile import ArcGrid, Loop, Profile, edges
from geom.description.roles import Role

mm = 1e3
_ASIDE = 7e-4  # m; the section along the axis runs beside the mica between two bars, and within a fin


@dataclass(frozen=True)
class Views:
    """Left a section normal to the axis at z (m), right one along the axis, x = 0.

    Liquids are drawn like parts. What neither section cuts, such as feet, is drawn behind both.
    """

    machine: Machine
    z: float

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        return (*self.machine.parts, *(f for f in self.machine.fluids if f.material != "air" and f.prisms))

    @cached_property
    def air(self) -> list[Part]:
        """Spaces inside, which hide what is behind them."""
        return [part for part in self.machine.fluids if part.material == "air" and part.prisms]

    @cached_property
    def uncut(self) -> list[Part]:
        cut = {part.name for part in self.parts if self._here(part) or self._rectangles(part)}
        return [part for part in self.parts if part.name not in cut]

    @cached_property
    def width(self) -> float:
        return self.machine.extent[1] * mm

    @cached_property
    def span(self) -> tuple[float, float]:
        """Ends along the axis (mm)."""
        spans = [part.span for part in self.machine.parts]
        return min(a for a, _ in spans) * mm, max(b for _, b in spans) * mm

    @cached_property
    def heights(self) -> tuple[float, float]:
        """Lowest and highest point (mm, upwards)."""
        bounds = [polygon.bounds for polygon in self._polygons.values()]
        tops = [b for part in self.parts for _, _, _, b in self._rectangles(part)]
        return min(b[1] for b in bounds) * mm, max(*(b[3] * mm for b in bounds), *tops)

    def across(self) -> list[str]:
        """The section normal to the axis."""
        far = [
            _shape(part, " ".join(path(loop) for p, *_ in part.prisms for loop in p.loops), True) for part in self.uncut
        ]
        near = [_shape(part, " ".join(path(loop) for loop in p.loops)) for part in self.parts for p in self._here(part)]
        return far + [_air(path(p.outer)) for part in self.air for p in self._here(part)] + near

    def along(self) -> list[str]:
        """The section along the axis."""
        import shapely

        far = [_shape(part, _outline(shapely.union_all(self._shadows(part))), True) for part in self.uncut]
        boxes = {part: [shapely.box(*sides) for sides in self._rectangles(part)] for part in self.parts}
        air = [_air(_outline(shapely.box(*sides))) for part in self.air for sides in self._rectangles(part)]
        return far + air + [_shape(part, _outline(shapely.union_all(cut))) for part, cut in boxes.items() if cut]

    def _here(self, part: Part) -> list[Profile]:
        return [profile for profile, z0, z1 in part.prisms if z0 <= self.z < z1]

    def _rectangles(self, part: Part) -> list[tuple[float, float, float, float]]:
        """z0, y0, z1, y1 (mm) of each piece that the plane along the axis cuts out of the part."""
        return [(z0 * mm, a * mm, z1 * mm, b * mm) for profile, z0, z1 in part.prisms for a, b in self._cuts[profile]]

    def _shadows(self, part: Part) -> list[Any]:
        import shapely

        bounds = [(self._polygons[profile].bounds, z0, z1) for profile, z0, z1 in part.prisms]
        return [shapely.box(z0 * mm, b[1] * mm, z1 * mm, b[3] * mm) for b, z0, z1 in bounds]

    @cached_property
    def _polygons(self) -> dict[Profile, Any]:
        profiles = list(dict.fromkeys(profile for part in (*self.parts, *self.air) for profile, _, _ in part.prisms))
        grid = ArcGrid(profiles, 180)
        return {profile: profile.to_polygon(grid) for profile in profiles}

    @cached_property
    def _cuts(self) -> dict[Profile, list[tuple[float, float]]]:
        """Intervals of y (m) that the plane along the axis cuts out of each profile."""
        import shapely

        knife = shapely.LineString([(_ASIDE, -10.0), (_ASIDE, 10.0)])
        cuts = {p: shapely.get_parts(polygon.intersection(knife)) for p, polygon in self._polygons.items()}
        return {p: [(c.bounds[1], c.bounds[3]) for c in pieces if c.length] for p, pieces in cuts.items()}


def middle_level(machine: Machine) -> float:
    """Where to cut across (m): in the middle of the rotor's stack, or of the machine."""
    spans = [p.span for p in machine.parts if p.role is Role.ROTOR] or [p.span for p in machine.parts]
    return (min(a for a, _ in spans) + max(b for _, b in spans)) / 2


def path(loop: Loop) -> str:
    """SVG path of a loop in mm, arcs exact, y upwards."""
    corners = [(x * mm, -y * mm) for x, y, _ in loop]
    text = [f"M{corners[0][0]:.2f} {corners[0][1]:.2f}"]
    for (x, y), (_, arc) in zip([*corners[1:], corners[0]], edges(loop)):
        if arc is None:
            text.append(f"L{x:.2f} {y:.2f}")
        else:
            flags = f"{int(abs(arc.sweep) > math.pi)} {int(arc.sweep < 0)}"
            text.append(f"A{arc.radius * mm:.2f} {arc.radius * mm:.2f} 0 {flags} {x:.2f} {y:.2f}")
    return "".join(text) + "Z"


def _outline(region: Any) -> str:
    """SVG path of a shapely region (mm, y upwards)."""
    import shapely

    rings = shapely.get_rings(shapely.get_parts(shapely.set_precision(region, 1e-3)))
    return " ".join("M" + "L".join(f"{x:.2f} {-y:.2f}" for x, y in ring.coords[:-1]) + "Z" for ring in rings)


def _shape(part: Part, d: str, uncut: bool = False) -> str:
    look = ' opacity="0.35" stroke-dasharray="3 2"' if uncut else ""
    style = f'fill="{fill(part.material)}" fill-rule="evenodd" stroke="#333" stroke-width="0.4"{look}'
    return f'<path d="{d}" {style}><title>{escape(part.name)}</title></path>'


def _air(d: str) -> str:
    return f'<path d="{d}" fill="white"/>'


def fill(material: str) -> str:
    rgb = ",".join(str(round(255 * value)) for value in colour(material))
    return f"rgb({rgb})"
