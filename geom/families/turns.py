"""Channels around the axis: the rings that are meshed, and the helix they stand for."""

from __future__ import annotations

import math
from dataclasses import dataclass

from geom.description.part import Helix

_END = 0.8  # of a rib: what a helix may take from the walls at its ends
CLEAR = 0.55  # of a port's bore: from its middle to the end of the channel, a tenth more than the bore needs


@dataclass(frozen=True)
class Turns:
    """Rings side by side, and the helix they stand for: the same pitch, width, ribs between turns, and volume.

    inner, top : radii of the channel;  first : where the first ring begins;  pitch, rib (m);  count
    A half plane through the axis cuts as much channel out of the helix as out of the rings. Where it begins and ends,
    the helix widens against the end walls; it takes up to `_END` of a rib from them and begins blunt.
    """

    inner: float
    top: float
    first: float
    pitch: float
    rib: float
    count: int

    @property
    def width(self) -> float:
        return self.pitch - self.rib

    @property
    def rings(self) -> list[tuple[float, float]]:
        """Axial range of each (m)."""
        starts = [self.first + i * self.pitch for i in range(self.count)]
        return [(start, start + self.width) for start in starts]

    @property
    def blunt(self) -> float:
        return min(self.width, math.sqrt((2 * _END - 1) * self.rib * self.width))

    @property
    def overhang(self) -> float:
        """What the helix takes of the wall at either end (m): with the blunt ends, what gives it the rings' volume."""
        return self.rib / 2 + self.blunt**2 / 2 / self.width

    def places(self, bore: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """Angle (rad) and z (m) of inlet and outlet: near the helix' ends, symmetric about the top."""
        (low, _), (_, high) = self.rings[0], self.rings[-1]
        spacing = math.pi * self._short(bore)
        return (math.pi / 2 + spacing, low + CLEAR * bore), (math.pi / 2 - spacing, high - CLEAR * bore)

    def _short(self, bore: float) -> float:
        """What the way from inlet to outlet lacks of the rings' turns."""
        return 2 * self._inward(bore) - (self.width - self.blunt) ** 2 / (self.width * self.pitch)

    def _inward(self, bore: float) -> float:
        """Turns from the blunt end to where the first ring's first edge has room for the bore."""
        return max(0.0, (2 * CLEAR * bore + self.overhang - self.blunt) / self.pitch)

    def helix(self, bore: float) -> Helix:
        start = self.places(bore)[0][0] - 2 * math.pi * self._inward(bore)
        bottom, top = self.first - self.overhang, self.rings[-1][1] + self.overhang
        return Helix(self.inner, self.top, bottom, top, self.pitch, self.width, self.blunt, start)
