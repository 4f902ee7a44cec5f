"""Shaft, armature and commutator."""

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.part import Part, Prism, extrude
from geom.description.profile import Profile
from geom.description.roles import Role
from geom.families.series_dc.commutator import commutator
from geom.families.series_dc.layout import Axial, Radii


def rotor(g: Geometry, z: Axial) -> tuple[Part, ...]:
    r = Radii(g)
    angles = shapes.evenly(g.rotor.slots)
    wire = Profile(shapes.bar_loop(r.wire_bottom, r.wire_top, g.rotor.slot_width - 2 * g.rotor.liner))
    liner = Profile(shapes.bar_loop(r.slot_bottom, r.rotor, g.rotor.slot_width), (wire.outer,))
    wires, liners = shapes.turned(wire, angles), shapes.turned(liner, angles)
    ducts = shapes.turned(shapes.disc(g.rotor.duct_diameter / 2, duct_circle(g, r)), shapes.evenly(g.rotor.ducts))
    loop = shapes.slotted_loop(r.rotor, g.rotor.slot_width, r.slot_bottom, angles)
    sheet = Profile(loop, (shapes.circle_loop(g.shaft.core_diameter / 2), *(duct.outer for duct in ducts)))
    ends = shapes.ring(r.wire_bottom, r.wire_top)
    loose = (g.rotor.end_fill, g.rotor.end_impregnation)
    inner = extrude(wires, z.core0, z.core1)
    left = (*extrude(wires, z.coil0, z.core0), (ends, z.ring0, z.coil0))
    right = (*extrude(wires, z.core1, z.coil1), (ends, z.coil1, z.ring1))
    steps = (
        (g.shaft.bearing_diameter, 0.0, z.inner0),
        (g.shaft.core_diameter, z.inner0, z.ring1),
        (g.shaft.hub_diameter, z.ring1, z.bars1),
        (g.shaft.bearing_diameter, z.bars1, z.end),
    )
    return (
        Part("shaft", "steel", tuple((shapes.disc(d / 2), z0, z1) for d, z0, z1 in steps), role=Role.SHAFT),
        Part("rotor.core", "electrical-steel", ((sheet, z.core0, z.core1),), role=Role.ROTOR),
        Part("slot.liner", "slot-liner", extrude(liners, z.core0, z.core1), role=Role.INSULATION, turns=True),
        _winding("winding.armature", "winding", inner, (g.rotor.fill, g.rotor.impregnation)),
        _winding("winding.armature.left", "end-winding", left, loose),
        _winding("winding.armature.right", "end-winding", right, loose),
        *commutator(g, z, r),
    )


def _winding(name: str, material: str, prisms: tuple[Prism, ...], filling: tuple[float, float]) -> Part:
    return Part(name, material, prisms, filling, role=Role.WINDING, turns=True)


def duct_circle(g: Geometry, r: Radii) -> float:
    return (g.shaft.core_diameter / 2 + r.slot_bottom) / 2
