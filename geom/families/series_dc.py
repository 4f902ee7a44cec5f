"""Series-wound DC traction motor: wound rotor with commutator, salient poles with field coils, finned housing.

The axis is z, the commutator sits on the right (high z), the feet point to -y.
"""

from __future__ import annotations

import math
from typing import Any

from geom import shapes
from geom.families import Family
from geom.parameters import Parameter, impossible
from geom.part import Part, Prism, extrude, fluid
from geom.profile import Profile

P = Parameter
PARAMETERS = (
    P("shaft.length_mm", 440.0, 100.0, 3000.0, "overall length of the machine, shaft end to shaft end"),
    P("shaft.bearing_diameter_mm", 70.0, 10.0, 400.0, "shaft diameter in the bearings"),
    P("shaft.core_diameter_mm", 90.0, 12.0, 600.0, "shaft diameter inside the rotor core"),
    P("shaft.hub_diameter_mm", 124.0, 14.0, 800.0, "shaft diameter under the commutator"),
    P("rotor.outer_diameter_mm", 290.0, 40.0, 2000.0, "rotor core, over the teeth"),
    P("rotor.stack_length_mm", 200.0, 20.0, 1500.0, "length of the laminated core and of the poles"),
    P("rotor.slots", 46, 8, 200, "number of armature slots"),
    P("rotor.slot_width_mm", 9.0, 1.0, 60.0, "parallel-sided slot, before the liner"),
    P("rotor.slot_depth_mm", 32.0, 3.0, 200.0, "rotor surface to slot bottom"),
    P("rotor.liner_mm", 0.3, 0.05, 3.0, "thickness of the slot liner"),
    P("rotor.wedge_mm", 3.0, 0.3, 20.0, "insulating closure at the slot opening, part of slot.liner"),
    P("rotor.straight_mm", 8.0, 1.0, 100.0, "straight length of the coils outside the core"),
    P("rotor.end_winding_mm", 37.0, 3.0, 400.0, "axial length of the end-winding ring"),
    P("rotor.ducts", 0, 0, 60, "axial air ducts through the rotor core"),
    P("rotor.duct_diameter_mm", 16.0, 2.0, 200.0, "diameter of an air duct"),
    P("commutator.diameter_mm", 200.0, 20.0, 1500.0, "brush surface"),
    P("commutator.length_mm", 47.0, 5.0, 600.0, "axial length of the brush surface"),
    P("commutator.riser_mm", 8.0, 1.0, 60.0, "axial thickness of the risers that join the winding"),
    P("stator.poles", 4, 2, 12, "number of main poles"),
    P("stator.air_gap_mm", 2.0, 0.3, 20.0, "rotor surface to pole shoe"),
    P("stator.pole_arc", 0.65, 0.3, 0.9, "pole shoe arc divided by the pole pitch"),
    P("stator.tip_mm", 8.0, 1.0, 60.0, "radial thickness of the shoe at its tips"),
    P("stator.shoe_mm", 9.0, 1.0, 100.0, "radial thickness of the shoe in the middle"),
    P("stator.body_width_mm", 92.0, 5.0, 800.0, "width of the pole body"),
    P("stator.yoke_inner_diameter_mm", 408.0, 50.0, 3000.0, "bore of the yoke"),
    P("stator.yoke_thickness_mm", 30.0, 3.0, 300.0, "radial thickness of the yoke"),
    P("stator.yoke_overhang_mm", 35.0, 0.0, 500.0, "yoke beyond the poles, on either side"),
    P("field.coil_width_mm", 26.0, 2.0, 300.0, "field coil, along the pole pitch"),
    P("field.coil_height_mm", 30.0, 2.0, 300.0, "field coil, along the radius"),
    P("field.insulation_mm", 1.5, 0.1, 10.0, "insulation between field coil and pole body"),
    P("field.clearance_mm", 2.0, 0.1, 50.0, "shoe back to field coil"),
    P("housing.thickness_mm", 6.0, 1.0, 100.0, "wall of the housing"),
    P("housing.fins", 36, 0, 200, "number of axial fins, those in the way of the feet included"),
    P("housing.fin_height_mm", 18.0, 1.0, 150.0, "radial height of a fin"),
    P("housing.fin_thickness_mm", 4.0, 0.5, 40.0, "thickness of a fin"),
    P("flange.thickness_mm", 24.0, 2.0, 200.0, "end flanges; the bearings are as wide"),
    P("flange.shaft_end_mm", 12.0, 1.0, 500.0, "shaft beyond the outer face of a flange, both sides"),
    P("flange.rotor_offset_mm", 59.0, 5.0, 600.0, "inner face of the left flange to the rotor core"),
    P("bearing.outer_diameter_mm", 125.0, 15.0, 700.0, "bearing seat"),
    P("feet.shaft_height_mm", 280.0, 50.0, 2000.0, "axis above the base plate"),
    P("feet.inner_mm", 120.0, 0.0, 1500.0, "axis to the inner side of a foot, horizontally"),
    P("feet.width_mm", 60.0, 3.0, 500.0, "width of a foot"),
    P("feet.length_mm", 40.0, 3.0, 500.0, "axial length of each of the four feet"),
    P("feet.inset_mm", 25.0, 0.0, 500.0, "inner face of a flange to the nearest foot"),
    P("base.width_mm", 700.0, 20.0, 5000.0, "base plate, across the axis"),
    P("base.length_mm", 360.0, 20.0, 5000.0, "base plate, along the axis, centred on the housing"),
    P("base.thickness_mm", 20.0, 1.0, 300.0, "base plate"),
)


