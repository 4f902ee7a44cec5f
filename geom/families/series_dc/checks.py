"""Values of a series-wound motor that are allowed one by one but do not fit together."""

import math

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.families.channels import too_near
from geom.families.fit import Fit, mm
from geom.families.series_dc.housing import nozzles
from geom.families.series_dc.layout import Axial, Radii
from geom.families.series_dc.rotor import duct_circle
from geom.families.shaft_fan import check_fan


def check(g: Geometry, z: Axial) -> None:
    """Raise InputError for the first rule that does not hold."""
    fit, r = Fit(g), Radii(g)
    _check_rotor(fit, g, r)
    half = math.pi / g.stator.poles
    tips = half * g.stator.pole_arc
    fit.need(tips < half - 0.01, "stator.pole_arc", "small enough for the shoes to stay apart", unit="")
    x, y, _ = shapes.polar(r.bore + g.stator.tip, tips)
    shoe = f"less than the shoe, {1.9 * y * mm:.4g} mm, whose tips lie below its back"
    fit.need(r.body < 0.95 * y and r.shoe_back > x, "stator.body_width", shoe)
    sides = math.atan2(r.coil_side, r.coil0)
    fit.need(sides < half - 0.005, "field.coil_width", "narrow enough for neighbouring coils to stay apart")
    corner = math.hypot(r.coil1, r.coil_side)
    clear = f"more than {2.01 * corner * mm:.4g} mm, to clear the field coils"
    fit.need(corner < 0.995 * r.yoke0, "stator.yoke_inner_diameter", clear)
    first, last = min(z.ring0, z.field0, z.yoke0), max(z.bars1, z.field1, z.yoke1)
    fit.above(z.core0 - first, "flange.rotor_offset", ": end winding, field coil and yoke")
    fit.above(last + z.end - z.inner1, "shaft.length", ", for all that it carries")
    if fins := g.housing.fins:
        circle = 2 * math.pi * r.shell
        pitch = g.housing.fin_spacing or circle / fins
        fit.below(0.9 * pitch, "housing.fin_thickness", f": {fins} fins on this housing overlap otherwise")
        most = f"at most {circle / fins * mm:.4g} mm"
        fit.need(fins * g.housing.fin_spacing <= circle, "housing.fin_spacing", most)
    if g.commutator.bars:
        around = math.pi * g.commutator.diameter / g.commutator.bars
        high = (g.commutator.diameter - g.shaft.hub_diameter) / 2
        fit.below(0.5 * min(around, high), "commutator.mica", ", to leave copper")
    check_fan(fit, g.shaft.bearing_diameter, 2 * r.shell)
    if g.brushes.arms:
        room = (g.rotor.outer_diameter - g.commutator.diameter) / 2 - g.brushes.arm
        fit.below(room, "brushes.height", " with such an arm, to stay below the armature's radius")
        fit.need(z.bars1 < z.inner1, "brushes.arms", "0, or a commutator that ends before the flange", unit="")
    _check_jackets(fit, g, r, z)
    inside, outermost = z.inner1 - z.inner0, max(r.fins, r.jacket) if z.jackets else r.fins
    fit.below(0.95 * r.shell - g.feet.inner, "feet.width", ": the foot must end under the housing")
    fit.above(2 * (g.feet.inner + g.feet.width), "base.width")
    fit.above(outermost, "feet.shaft_height", ", where fins or jacket end")
    fit.below(inside / 2 - g.feet.inset, "feet.length")
    fit.above(inside - 2 * g.feet.inset, "base.length", ", to carry the feet")


def _check_rotor(fit: Fit, g: Geometry, r: Radii) -> None:
    seat, core, hub, slot = g.shaft.bearing_diameter, g.shaft.core_diameter, g.shaft.hub_diameter, g.rotor.slot_width
    pitch = 2 * math.pi / g.rotor.slots * r.slot_bottom
    fit.need(seat < g.bearing.outer_diameter, "bearing.outer_diameter", f"more than the shaft, {seat * mm:.4g} mm")
    shell = f"less than the housing, {2 * r.shell * mm:.4g} mm"
    fit.need(g.bearing.outer_diameter / 2 < r.shell, "bearing.outer_diameter", shell)
    fit.need(seat <= core, "shaft.core_diameter", f"at least the bearing diameter, {seat * mm:.4g} mm")
    fit.below(r.rotor - core / 2, "rotor.slot_depth", ", where the shaft begins")
    fit.below(pitch / 1.1, "rotor.slot_width", ": the slot pitch at the slot bottom, less a tooth")
    fit.below(0.4 * slot, "rotor.liner", ", to leave room for the winding")
    fit.below(0.8 * g.rotor.slot_depth - g.rotor.liner, "rotor.wedge", ", to leave room for the winding")
    room = "small enough for the ducts to stay apart, off the shaft and off the slots"
    fit.need(_ducts_fit(g, r), "rotor.duct_diameter", room)
    fit.need(hub < g.commutator.diameter, "commutator.diameter", f"more than the hub under it, {hub * mm:.4g} mm")
    winding = 2 * r.wire_bottom
    between = f"from the core's {core * mm:.4g} mm to below the winding's {winding * mm:.4g} mm"
    fit.need(core <= hub < winding, "shaft.hub_diameter", between)
    risers = f"at most the risers' {2 * r.wire_top * mm:.4g} mm"
    fit.need(g.commutator.diameter <= 2 * r.wire_top, "commutator.diameter", risers)


def _ducts_fit(g: Geometry, r: Radii) -> bool:
    if not g.rotor.ducts:
        return True
    middle, radius = duct_circle(g, r), g.rotor.duct_diameter / 2
    clear = 2 * middle * math.sin(math.pi / g.rotor.ducts) > 2.2 * radius
    return clear and middle - 1.1 * radius > g.shaft.core_diameter / 2 and middle + 1.1 * radius < r.slot_bottom


def _check_jackets(fit: Fit, g: Geometry, r: Radii, z: Axial) -> None:
    if not z.jackets:
        return
    j, length = g.jacket, min(z1 - z0 for z0, z1 in z.jackets.values())
    around = 2 * math.pi * r.shell / j.channels
    if j.layout == "zigzag":
        room, wide = around, min(around, length / 2) - j.rib
        bore = min(0.8 * wide, 0.6 * around)
    else:
        room, wide = length / (j.turns + 1), (length - j.rib) / j.turns - j.rib
        bore = 0.8 * wide
    fit.below(0.9 * min(room, length / 2.5), "jacket.rib", ", to leave room for the channels")
    fit.below(bore, "jacket.port", ", the channel's share for it")
    fit.need(not too_near(nozzles(g)), "jacket.port", "less, to keep the ports apart")
