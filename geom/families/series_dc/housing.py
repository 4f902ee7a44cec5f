"""Housing with fins or liquid jackets, their ports and coolant, flanges, bearings, feet and base."""

import math
from collections.abc import Sequence

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.part import CadShape, Part, Port, Prism, fluid
from geom.description.profile import Profile
from geom.description.roles import Role
from geom.families.channels import CLEAR, Nozzle, Turns, bored_circle, slices
from geom.families.series_dc.layout import Axial, Radii

Sector = tuple[float, float]  # angles (rad) at which a channel begins and ends


def enclosure(g: Geometry, z: Axial) -> tuple[Part, ...]:
    r = Radii(g)
    seat, shaft = g.bearing.outer_diameter / 2, g.shaft.bearing_diameter / 2
    flange, bearing = shapes.ring(seat, r.shell), shapes.ring(shaft, seat)
    left, right = (z.flange0, z.inner0), (z.inner1, z.flange1)
    top, middle = -g.feet.shaft_height, (z.inner0 + z.inner1) / 2
    plate = shapes.rectangle(-g.base.width / 2, g.base.width / 2, top - g.base.thickness, top)
    # With jackets the housing as it is made: round bores, and a helix for the rings.
    bored, helical = nozzles(g), g.jacket.layout == "helical"
    cad_shape = None
    if bored:
        helices = [turns_of(g, r, *span).helix(g.jacket.port) for span in z.jackets.values() if helical]
        cad_shape = CadShape(_walls(g, z, r, None if helical else ()), (*helices, *(nozzle.drill for nozzle in bored)))
    return (
        Part("housing", "aluminium-cast", _walls(g, z, r, bored), cad_shape=cad_shape, role=Role.HOUSING),
        Part("flange.left", "aluminium-cast", ((flange, *left),), role=Role.END_SHIELD),
        Part("flange.right", "aluminium-cast", ((flange, *right),), role=Role.END_SHIELD),
        Part("bearing.left", "bearing", ((bearing, *left),), role=Role.BEARING),
        Part("bearing.right", "bearing", ((bearing, *right),), role=Role.BEARING),
        Part("feet", "aluminium-cast", _feet(g, z, r), role=Role.FOOT),
        Part("base", "steel", ((plate, middle - g.base.length / 2, middle + g.base.length / 2),), role=Role.BASE),
        *(nozzle.part() for nozzle in nozzles(g)),
    )


def _walls(g: Geometry, z: Axial, r: Radii, bored: Sequence[Nozzle] | None) -> tuple[Prism, ...]:
    """The housing with bores, or for None without channels."""
    around = shapes.spread(g.housing.fins, math.pi / 2, g.housing.fin_spacing / r.shell)
    angles = [a for a in around if not _over_foot(g, r, a)]
    outside = shapes.finned_loop(r.shell, g.housing.fin_thickness, r.fins, angles) if angles else None
    finned = Profile(outside or shapes.circle_loop(r.shell), (shapes.circle_loop(r.yoke1),))
    prisms: list[Prism] = []
    here = z.inner0
    for name, (z0, z1) in z.jackets.items():
        prisms += [(finned, here, z0)] if here < z0 else []
        bores = None if bored is None else [nozzle for nozzle in bored if nozzle.jacket == name]
        prisms += [(shapes.ring(r.yoke1, r.jacket), z0, z1)] if bores is None else jacket_walls(g, r, z0, z1, bores)
        here = z1
    return (*prisms, (finned, here, z.inner1))


def _over_foot(g: Geometry, r: Radii, angle: float) -> bool:
    """A fin here would run into a foot, which is bounded by two vertical planes under the housing."""
    margin = 0.6 * g.housing.fin_thickness
    near, far = r.shell * abs(math.cos(angle)) - margin, r.fins * abs(math.cos(angle)) + margin
    return math.sin(angle) < 0 and near < g.feet.inner + g.feet.width and far > g.feet.inner


def _feet(g: Geometry, z: Axial, r: Radii) -> tuple[Prism, ...]:
    x0, x1 = g.feet.inner, g.feet.inner + g.feet.width
    y0, y1 = -shapes.on_circle(r.shell, x0), -shapes.on_circle(r.shell, x1)
    down = -g.feet.shaft_height
    sweep = math.acos(x0 / r.shell) - math.acos(x1 / r.shell)
    arc = shapes.bulge_of(sweep)
    right = Profile(((x0, down, 0.0), (x1, down, 0.0), (x1, y1, -arc), (x0, y0, 0.0)))
    left = Profile(((-x1, down, 0.0), (-x0, down, 0.0), (-x0, y0, -arc), (-x1, y1, 0.0)))
    near, far = z.inner0 + g.feet.inset, z.inner1 - g.feet.inset
    spans = ((near, near + g.feet.length), (far - g.feet.length, far))
    return tuple((foot, *span) for foot in (left, right) for span in spans)