def build(g: Any) -> tuple[Part, ...]:
    """Solids and fluids of the machine. Raises InputError for parts that do not fit."""
    z = _Axial(g)
    check(g, z)
    return (*_rotor(g, z), *_stator(g, z), *_enclosure(g, z), *_fluids(g, z))


class _Axial:
    """Axial positions (m), left to right."""

    def __init__(self, g: Any) -> None:
        self.end = g.shaft.length
        self.flange0 = g.flange.shaft_end
        self.inner0 = self.flange0 + g.flange.thickness
        self.flange1 = self.end - g.flange.shaft_end
        self.inner1 = self.flange1 - g.flange.thickness
        self.core0 = self.inner0 + g.flange.rotor_offset
        self.core1 = self.core0 + g.rotor.stack_length
        self.coil0, self.coil1 = self.core0 - g.rotor.straight, self.core1 + g.rotor.straight
        self.ring0, self.ring1 = self.coil0 - g.rotor.end_winding, self.coil1 + g.rotor.end_winding
        self.riser1 = self.ring1 + g.commutator.riser
        self.bars1 = self.riser1 + g.commutator.length
        self.yoke0, self.yoke1 = self.core0 - g.stator.yoke_overhang, self.core1 + g.stator.yoke_overhang
        self.field0 = self.core0 - g.field.insulation - g.field.coil_width
        self.field1 = self.core1 + g.field.insulation + g.field.coil_width


class _Radii:
    """Radii and half widths (m) that several parts share."""

    def __init__(self, g: Any) -> None:
        self.rotor = g.rotor.outer_diameter / 2
        self.slot_bottom = self.rotor - g.rotor.slot_depth
        self.wire_bottom = self.slot_bottom + g.rotor.liner
        self.wire_top = self.rotor - g.rotor.wedge
        self.bore = self.rotor + g.stator.air_gap
        self.shoe_back = self.bore + g.stator.shoe
        self.coil0 = self.shoe_back + g.field.clearance
        self.coil1 = self.coil0 + g.field.coil_height
        self.body = g.stator.body_width / 2
        self.insulated = self.body + g.field.insulation
        self.coil_side = self.insulated + g.field.coil_width
        self.yoke0 = g.stator.yoke_inner_diameter / 2
        self.yoke1 = self.yoke0 + g.stator.yoke_thickness
        self.shell = self.yoke1 + g.housing.thickness
        self.fins = self.shell + (g.housing.fin_height if g.housing.fins else 0.0)


