"""Bodies: closed surfaces, of revolution, extruded with rounded edges, or swept along a line; and how they look."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from thermoscope import plugin as th


@dataclass(frozen=True)
class Shape:
    """points : (n, 3) m;  triangles : (m, 3), seen from outside they turn anticlockwise"""

    points: th.Array
    triangles: th.Ints

    @property
    def volume(self) -> float:
        """Exact for the triangles (m3), by the divergence theorem."""
        a, b, c = self.points[self.triangles].transpose(1, 0, 2)
        return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6

    @property
    def closed(self) -> bool:
        """Does every edge belong to two triangles, once in each direction?"""
        edges = self.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        n = len(self.points)
        there, back = edges[:, 0] * n + edges[:, 1], edges[:, 1] * n + edges[:, 0]
        return len(np.unique(there)) == len(there) and bool(np.array_equal(np.sort(there), np.sort(back)))

    def moved(self, by: Sequence[float]) -> Shape:
        return Shape(self.points + np.asarray(by, float), self.triangles)

    def turned(self, angle: float) -> Shape:
        """About the machine's axis (rad, anticlockwise)."""
        c, s = np.cos(angle), np.sin(angle)
        return Shape(self.points @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]), self.triangles)

    def placed(self, x: Sequence[float], y: Sequence[float], z: Sequence[float], at: Sequence[float]) -> Shape:
        """With its own axes along three unit vectors, right-handed, and its origin `at` (m)."""
        return Shape(self.points @ np.array([x, y, z], float) + np.asarray(at, float), self.triangles)

    def outward(self, angle: float, radius: float, along: float) -> Shape:
        """Its own x around the machine's axis, y along it, z away from it, at an angle (rad) and a radius (m)."""
        c, s = np.cos(angle), np.sin(angle)
        return self.placed((-s, c, 0.0), (0.0, 0.0, 1.0), (c, s, 0.0), (radius * c, radius * s, along))

    def on_end(self, angle: float, radius: float, along: float, side: int) -> Shape:
        """Its own z along the machine's axis, forwards or (side -1) backwards, at an angle (rad) and a radius (m)."""
        shape = self.turned(angle).moved((radius * np.cos(angle), radius * np.sin(angle), 0.0))
        return (shape if side > 0 else shape.flipped()).moved((0.0, 0.0, along))

    def mirrored(self) -> Shape:
        """Seen in the plane x = 0 as in a mirror."""
        return Shape(self.points * [-1.0, 1.0, 1.0], self.triangles[:, ::-1])

    def flipped(self) -> Shape:
        """Seen in the plane z = 0 as in a mirror."""
        return Shape(self.points * [1.0, 1.0, -1.0], self.triangles[:, ::-1])


def joined(shapes: Sequence[Shape]) -> Shape:
    """Several as one; they may overlap."""
    starts = np.cumsum([0, *(len(s.points) for s in shapes)])
    return Shape(
        np.concatenate([s.points for s in shapes]),
        np.concatenate([s.triangles + i for s, i in zip(shapes, starts, strict=False)]),
    )


class Finish(Enum):
    """Colour of the outside, of a section through it, and how much it shines (specular share, sharpness)."""

    PAINT = ("#4f7fa3", "#c3d2de", 0.35, 25)
    CAST = ("#b4bdc3", "#d3dade", 0.25, 12)
    STEEL = ("#a3abb3", "#c4cad0", 0.60, 40)
    LAMINATIONS = ("#8995a3", "#a9b4bf", 0.15, 8)
    ROTOR = ("#71839a", "#97a8bc", 0.15, 8)
    COPPER = ("#c8713a", "#e39a66", 0.45, 25)
    INSULATION = ("#e5cd7d", "#efdf9f", 0.10, 5)
    BRASS = ("#c9a54c", "#dfc37c", 0.50, 30)
    CARBON = ("#33373c", "#5a5f66", 0.10, 5)
    MAGNET = ("#3a4a63", "#5b77a5", 0.40, 30)
    RUBBER = ("#2c3035", "#4d535a", 0.15, 8)
    PLATE = ("#8b939b", "#a9b0b7", 0.15, 10)

    @property
    def colour(self) -> str:
        return str(self.value[0])

    @property
    def section(self) -> str:
        return str(self.value[1])

    @property
    def shine(self) -> tuple[float, float]:
        return float(self.value[2]), float(self.value[3])


@dataclass(frozen=True)
class Body:
    """part : the meshed part that it stands for, or sits on

    added : only in pictures: the mesh has no such thing;  whole : never cut open, but left out where a cut would be
    """

    part: str
    finish: Finish
    shape: Shape
    added: bool = False
    whole: bool = False

    def on(self, part: str) -> Body:
        return replace(self, part=part)