def jacket_walls(g: Geometry, r: Radii, z0: float, z1: float, bored: Sequence[Nozzle]) -> list[Prism]:
    """The housing's wall around the channels of one jacket, with the bores of its ports."""
    if g.jacket.layout == "helical":
        return turns_of(g, r, z0, z1).walls(r.yoke1, r.jacket, z0, z1, bored)
    pierced = [
        (_pierced(r, sectors, ports), low, high)
        for sectors, a, b in _zigzag(g, r, z0, z1)
        for low, high, ports in slices(a, b, bored)
    ]
    solid = shapes.ring(r.yoke1, r.jacket)
    return [(solid, z0, z0 + g.jacket.rib), *pierced, (solid, z1 - g.jacket.rib, z1)]


def _pierced(r: Radii, sectors: list[Sector], bored: Sequence[Nozzle]) -> Profile:
    """Section of a zigzag jacket; a bore opens the channel under it."""
    inside = shapes.circle_loop(r.yoke1)
    under = [next(s for s in sectors if _spans(s, nozzle.angle)) for nozzle in bored]
    out = bored_circle(r.jacket, under, (r.shell, r.channel), bored) if bored else shapes.circle_loop(r.jacket)
    closed = (shapes.sector(r.shell, r.channel, *s).outer for s in sectors if s not in under)
    return Profile(out, (inside, *closed))


def _spans(sector: Sector, angle: float) -> bool:
    start, end = sector
    return (angle - start) % (2 * math.pi) < end - start


def _zigzag(g: Geometry, r: Radii, z0: float, z1: float) -> list[tuple[list[Sector], float, float]]:
    """Channels along the axis, straight first; then those joined in pairs at the left end, and at the right end."""
    first, last, n = z0 + g.jacket.rib, z1 - g.jacket.rib, g.jacket.channels
    turn = min(g.jacket.height, 0.3 * (z1 - z0 - 2 * g.jacket.rib))  # as deep as they are high, if there is room
    straight, left = [(i, i) for i in range(n)], [(i, min(i + 1, n - 1)) for i in range(0, n, 2)]
    right = [(0, 0), *((i, min(i + 1, n - 1)) for i in range(1, n, 2))]
    zones = ((straight, first + turn, last - turn), (left, first, first + turn), (right, last - turn, last))
    return [([_sector(g, r, *pair) for pair in pairs], a, b) for pairs, a, b in zones]


def _sector(g: Geometry, r: Radii, i: int, j: int) -> Sector:
    """From channel i to channel j, what lies between included."""
    half = math.pi / g.jacket.channels - g.jacket.rib / 2 / r.shell
    pitch, top = 2 * math.pi / g.jacket.channels, math.pi / 2
    return top + i * pitch - half, top + j * pitch + half


def turns_of(g: Geometry, r: Radii, z0: float, z1: float) -> Turns:
    """The turns of a helical jacket, ribs between and at both ends."""
    pitch = (z1 - z0 - g.jacket.rib) / g.jacket.turns
    return Turns(r.shell, r.channel, z0 + g.jacket.rib, pitch, g.jacket.rib, g.jacket.turns)


def coolant(g: Geometry, z: Axial) -> tuple[Part, ...]:
    """What flows in the jackets, one fluid each, to the ends of its ports."""
    r = Radii(g)
    out = []
    for name, span in z.jackets.items():
        zones = [] if g.jacket.layout == "helical" else _zigzag(g, r, *span)
        channels = [(shapes.sector(r.shell, r.channel, *s), a, b) for sectors, a, b in zones for s in sectors]
        flow = channels or turns_of(g, r, *span).liquid
        necks = [nozzle.neck for nozzle in nozzles(g) if nozzle.jacket == name]
        out.append(fluid(name, *flow, *necks, material="glycol-50", role=Role.COOLANT))
    return tuple(out)


def ports(g: Geometry) -> tuple[Port, ...]:
    """Inlet and outlet of every jacket, on its outer wall: first and last channel or turn."""
    return tuple(nozzle.port for nozzle in nozzles(g))


def nozzles(g: Geometry) -> tuple[Nozzle, ...]:
    """Inlet and outlet of every jacket."""
    r = Radii(g)
    return tuple(
        Nozzle(f"{name}.{end}", name, *place, g.jacket.port, r.channel, r.jacket)
        for name, span in Axial(g).jackets.items()
        for end, place in zip(("inlet", "outlet"), _places(g, r, *span))
    )


def _places(g: Geometry, r: Radii, z0: float, z1: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Angle (rad) and z (m) of inlet and outlet: where the first channel begins and the last ends."""
    if g.jacket.layout == "helical":
        return turns_of(g, r, z0, z1).places(g.jacket.port)
    top, n, inset = math.pi / 2, g.jacket.channels, g.jacket.rib + CLEAR * g.jacket.port
    return (top, z1 - inset), (top - 2 * math.pi / n, z1 - inset if n % 2 == 0 else z0 + inset)