def check(g: Any, z: _Axial) -> None:
    """Refuse values that are allowed one by one but do not fit together."""
    r = _Radii(g)
    pitch = 2 * math.pi / g.rotor.slots
    tooth = pitch * r.slot_bottom - g.rotor.slot_width
    tip_angle = math.pi / g.stator.poles * g.stator.pole_arc
    tip = shapes.polar(r.bore + g.stator.tip, tip_angle)
    coil_corner = math.atan2(r.coil_side, r.coil0)
    foot_outer = g.feet.inner + g.feet.width
    mm = 1e3
    rules = (
        (g.shaft.bearing_diameter < g.bearing.outer_diameter, "bearing.outer_diameter_mm",
         g.bearing.outer_diameter * mm, f"more than the shaft, {g.shaft.bearing_diameter * mm:.4g} mm"),
        (g.bearing.outer_diameter / 2 < r.shell, "bearing.outer_diameter_mm",
         g.bearing.outer_diameter * mm, f"less than the housing, {2 * r.shell * mm:.4g} mm"),
        (g.shaft.bearing_diameter <= g.shaft.core_diameter, "shaft.core_diameter_mm",
         g.shaft.core_diameter * mm, f"at least the bearing diameter, {g.shaft.bearing_diameter * mm:.4g} mm"),
        (g.shaft.core_diameter < 2 * r.slot_bottom, "rotor.slot_depth_mm", g.rotor.slot_depth * mm,
         f"less than {(r.rotor - g.shaft.core_diameter / 2) * mm:.4g} mm, where the shaft begins"),
        (tooth > 0.1 * g.rotor.slot_width, "rotor.slot_width_mm", g.rotor.slot_width * mm,
         f"less than {pitch * r.slot_bottom / 1.1 * mm:.4g} mm: the slot pitch at the slot bottom, less a tooth"),
        (g.rotor.liner < 0.4 * g.rotor.slot_width, "rotor.liner_mm", g.rotor.liner * mm,
         f"less than {0.4 * g.rotor.slot_width * mm:.4g} mm, to leave room for the winding"),
        (g.rotor.liner + g.rotor.wedge < 0.8 * g.rotor.slot_depth, "rotor.wedge_mm", g.rotor.wedge * mm,
         f"less than {(0.8 * g.rotor.slot_depth - g.rotor.liner) * mm:.4g} mm, to leave room for the winding"),
        (_ducts_fit(g, r), "rotor.duct_diameter_mm", g.rotor.duct_diameter * mm,
         "small enough for the ducts to stay apart, off the shaft and off the slots"),
        (g.shaft.hub_diameter < g.commutator.diameter, "commutator.diameter_mm", g.commutator.diameter * mm,
         f"more than the hub under it, {g.shaft.hub_diameter * mm:.4g} mm"),
        (g.shaft.core_diameter <= g.shaft.hub_diameter < 2 * r.wire_bottom, "shaft.hub_diameter_mm",
         g.shaft.hub_diameter * mm,
         f"from the core's {g.shaft.core_diameter * mm:.4g} mm to below the winding's {2 * r.wire_bottom * mm:.4g} mm"),
        (g.commutator.diameter <= 2 * r.wire_top, "commutator.diameter_mm", g.commutator.diameter * mm,
         f"at most the risers' {2 * r.wire_top * mm:.4g} mm"),
        (tip_angle < math.pi / g.stator.poles - 0.01, "stator.pole_arc", g.stator.pole_arc,
         "small enough for the shoes to stay apart"),
        (r.body < 0.95 * tip[1] and r.shoe_back > tip[0], "stator.body_width_mm", g.stator.body_width * mm,
         f"less than the shoe, {1.9 * tip[1] * mm:.4g} mm, whose tips lie below its back"),
        (coil_corner < math.pi / g.stator.poles - 0.005, "field.coil_width_mm", g.field.coil_width * mm,
         "narrow enough for neighbouring coils to stay apart"),
        (math.hypot(r.coil1, r.coil_side) < 0.995 * r.yoke0, "stator.yoke_inner_diameter_mm",
         g.stator.yoke_inner_diameter * mm,
         f"more than {2.01 * math.hypot(r.coil1, r.coil_side) * mm:.4g} mm, to clear the field coils"),
        (z.inner0 < min(z.ring0, z.field0, z.yoke0), "flange.rotor_offset_mm", g.flange.rotor_offset * mm,
         f"more than {(z.core0 - min(z.ring0, z.field0, z.yoke0)) * mm:.4g} mm: end winding, field coil and yoke"),
        (max(z.bars1, z.field1, z.yoke1) < z.inner1, "shaft.length_mm", g.shaft.length * mm,
         f"more than {(max(z.bars1, z.field1, z.yoke1) + z.end - z.inner1) * mm:.4g} mm, for all that it carries"),
        (_fins_fit(g, r), "housing.fin_thickness_mm", g.housing.fin_thickness * mm,
         f"less than {0.9 * 2 * math.pi * r.shell / max(g.housing.fins, 1) * mm:.4g} mm: "
         f"{g.housing.fins} fins on this housing overlap otherwise"),
        (foot_outer < 0.95 * r.shell, "feet.width_mm", g.feet.width * mm,
         f"less than {(0.95 * r.shell - g.feet.inner) * mm:.4g} mm: the foot must end under the housing"),
        (foot_outer < g.base.width / 2, "base.width_mm", g.base.width * mm, f"more than {2 * foot_outer * mm:.4g} mm"),
        (r.fins < g.feet.shaft_height, "feet.shaft_height_mm", g.feet.shaft_height * mm,
         f"more than {r.fins * mm:.4g} mm, where the fins end"),
        (2 * (g.feet.inset + g.feet.length) < z.inner1 - z.inner0, "feet.length_mm", g.feet.length * mm,
         f"less than {((z.inner1 - z.inner0) / 2 - g.feet.inset) * mm:.4g} mm"),
        (g.base.length > z.inner1 - z.inner0 - 2 * g.feet.inset, "base.length_mm", g.base.length * mm,
         f"more than {(z.inner1 - z.inner0 - 2 * g.feet.inset) * mm:.4g} mm, to carry the feet"),
    )  # fmt: skip
    for holds, key, value, right in rules:
        if not holds:
            raise impossible(f"{value:.4g} does not fit", key, f"must be {right}")


