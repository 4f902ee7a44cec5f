"""A body: a closed surface, what it is made to look like, and the meshed part whose temperature it shows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

from extras.portraits.shape import Shape


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
