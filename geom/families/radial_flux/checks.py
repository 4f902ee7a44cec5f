"""Values of a slotted machine that are allowed one by one but do not fit together."""

import math

from geom.description.geometry import Geometry
from geom.families.channels import too_near
from geom.families.fit import Fit, mm
from geom.families.radial_flux.hairpin import check_bars
from geom.families.radial_flux.housing import nozzles
from geom.families.radial_flux.layout import Layout
from geom.families.radial_flux.rotors import shapes_of_magnets
from geom.families.shaft_fan import check_fan


def check(g: Geometry, at: Layout, outlined: bool = False) -> None:
    """Raise InputError for the first rule that does not hold.  outlined : slots are outlines"""
    fit = Fit(g)
    if not outlined:
        _check_stator(fit, g, at)
    _check_frame(fit, g, at)
    _check_housing(fit, g, at)
    check_fan(fit, g.shaft.diameter, 2 * at.cap_radius)


def _check_stator(fit: Fit, g: Geometry, at: Layout) -> None:
    s, widest = g.stator, 2 * at.slot0 * math.sin(math.pi / g.stator.slots)
    lining = 2 * (s.liner + s.liner_gap)
    fit.need(s.air_gap < at.bore - g.shaft.diameter / 2, "stator.air_gap", "less, to leave a rotor")
    fit.above(1.25 * (s.tip + lining), "stator.slot_depth", ", for tip, liner and winding")
    fit.below(0.98 * at.core - at.bore, "stator.slot_depth", ", where the laminations end")
    if at.slot_width is not None:
        fit.below(0.85 * widest, "stator.slot_width", ", to leave teeth")
        fit.above(1.25 * lining, "stator.slot_width", ", for liner and winding")
    else:
        fit.below(0.85 * widest - lining, "stator.tooth", ", to leave room for liner and winding")
    slot = 1.8 * at.slot0 * math.sin(max(at.half_angle(at.slot0), 0.0))
    fit.need(s.opening < slot, "stator.opening", "narrower than the slot")
    fit.need(s.wedge <= s.tip, "stator.wedge", f"at most the tooth tip, {s.tip * mm:.4g} mm")
    if g.winding.kind == "hairpin":
        check_bars(fit, g)
    if g.winding.kind == "concentrated":
        fit.below(0.5 * widest, "stator.opening", ", to leave end windings on the teeth")


def _check_frame(fit: Fit, g: Geometry, at: Layout) -> None:
    room = g.winding.straight + g.winding.end + g.frame.cap + min(0.001, 0.005 * at.core)
    fit.need(
        g.shaft.diameter < g.bearing.outer_diameter,
        "bearing.outer_diameter",
        f"more than the shaft, {g.shaft.diameter * mm:.4g} mm",
    )
    fit.need(
        g.bearing.outer_diameter / 2 < at.core,
        "bearing.outer_diameter",
        f"less than the stator, {2 * at.core * mm:.4g} mm",
    )
    fit.above(g.stator.stack_length + 2 * room, "frame.length", ", for all it holds")
    if g.housing.kind == "none":
        fit.below(0.9 * (at.core - at.wire1), "frame.skirt", ", to clear the end winding")


def _check_housing(fit: Fit, g: Geometry, at: Layout) -> None:
    h, stack = g.housing, at.core1 - at.core0
    if h.kind.endswith("fins"):
        length = 2 * math.pi * at.wall if h.kind == "axial-fins" else at.cap1 - at.cap0
        pitch = h.fin_spacing or length / h.fins
        fit.below(0.9 * pitch, "housing.fin_thickness", f": {h.fins} fins overlap otherwise")
        fit.below(length / h.fins, "housing.fin_spacing", f" for {h.fins} fins")
    if h.kind == "spiral":
        fit.below(0.9 * stack / (h.turns + 1), "housing.rib")
        fit.below(0.8 * ((stack - h.rib) / h.turns - h.rib), "housing.port", ", the channel")
        fit.need(not too_near(nozzles(g, at)), "housing.port", "less, to keep the ports apart")
    if g.base.kind != "none":
        fit.below(1.8 * at.body, "foot.width")
        fit.need(g.foot.width <= g.base.width, "base.width", "at least the foot")
        fit.need(g.foot.length <= g.base.length, "base.length", "at least the foot")
        fit.need(
            g.foot.length < g.stator.stack_length,
            "foot.length",
            f"less than the stack, {g.stator.stack_length * mm:.4g} mm",
        )


def check_magnets(g: Geometry, at: Layout) -> None:
    """Magnets stay inside the rotor, off the shaft and apart from each other."""
    import shapely

    fit, r, pitch = Fit(g), g.rotor, 2 * at.rotor * math.sin(math.pi / g.rotor.poles)
    span = r.magnet_width * (1 if r.magnet_shape == "flat" else 2 * math.cos(r.v))
    fit.need(span < pitch, "rotor.magnet_width", "less than the pole pitch")
    rise = r.magnet_width / 2 if r.magnet_shape == "flat" else r.bridge / 2 + r.magnet_width * math.cos(r.v)
    fit.need(rise < at.rotor - r.bridge, "rotor.magnet_width", "less, to lie inside the rotor")
    magnets = shapely.polygons([[(x, y) for x, y, _ in magnet.outer] for magnet in shapes_of_magnets(g, at)])
    farthest = (shapely.get_coordinates(magnets) ** 2).sum(axis=1).max()
    limit = max(0.998 * at.rotor, at.rotor - 0.9 * r.bridge)
    fit.need(farthest < limit**2, "rotor.bridge", "more, to keep the magnets under the surface")
    nearest = shapely.distance(magnets, shapely.Point(0, 0)).min()
    fit.need(nearest > 1.02 * g.shaft.diameter / 2, "rotor.magnet_thickness", "less, to clear the shaft")
    tree, clearance = shapely.STRtree(magnets), min(5e-4, 0.004 * pitch)
    near, far = tree.query(magnets, predicate="dwithin", distance=clearance)
    fit.need(bool((near == far).all()), "rotor.magnet_width", "less, to keep the magnets apart")


def check_cage(g: Geometry, at: Layout) -> None:
    """Bars leave teeth between them and stay off the shaft."""
    fit, bottom = Fit(g), at.rotor - g.rotor.bar_depth
    fit.below(at.rotor - 0.55 * g.shaft.diameter, "rotor.bar_depth", ", where the shaft begins")
    fit.below(0.9 * 2 * math.pi * bottom / g.rotor.bars, "rotor.bar_width")
    fit.below(0.95 * (at.core0 - at.cap0), "rotor.ring", ", the end space")