def _ducts_fit(g: Any, r: _Radii) -> bool:
    if not g.rotor.ducts:
        return True
    middle = _duct_circle(g, r)
    radius = g.rotor.duct_diameter / 2
    apart = 2 * middle * math.sin(math.pi / g.rotor.ducts) > 2.2 * radius
    return apart and middle - 1.1 * radius > g.shaft.core_diameter / 2 and middle + 1.1 * radius < r.slot_bottom


def _duct_circle(g: Any, r: _Radii) -> float:
    return (g.shaft.core_diameter / 2 + r.slot_bottom) / 2


def _fins_fit(g: Any, r: _Radii) -> bool:
    return g.housing.fins == 0 or g.housing.fin_thickness < 0.9 * 2 * math.pi * r.shell / g.housing.fins


def _rotor(g: Any, z: _Axial) -> tuple[Part, ...]:
    r = _Radii(g)
    angles = shapes.evenly(g.rotor.slots)
    wire = Profile(shapes.bar_loop(r.wire_bottom, r.wire_top, g.rotor.slot_width - 2 * g.rotor.liner))
    liner = Profile(shapes.bar_loop(r.slot_bottom, r.rotor, g.rotor.slot_width), (wire.outer,))
    wires, liners = shapes.turned(wire, angles), shapes.turned(liner, angles)
    ends = shapes.ring(r.wire_bottom, r.wire_top)
    return (
        _shaft(g, z),
        Part("rotor.core", "electrical-steel", ((_lamination(g, r, angles), z.core0, z.core1),), "laminated"),
        Part("slot.liner", "slot-liner", extrude(liners, z.core0, z.core1)),
        Part("winding.armature", "winding", extrude(wires, z.core0, z.core1), "wound"),
        Part("winding.armature.left", "end-winding", (*extrude(wires, z.coil0, z.core0), (ends, z.ring0, z.coil0))),
        Part("winding.armature.right", "end-winding", (*extrude(wires, z.core1, z.coil1), (ends, z.coil1, z.ring1))),
        _commutator(g, z, r),
    )


