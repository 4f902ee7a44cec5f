"""Values that are allowed one by one but do not fit together."""

from __future__ import annotations

import math

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.parameters import impossible
from geom.families.nozzles import too_near
from geom.families.series_dc.jacket import nozzles
from geom.families.series_dc.layout import Axial, Radii
from geom.families.series_dc.rotor import duct_circle
from geom.families.shaft_fan import Rule, fan_rules

mm = 1e3


def check(g: Geometry, z: Axial) -> None:
    """Refuse values that are allowed one by one but do not fit together."""
    r = Radii(g)
    pitch = 2 * math.pi / g.rotor.slots
    tooth = pitch * r.slot_bottom - g.rotor.slot_width
    tip_angle = math.pi / g.stator.poles * g.stator.pole_arc
    tip = shapes.polar(r.bore + g.stator.tip, tip_angle)
    coil_corner = math.atan2(r.coil_side, r.coil0)
    foot_outer = g.feet.inner + g.feet.width
    outermost = max(r.fins, r.jacket) if z.jackets else r.fins
    rules: tuple[Rule, ...] = (
        (
            g.shaft.bearing_diameter < g.bearing.outer_diameter,
            "bearing.outer_diameter_mm",
            g.bearing.outer_diameter * mm,
            f"more than the shaft, {g.shaft.bearing_diameter * mm:.4g} mm",
        ),
        (
            g.bearing.outer_diameter / 2 < r.shell,
            "bearing.outer_diameter_mm",
            g.bearing.outer_diameter * mm,
            f"less than the housing, {2 * r.shell * mm:.4g} mm",
        ),
        (
            g.shaft.bearing_diameter <= g.shaft.core_diameter,
            "shaft.core_diameter_mm",
            g.shaft.core_diameter * mm,
            f"at least the bearing diameter, {g.shaft.bearing_diameter * mm:.4g} mm",
        ),
        (
            g.shaft.core_diameter < 2 * r.slot_bottom,
            "rotor.slot_depth_mm",
            g.rotor.slot_depth * mm,
            f"less than {(r.rotor - g.shaft.core_diameter / 2) * mm:.4g} mm, where the shaft begins",
        ),
        (
            tooth > 0.1 * g.rotor.slot_width,
            "rotor.slot_width_mm",
            g.rotor.slot_width * mm,
            f"less than {pitch * r.slot_bottom / 1.1 * mm:.4g} mm: the slot pitch at the slot bottom, less a tooth",
        ),
        (
            g.rotor.liner < 0.4 * g.rotor.slot_width,
            "rotor.liner_mm",
            g.rotor.liner * mm,
            f"less than {0.4 * g.rotor.slot_width * mm:.4g} mm, to leave room for the winding",
        ),
        (
            g.rotor.liner + g.rotor.wedge < 0.8 * g.rotor.slot_depth,
            "rotor.wedge_mm",
            g.rotor.wedge * mm,
            f"less than {(0.8 * g.rotor.slot_depth - g.rotor.liner) * mm:.4g} mm, to leave room for the winding",
        ),
        (
            _ducts_fit(g, r),
            "rotor.duct_diameter_mm",
            g.rotor.duct_diameter * mm,
            "small enough for the ducts to stay apart, off the shaft and off the slots",
        ),
        (
            g.shaft.hub_diameter < g.commutator.diameter,
            "commutator.diameter_mm",
            g.commutator.diameter * mm,
            f"more than the hub under it, {g.shaft.hub_diameter * mm:.4g} mm",
        ),
        (
            g.shaft.core_diameter <= g.shaft.hub_diameter < 2 * r.wire_bottom,
            "shaft.hub_diameter_mm",
            g.shaft.hub_diameter * mm,
            f"from the core's {g.shaft.core_diameter * mm:.4g} mm to below "
            f"the winding's {2 * r.wire_bottom * mm:.4g} mm",
        ),
        (
            g.commutator.diameter <= 2 * r.wire_top,
            "commutator.diameter_mm",
            g.commutator.diameter * mm,
            f"at most the risers' {2 * r.wire_top * mm:.4g} mm",
        ),
        (
            tip_angle < math.pi / g.stator.poles - 0.01,
            "stator.pole_arc",
            g.stator.pole_arc,
            "small enough for the shoes to stay apart",
        ),
        (
            r.body < 0.95 * tip[1] and r.shoe_back > tip[0],
            "stator.body_width_mm",
            g.stator.body_width * mm,
            f"less than the shoe, {1.9 * tip[1] * mm:.4g} mm, whose tips lie below its back",
        ),
        (
            coil_corner < math.pi / g.stator.poles - 0.005,
            "field.coil_width_mm",
            g.field.coil_width * mm,
            "narrow enough for neighbouring coils to stay apart",
        ),
        (
            math.hypot(r.coil1, r.coil_side) < 0.995 * r.yoke0,
            "stator.yoke_inner_diameter_mm",
            g.stator.yoke_inner_diameter * mm,
            f"more than {2.01 * math.hypot(r.coil1, r.coil_side) * mm:.4g} mm, to clear the field coils",
        ),
        (
            z.inner0 < min(z.ring0, z.field0, z.yoke0),
            "flange.rotor_offset_mm",
            g.flange.rotor_offset * mm,
            f"more than {(z.core0 - min(z.ring0, z.field0, z.yoke0)) * mm:.4g} mm: end winding, field coil and yoke",
        ),
        (
            max(z.bars1, z.field1, z.yoke1) < z.inner1,
            "shaft.length_mm",
            g.shaft.length * mm,
            f"more than {(max(z.bars1, z.field1, z.yoke1) + z.end - z.inner1) * mm:.4g} mm, for all that it carries",
        ),
        (
            _fins_fit(g, r),
            "housing.fin_thickness_mm",
            g.housing.fin_thickness * mm,
            f"less than {0.9 * _fin_pitch(g, r) * mm:.4g} mm: {g.housing.fins} fins on this housing overlap otherwise",
        ),
        (
            g.housing.fins * g.housing.fin_spacing <= 2 * math.pi * r.shell,
            "housing.fin_spacing_mm",
            g.housing.fin_spacing * mm,
            f"at most {2 * math.pi * r.shell / max(g.housing.fins, 1) * mm:.4g} mm",
        ),
        *_commutator_rules(g),
        *fan_rules(g.fan, g.shaft.bearing_diameter, g.bearing.outer_diameter, 2 * r.shell),
        *_brush_rules(g, z),
        *_jacket_rules(g, r, z),
        (
            foot_outer < 0.95 * r.shell,
            "feet.width_mm",
            g.feet.width * mm,
            f"less than {(0.95 * r.shell - g.feet.inner) * mm:.4g} mm: the foot must end under the housing",
        ),
        (foot_outer < g.base.width / 2, "base.width_mm", g.base.width * mm, f"more than {2 * foot_outer * mm:.4g} mm"),
        (
            outermost < g.feet.shaft_height,
            "feet.shaft_height_mm",
            g.feet.shaft_height * mm,
            f"more than {outermost * mm:.4g} mm, where fins or jacket end",
        ),
        (
            2 * (g.feet.inset + g.feet.length) < z.inner1 - z.inner0,
            "feet.length_mm",
            g.feet.length * mm,
            f"less than {((z.inner1 - z.inner0) / 2 - g.feet.inset) * mm:.4g} mm",
        ),
        (
            g.base.length > z.inner1 - z.inner0 - 2 * g.feet.inset,
            "base.length_mm",
            g.base.length * mm,
            f"more than {(z.inner1 - z.inner0 - 2 * g.feet.inset) * mm:.4g} mm, to carry the feet",
        ),
    )
    for holds, key, value, right in rules:
        if not holds:
            raise impossible(f"{value:.4g} does not fit", key, f"must be {right}")


