"""Channels around the axis: the rings that are meshed, and the helix they stand for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from geom.description import shapes
from geom.description.part import Helix, Prism
from geom.families.nozzles import Nozzle, bored_ring, slices

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
    def liquid(self) -> list[Prism]:
        """What flows in them."""
        return [(shapes.ring(self.inner, self.top), *span) for span in self.rings]

    def walls(self, inner: float, outer: float, z0: float, z1: float, bored: Sequence[Nozzle]) -> list[Prism]:
        """A wall between two radii and two levels (m) around the rings, with the bores of its ports."""
        ends = [z0, *(z for ring in self.rings for z in ring), z1]
        ribs = [(shapes.ring(inner, outer), a, b) for a, b in zip(ends[::2], ends[1::2])]
        inside = [(shapes.ring(inner, self.inner), *span) for span in self.rings]
        outside = [
            (piece, low, high)
            for a, b in self.rings
            for low, high, ports in slices(a, b, bored)
            for piece in bored_ring(self.top, outer, ports)
        ]
        return [*ribs, *inside, *outside]

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
