"""What parts look like as they are described: outlines of their prisms, and sections of those that are round."""

from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import shapely
from shapely import Polygon

from thermoscope import plugin as th

SEGMENTS = 120  # of a full turn
RAYS = 40  # around the axis along which a part is looked at
ROUND = 0.02  # share of its volume by which a part may miss a body of revolution: bores, not fins
LONG = frozenset({th.Role.FOOT, th.Role.BASE, th.Role.SHAFT})  # what may reach far beyond the machine's body


@dataclass(frozen=True)
class Outlines:
    """The prisms of a machine as polygons (m), all on one grid."""

    machine: th.MachineDescription

    @cached_property
    def grid(self) -> th.ArcGrid:
        return th.ArcGrid([profile for part in self.machine.parts for profile, _, _ in part.prisms], SEGMENTS)

    def of(self, prism: th.Prism) -> Polygon:
        """An invalid outline (a fin of no width) is mended."""
        outline = prism[0].to_polygon(self.grid)
        return outline if outline.is_valid else max(_pieces(outline.buffer(0)), key=lambda p: p.area)

    def role(self, part: th.Part) -> th.Role | None:
        return part.identity.role if part.identity else None

    def parts(self, *roles: th.Role) -> list[th.Part]:
        return [part for part in self.machine.parts if self.role(part) in roles]

    @cached_property
    def middle(self) -> float:
        """Along the axis, of its body (m)."""
        spans = [part.span for part in self.machine.parts if self.role(part) not in LONG]
        return (min(a for a, _ in spans) + max(b for _, b in spans)) / 2

    def side(self, part: th.Part) -> int:
        """-1 left, 1 right of the machine's middle."""
        return 1 if sum(part.span) / 2 > self.middle else -1

    def section(self, part: th.Part) -> list[Polygon] | None:
        """Radius and place along the axis of a round part (m), None where it is not round.

        Small bores and cuts do not count: what most rays from the axis meet is the section, if its volume is right.
        """
        prisms = [(self.of(prism), *prism[1:]) for prism in part.prisms]
        sections = [_along(prisms, 2 * np.pi * (k + 0.37) / RAYS) for k in range(RAYS)]
        common = Counter(sections).most_common(1)[0][0]
        volume = sum(np.pi * (r1**2 - r0**2) * (z1 - z0) for r0, r1, z0, z1 in common)
        if abs(volume / part.volume - 1) > ROUND:
            return None
        return _pieces(shapely.union_all([shapely.box(r0, z0, r1, z1) for r0, r1, z0, z1 in common]))

    def reach(self, part: th.Part) -> float:
        """Largest distance from the axis (m)."""
        return max(float(np.hypot(*np.asarray(self.of(p).exterior.coords).T[:2]).max()) for p in part.prisms)


def _along(prisms: list[tuple[Polygon, float, float]], angle: float) -> tuple[tuple[float, float, float, float], ...]:
    """Where a ray from the axis is inside the prisms: from and to, radius and place (m), to a tenth of a millimetre."""
    out = []
    for outline, z0, z1 in prisms:
        x0, y0, x1, y1 = outline.bounds
        far = 2 * max(abs(x0), abs(y0), abs(x1), abs(y1))
        ray = shapely.LineString([(0, 0), (far * np.cos(angle), far * np.sin(angle))])
        for piece in _pieces(outline.intersection(ray)):
            r = np.hypot(*np.asarray(piece.coords).T)
            out.append((round(float(r.min()), 4), round(float(r.max()), 4), z0, z1))
    return tuple(sorted(out))


def _pieces(shape: Any) -> list[Any]:
    pieces = getattr(shape, "geoms", [shape])
    return [piece for piece in pieces if not piece.is_empty and piece.geom_type in ("Polygon", "LineString")]


def angle_of(outline: Polygon) -> float:
    """Of its centroid, about the axis (rad)."""
    return float(np.arctan2(outline.centroid.y, outline.centroid.x))


def radii_of(outline: Polygon) -> tuple[float, float]:
    """Smallest and largest distance of its corners from the axis (m)."""
    r = np.hypot(*np.asarray(outline.exterior.coords).T[:2])
    return float(r.min()), float(r.max())