def _lamination(g: Any, r: _Radii, angles: list[float]) -> Profile:
    ducts = shapes.turned(shapes.disc(g.rotor.duct_diameter / 2, _duct_circle(g, r)), shapes.evenly(g.rotor.ducts))
    loop = shapes.slotted_loop(r.rotor, g.rotor.slot_width, r.slot_bottom, angles)
    return Profile(loop, (shapes.circle_loop(g.shaft.core_diameter / 2), *(duct.outer for duct in ducts)))


def _shaft(g: Any, z: _Axial) -> Part:
    steps = (
        (g.shaft.bearing_diameter, 0.0, z.inner0),
        (g.shaft.core_diameter, z.inner0, z.ring1),
        (g.shaft.hub_diameter, z.ring1, z.bars1),
        (g.shaft.bearing_diameter, z.bars1, z.end),
    )
    return Part("shaft", "steel", tuple((shapes.disc(d / 2), z0, z1) for d, z0, z1 in steps))


def _commutator(g: Any, z: _Axial, r: _Radii) -> Part:
    hub = g.shaft.hub_diameter / 2
    risers = (shapes.ring(hub, r.wire_top), z.ring1, z.riser1)
    return Part("commutator", "commutator", (risers, (shapes.ring(hub, g.commutator.diameter / 2), z.riser1, z.bars1)))


def _stator(g: Any, z: _Axial) -> tuple[Part, ...]:
    r = _Radii(g)
    angles = shapes.evenly(g.stator.poles, math.pi / 2)
    sides = [shapes.rectangle(r.coil0, r.coil1, *y) for y in ((-r.coil_side, -r.insulated), (r.insulated, r.coil_side))]
    across = shapes.rectangle(r.coil0, r.coil1, -r.coil_side, r.coil_side)
    plates = [shapes.rectangle(r.coil0, r.coil1, *y) for y in ((-r.insulated, -r.body), (r.body, r.insulated))]
    cap = shapes.rectangle(r.coil0, r.coil1, -r.insulated, r.insulated)
    inner0, inner1 = z.core0 - g.field.insulation, z.core1 + g.field.insulation
    coil = (*extrude(sides, inner0, inner1), (across, z.field0, inner0), (across, inner1, z.field1))
    lining = (*extrude(plates, z.core0, z.core1), (cap, inner0, z.core0), (cap, z.core1, inner1))
    return (
        Part("yoke", "steel", ((shapes.ring(r.yoke0, r.yoke1), z.yoke0, z.yoke1),)),
        Part("poles", "electrical-steel", extrude(shapes.turned(_pole(g, r), angles), z.core0, z.core1), "laminated"),
        Part("winding.field", "field-winding", _around(coil, angles), "wound"),
        Part("field.insulation", "insulation", _around(lining, angles)),
    )


def _around(prisms: tuple[Prism, ...], angles: list[float]) -> tuple[Prism, ...]:
    return tuple((profile.rotated(angle), z0, z1) for angle in angles for profile, z0, z1 in prisms)