def _ducts_fit(g: Geometry, r: Radii) -> bool:
    if not g.rotor.ducts:
        return True
    middle = duct_circle(g, r)
    radius = g.rotor.duct_diameter / 2
    clear = 2 * middle * math.sin(math.pi / g.rotor.ducts) > 2.2 * radius
    return clear and middle - 1.1 * radius > g.shaft.core_diameter / 2 and middle + 1.1 * radius < r.slot_bottom


def _fins_fit(g: Geometry, r: Radii) -> bool:
    return g.housing.fins == 0 or g.housing.fin_thickness < 0.9 * _fin_pitch(g, r)


def _fin_pitch(g: Geometry, r: Radii) -> float:
    return g.housing.fin_spacing or 2 * math.pi * r.shell / max(g.housing.fins, 1)


def _commutator_rules(g: Geometry) -> tuple[Rule, ...]:
    c = g.commutator
    if not c.bars:
        return ()
    around, high = math.pi * c.diameter / c.bars, (c.diameter - g.shaft.hub_diameter) / 2
    limit = min(0.5 * around, 0.5 * high)
    return ((c.mica < limit, "commutator.mica_mm", c.mica * mm, f"less than {limit * mm:.4g} mm, to leave copper"),)


def _brush_rules(g: Geometry, z: Axial) -> tuple[Rule, ...]:
    b = g.brushes
    room = g.rotor.outer_diameter / 2 - g.commutator.diameter / 2
    if not b.arms:
        return ()
    return (
        (
            b.height + b.arm < room,
            "brushes.height_mm",
            b.height * mm,
            f"less than {(room - b.arm) * mm:.4g} mm with such an arm, to stay below the armature's radius",
        ),
        (z.bars1 < z.inner1, "brushes.arms", b.arms, "0, or a commutator that ends before the flange"),
    )


def _jacket_rules(g: Geometry, r: Radii, z: Axial) -> tuple[Rule, ...]:
    if not z.jackets:
        return ()
    j, length = g.jacket, min(z1 - z0 for z0, z1 in z.jackets.values())
    around, along = 2 * math.pi * r.shell / j.channels, length / (j.turns + 1)
    room = around if j.layout == "zigzag" else along
    right = f"less than {0.9 * min(room, length / 2.5) * mm:.4g} mm, to leave room for the channels"
    wide = min(around, length / 2) - j.rib if j.layout == "zigzag" else (length - j.rib) / j.turns - j.rib
    bore = min(0.8 * wide, 0.6 * around if j.layout == "zigzag" else wide)
    return (
        (j.rib < 0.9 * min(room, length / 2.5), "jacket.rib_mm", j.rib * mm, right),
        (j.port < bore, "jacket.port_mm", j.port * mm, f"less than {bore * mm:.4g} mm, the channel's share for it"),
        (j.port >= bore or not too_near(nozzles(g)), "jacket.port_mm", j.port * mm, "less, to keep the ports apart"),
    )
