"""Liquid jackets of every family: channels around the axis, as rings and as helices, and ports with their bores."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from geom.description import shapes
from geom.description.part import CadShape, Helix, Part, Port, Prism, Rod
from geom.description.profile import Loop, Profile, Vertex
from geom.description.roles import Role

TUBE = 1.5  # outer diameter, and length, of a port over its bore
_THIN = 1e-6  # m; a bore's end nearer than this to another level is there
_END = 0.8  # of a rib: what a helix may take from the walls at its ends
CLEAR = 0.55  # of a port's bore: from its middle to the end of the channel, a tenth more than the bore needs


@dataclass(frozen=True)
class Nozzle:
    """A port: a tube on the outer wall, radially out, and the bore through the wall.

    angle (rad), z, bore (m); channel, wall : radii of the wall's sides (m)
    The tube is round as it is made; as prisms it and its bore are square, of the same cross-sections.
    """

    name: str
    jacket: str
    angle: float
    z: float
    bore: float
    channel: float
    wall: float

    @property
    def side(self) -> float:
        """Of the square bore (m)."""
        return self.bore * math.sqrt(math.pi) / 2

    @property
    def tip(self) -> float:
        return self.wall + TUBE * self.bore

    @property
    def span(self) -> tuple[float, float]:
        """Axial extent of the square bore (m)."""
        return self.z - self.side / 2, self.z + self.side / 2

    @property
    def port(self) -> Port:
        x, y = self.wall * math.cos(self.angle), self.wall * math.sin(self.angle)
        return Port(self.name, self.jacket, (x, y, self.z))

    @property
    def neck(self) -> Prism:
        """The liquid in the bore."""
        bar = Profile(shapes.bar_loop(self.channel, self.tip, self.side))
        return bar.rotated(self.angle), *self.span

    @property
    def drill(self) -> Rod:
        """The round bore, through wall and tube."""
        middle, wall = (self.channel + self.wall) / 2, self.wall - self.channel
        return Rod(self.angle, self.z, middle - 0.6 * wall, self.tip + 0.001, self.bore)

    def part(self, material: str = "aluminium-cast") -> Part:
        half, out = self.side / 2, TUBE * self.side / 2
        low, high = self.span
        whole = Profile(shapes.strip_loop(self.wall, self.tip, -out, out)).rotated(self.angle)
        strips = (shapes.strip_loop(self.wall, self.tip, *y) for y in ((-out, -half), (half, out)))
        sides = [Profile(strip).rotated(self.angle) for strip in strips]
        prisms = ((whole, self.z - out, low), *((side, low, high) for side in sides), (whole, high, self.z + out))
        return Part(f"{self.name}.tube", material, prisms, cad_shape=self._tube(), role=Role.HOUSING)

    def _tube(self) -> CadShape:
        inside = (shapes.disc(self.wall), self.z - self.bore, self.z + self.bore)
        return CadShape(Rod(self.angle, self.z, 0.9 * self.wall, self.tip, TUBE * self.bore), (self.drill, inside))


def bored_ring(inner: float, outer: float, bored: Sequence[Nozzle]) -> list[Profile]:
    """What gaps as wide as the bores leave of a ring."""
    if not bored:
        return [shapes.ring(inner, outer)]
    ways = sorted(bored, key=lambda n: n.angle)
    return [_between(inner, outer, a, b) for a, b in zip(ways, [*ways[1:], ways[0]])]


def _between(inner: float, outer: float, here: Nozzle, following: Nozzle) -> Profile:
    """The ring from one gap, anticlockwise, to the next; each arc in two, as it may be longer than half a turn."""
    (a, b), (p, q) = (
        [n.angle + s * math.asin(n.side / 2 / r) for n, s in ((here, 1), (following, -1))] for r in (outer, inner)
    )
    out, back = ((end - start) % (2 * math.pi) / 2 for start, end in ((a, b), (p, q)))
    far, near = shapes.bulge_of(out), shapes.bulge_of(-back)
    polar = shapes.polar
    outside = (polar(outer, a, far), polar(outer, a + out, far), polar(outer, b))
    return Profile((*outside, polar(inner, q, near), polar(inner, q - back, near), polar(inner, p)))


def bored_circle(
    outer: float, sectors: Sequence[tuple[float, float]], radii: tuple[float, float], bored: Sequence[Nozzle]
) -> Loop:
    """The circle `outer` with a way in to each channel: sectors (rad) between two radii, the one under each nozzle."""
    ways = sorted(zip(bored, sectors, strict=True), key=lambda way: way[0].angle)
    loops = [_way(outer, radii, *way) for way in ways]
    ends = [(n.angle + s * math.asin(n.side / 2 / outer)) for n, _ in ways for s in (-1, 1)]
    out: list[Vertex] = []
    for i, loop in enumerate(loops):
        here, following = ends[2 * i + 1], ends[(2 * i + 2) % len(ends)]
        half = (following - here) % (2 * math.pi) / 2
        arc = shapes.bulge_of(half)
        out += [*loop, shapes.polar(outer, here, arc), shapes.polar(outer, here + half, arc)]
    return tuple(out)


def _way(outer: float, radii: tuple[float, float], nozzle: Nozzle, sector: tuple[float, float]) -> Loop:
    """From the circle at one side of the bore around the channel to the other side, which is left out."""
    inner, top = radii
    at, half = nozzle.angle, nozzle.side / 2
    a, b = math.asin(half / outer), math.asin(half / top)
    low = at - (at - sector[0]) % (2 * math.pi)
    high = low + sector[1] - sector[0]
    return (
        shapes.polar(outer, at - a),
        shapes.polar(top, at - b, shapes.bulge_of(low - at + b)),
        shapes.polar(top, low),
        shapes.polar(inner, low, shapes.bulge_of(high - low)),
        shapes.polar(inner, high),
        shapes.polar(top, high, shapes.bulge_of(at + b - high)),
        shapes.polar(top, at + b),
    )


def slices(z0: float, z1: float, nozzles: Sequence[Nozzle]) -> list[tuple[float, float, tuple[Nozzle, ...]]]:
    """The axial range cut at the bores; with each piece the nozzles that open it."""
    cuts = sorted({z0, z1, *(z for n in nozzles for z in n.span if z0 + _THIN < z < z1 - _THIN)})
    return [(a, b, tuple(n for n in nozzles if n.span[0] < (a + b) / 2 < n.span[1])) for a, b in pairwise(cuts)]


def too_near(nozzles: Sequence[Nozzle]) -> bool:
    """Whether tubes of two ports meet."""
    points = [n.port.position for n in nozzles]
    return any(math.dist(a, b) < 1.1 * TUBE * nozzles[0].bore for i, a in enumerate(points) for b in points[:i])


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
        spacing = math.pi * (2 * self._inward(bore) - (self.width - self.blunt) ** 2 / (self.width * self.pitch))
        return (math.pi / 2 + spacing, low + CLEAR * bore), (math.pi / 2 - spacing, high - CLEAR * bore)

    def _inward(self, bore: float) -> float:
        """Turns from the blunt end to where the first ring's first edge has room for the bore."""
        return max(0.0, (2 * CLEAR * bore + self.overhang - self.blunt) / self.pitch)

    def helix(self, bore: float) -> Helix:
        start = self.places(bore)[0][0] - 2 * math.pi * self._inward(bore)
        bottom, top = self.first - self.overhang, self.rings[-1][1] + self.overhang
        return Helix(self.inner, self.top, bottom, top, self.pitch, self.width, self.blunt, start)