def _pole(g: Any, r: _Radii) -> Profile:
    tip = math.pi / g.stator.poles * g.stator.pole_arc
    root = shapes.on_circle(r.yoke0, r.body)
    return Profile((
        shapes.polar(r.bore, -tip),
        shapes.polar(r.bore + g.stator.tip, -tip),
        (r.shoe_back, -r.body, 0.0),
        (root, -r.body, shapes.bulge_of(2 * math.asin(r.body / r.yoke0))),
        (root, r.body, 0.0),
        (r.shoe_back, r.body, 0.0),
        shapes.polar(r.bore + g.stator.tip, tip),
        shapes.polar(r.bore, tip, -shapes.bulge_of(2 * tip)),
    ))  # fmt: skip


def _enclosure(g: Any, z: _Axial) -> tuple[Part, ...]:
    r = _Radii(g)
    seat, shaft = g.bearing.outer_diameter / 2, g.shaft.bearing_diameter / 2
    housing = Profile(_finned(g, r), (shapes.circle_loop(r.yoke1),))
    flange, bearing = shapes.ring(seat, r.shell), shapes.ring(shaft, seat)
    left, right = (z.flange0, z.inner0), (z.inner1, z.flange1)
    return (
        Part("housing", "aluminium-cast", ((housing, z.inner0, z.inner1),)),
        Part("flange.left", "aluminium-cast", ((flange, *left),)),
        Part("flange.right", "aluminium-cast", ((flange, *right),)),
        Part("bearing.left", "bearing", ((bearing, *left),)),
        Part("bearing.right", "bearing", ((bearing, *right),)),
        Part("feet", "aluminium-cast", _feet(g, z, r)),
        _base(g, z),
    )


def _finned(g: Any, r: _Radii) -> tuple[tuple[float, float, float], ...]:
    angles = [a for a in shapes.evenly(g.housing.fins, math.pi / 2) if not _over_foot(g, r, a)]
    if not angles:
        return shapes.circle_loop(r.shell)
    return shapes.finned_loop(r.shell, g.housing.fin_thickness, r.fins, angles)


def _over_foot(g: Any, r: _Radii, angle: float) -> bool:
    """A fin here would run into a foot, which is bounded by two vertical planes under the housing."""
    margin = 0.6 * g.housing.fin_thickness
    near, far = r.shell * abs(math.cos(angle)) - margin, r.fins * abs(math.cos(angle)) + margin
    return math.sin(angle) < 0 and near < g.feet.inner + g.feet.width and far > g.feet.inner


def _feet(g: Any, z: _Axial, r: _Radii) -> tuple[Prism, ...]:
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


def _base(g: Any, z: _Axial) -> Part:
    top, middle = -g.feet.shaft_height, (z.inner0 + z.inner1) / 2
    plate = shapes.rectangle(-g.base.width / 2, g.base.width / 2, top - g.base.thickness, top)
    return Part("base", "steel", ((plate, middle - g.base.length / 2, middle + g.base.length / 2),))


def _fluids(g: Any, z: _Axial) -> tuple[Part, ...]:
    r = _Radii(g)
    hollow, core = shapes.disc(r.yoke1), shapes.disc(g.rotor.outer_diameter / 2)
    ducts = (fluid("air.ducts", (core, z.core0, z.core1)),) if g.rotor.ducts else ()
    return (
        fluid("air.left", (hollow, z.inner0, z.core0)),
        *ducts,
        fluid("airgap", (shapes.ring(r.rotor, r.bore), z.core0, z.core1)),
        fluid("air.interpolar", (shapes.ring(r.bore, r.yoke0), z.core0, z.core1)),
        fluid("air.right", (hollow, z.core1, z.inner1)),
    )


FAMILY = Family(
    "series-dc",
    "Series-wound DC traction motor with salient poles and a finned housing",
    PARAMETERS,
    build,
    {("housing", "ambient"): "housing.fins"},
)
