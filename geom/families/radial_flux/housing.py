"""End-caps, bearings, housing, foot and base."""

import math

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.part import CadShape, Part, Port, Prism, fluid
from geom.description.profile import Profile
from geom.description.roles import Role
from geom.families.channels import Nozzle, Turns
from geom.families.radial_flux.layout import Layout

FACES = {
    ("housing", "ambient"): "housing.fins",
    ("housing", "jacket"): "jacket.wall",
    **{(f"jacket.{end}.tube", "jacket"): f"jacket.{end}.bore" for end in ("inlet", "outlet")},
}


def enclosure(g: Geometry, at: Layout) -> tuple[Part, ...]:
    seat = g.bearing.outer_diameter / 2
    bearing = shapes.ring(g.shaft.diameter / 2, seat)
    cap = shapes.ring(seat, at.cap_radius)
    left, right = (0.0, at.cap0), (at.cap1, at.length)
    skirts: tuple[Prism, ...] = ()
    if g.housing.kind == "none":  # the end-caps reach to the laminations
        skirt = shapes.ring(at.core - g.frame.skirt, at.core)
        skirts = (skirt, at.cap0, at.core0), (skirt, at.core1, at.cap1)
    return (
        *_housing(g, at),
        Part("endcap.left", "aluminium-cast", ((cap, *left), *skirts[:1]), role=Role.END_SHIELD),
        Part("endcap.right", "aluminium-cast", ((cap, *right), *skirts[1:]), role=Role.END_SHIELD),
        Part("bearing.left", "bearing", ((bearing, *left),), role=Role.BEARING),
        Part("bearing.right", "bearing", ((bearing, *right),), role=Role.BEARING),
        *_base(g, at),
        *(nozzle.part() for nozzle in nozzles(g, at)),
    )


def _housing(g: Geometry, at: Layout) -> tuple[Part, ...]:
    kind, cad_shape = g.housing.kind, None
    if kind == "none":
        return ()
    walls: tuple[Prism, ...] = ((shapes.ring(at.core, at.body), at.cap0, at.cap1),)
    if kind == "spiral":  # as it is made: a helix for the rings, round bores
        turns, bored = turns_of(g, at), nozzles(g, at)
        cad_shape = CadShape(walls, (turns.helix(g.housing.port), *(nozzle.drill for nozzle in bored)))
        walls = tuple(turns.walls(at.core, at.body, at.cap0, at.cap1, bored))
    elif kind != "plain":
        walls = _axial_fins(g, at) if kind == "axial-fins" else _radial_fins(g, at)
    return (Part("housing", "aluminium-cast", walls, cad_shape=cad_shape, role=Role.HOUSING),)


def _axial_fins(g: Geometry, at: Layout) -> tuple[Prism, ...]:
    around = shapes.spread(g.housing.fins, math.pi / 2, g.housing.fin_spacing / at.wall)
    angles = [angle for angle in around if not _over_foot(g, at, angle)]
    loop = shapes.finned_loop(at.wall, g.housing.fin_thickness, at.fins, angles)
    return ((Profile(loop, (shapes.circle_loop(at.core),)), at.cap0, at.cap1),)


def _over_foot(g: Geometry, at: Layout, angle: float) -> bool:
    near = at.wall * abs(math.cos(angle)) - 0.6 * g.housing.fin_thickness
    return g.base.kind != "none" and math.sin(angle) < 0 and near < g.foot.width / 2


def _radial_fins(g: Geometry, at: Layout) -> tuple[Prism, ...]:
    """Discs around the housing, cut out where the foot stands."""
    bare, disc = shapes.ring(at.core, at.wall), shapes.ring(at.core, at.fins)
    prisms, here = [], at.cap0
    for z0, z1 in fin_spans(g, at):
        half = (z1 - z0) / 2
        beside = g.base.kind != "none" and at.foot0 - half < z1 and z0 < at.foot1 + half
        prisms += [(bare, here, z0), (_around_foot(g, at) if beside else disc, z0, z1)]
        here = z1
    return (*prisms, (bare, here, at.cap1))


def _around_foot(g: Geometry, at: Layout) -> Profile:
    """A disc that leaves as much as a fin's thickness free on either side of the foot."""
    free = min(g.housing.fin_thickness, 0.05 * at.wall)
    loop = shapes.slotted_loop(at.fins, g.foot.width + 2 * free, at.wall, (-math.pi / 2,))
    return Profile(loop, (shapes.circle_loop(at.core),))


def fin_spans(g: Geometry, at: Layout) -> list[tuple[float, float]]:
    """Axial range of each radial fin (m)."""
    pitch = g.housing.fin_spacing or (at.cap1 - at.cap0) / g.housing.fins
    half, first = g.housing.fin_thickness / 2, at.middle - (g.housing.fins - 1) / 2 * pitch
    return [(first + i * pitch - half, first + i * pitch + half) for i in range(g.housing.fins)]


def turns_of(g: Geometry, at: Layout) -> Turns:
    """The turns of the spiral jacket, over the stack."""
    pitch = (at.core1 - at.core0 - g.housing.rib) / g.housing.turns
    return Turns(at.wall, at.channel, at.core0 + g.housing.rib, pitch, g.housing.rib, g.housing.turns)


def nozzles(g: Geometry, at: Layout) -> tuple[Nozzle, ...]:
    """Inlet and outlet of the spiral jacket."""
    if g.housing.kind != "spiral":
        return ()
    bore = g.housing.port
    places = zip(("inlet", "outlet"), turns_of(g, at).places(bore))
    return tuple(Nozzle(f"jacket.{end}", "jacket", *place, bore, at.channel, at.body) for end, place in places)


def coolant(g: Geometry, at: Layout) -> tuple[Part, ...]:
    """What flows in the jacket, to the ends of its ports."""
    if g.housing.kind != "spiral":
        return ()
    necks = (nozzle.neck for nozzle in nozzles(g, at))
    return (fluid("jacket", *turns_of(g, at).liquid, *necks, material="glycol-50", role=Role.COOLANT),)


def ports(g: Geometry) -> tuple[Port, ...]:
    """Inlet at the first turn, outlet at the last, on the jacket's outer wall."""
    return tuple(nozzle.port for nozzle in nozzles(g, Layout(g)))


def _base(g: Geometry, at: Layout) -> tuple[Part, ...]:
    if g.base.kind == "none":
        return ()
    half, top = g.foot.width / 2, -shapes.on_circle(at.body, g.foot.width / 2)
    arc = shapes.bulge_of(2 * math.asin(half / at.body))
    pad = Profile(((-half, at.ground, 0.0), (half, at.ground, 0.0), (half, top, -arc), (-half, top, 0.0)))
    plate = shapes.rectangle(-g.base.width / 2, g.base.width / 2, at.ground - g.base.thickness, at.ground)
    reach = g.base.length / 2
    return (
        Part("foot", "aluminium-cast", ((pad, at.foot0, at.foot1),), role=Role.FOOT),
        Part("base", "aluminium", ((plate, at.middle - reach, at.middle + reach),), role=Role.BASE),
    )
