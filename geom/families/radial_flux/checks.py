"""Values that are allowed one by one but do not fit together."""

from __future__ import annotations

import math

from geom.description.geometry import Geometry, Group
from geom.description.parameters import impossible
from geom.families.nozzles import too_near
from geom.families.radial_flux.housing import nozzles
from geom.families.radial_flux.layout import Layout
from geom.families.radial_flux.rotors import shapes_of_magnets
from geom.families.shaft_fan import Rule, fan_rules

mm = 1e3


def check(g: Geometry, at: Layout) -> None:
    """Raise InputError for the first rule that does not hold."""
    refuse((*_stator_rules(g, at), *_frame_rules(g, at), *_housing_rules(g, at), *_cowl(g, at)))


def _cowl(g: Geometry, at: Layout) -> tuple[Rule, ...]:
    return fan_rules(g.fan, g.shaft.diameter, g.bearing.outer_diameter, 2 * at.cap_radius)


def refuse(rules: tuple[Rule, ...]) -> None:
    for holds, key, value, right in rules:
        if not holds:
            raise impossible(f"{value:.4g} does not fit", key, f"must be {right}")


def _stator_rules(g: Geometry, at: Layout) -> tuple[Rule, ...]:
    s = g.stator
    widest = 2 * at.slot0 * math.sin(math.pi / s.slots)
    lining = 2 * (s.liner + s.liner_gap)
    return (
        (s.air_gap < at.bore - g.shaft.diameter / 2, "stator.air_gap_mm", s.air_gap * mm, "less, to leave a rotor"),
        (
            s.tip + lining < 0.8 * s.slot_depth,
            "stator.slot_depth_mm",
            s.slot_depth * mm,
            f"more than {1.25 * (s.tip + lining) * mm:.4g} mm, for tip, liner and winding",
        ),
        (
            at.slot1 < 0.98 * at.core,
            "stator.slot_depth_mm",
            s.slot_depth * mm,
            f"less than {(0.98 * at.core - at.bore) * mm:.4g} mm, where the laminations end",
        ),
        *(
            _parallel_slot(s, widest, lining)
            if at.slot_width is not None
            else (
                (
                    at.wire_tooth < 0.85 * widest,
                    "stator.tooth_mm",
                    s.tooth * mm,
                    f"less than {(0.85 * widest - lining) * mm:.4g} mm, to leave room for liner and winding",
                ),
            )
        ),
        (
            s.opening < 1.8 * at.slot0 * math.sin(max(at.half_angle(at.slot0), 0.0)),
            "stator.opening_mm",
            s.opening * mm,
            "narrower than the slot",
        ),
        (s.wedge <= s.tip, "stator.wedge_mm", s.wedge * mm, f"at most the tooth tip, {s.tip * mm:.4g} mm"),
        (
            g.winding.kind == "distributed" or s.opening < 0.5 * widest,
            "stator.opening_mm",
            s.opening * mm,
            f"less than {0.5 * widest * mm:.4g} mm, to leave end windings on the teeth",
        ),
    )


def _parallel_slot(s: Group, widest: float, lining: float) -> tuple[Rule, ...]:
    return (
        (
            s.slot_width < 0.85 * widest,
            "stator.slot_width_mm",
            s.slot_width * mm,
            f"less than {0.85 * widest * mm:.4g} mm, to leave teeth",
        ),
        (
            lining < 0.8 * s.slot_width,
            "stator.slot_width_mm",
            s.slot_width * mm,
            f"more than {1.25 * lining * mm:.4g} mm, for liner and winding",
        ),
    )


def _frame_rules(g: Geometry, at: Layout) -> tuple[Rule, ...]:
    needed = g.stator.stack_length + 2 * (
        g.winding.straight + g.winding.end + g.frame.cap + min(0.001, 0.005 * at.core)
    )
    rules = (
        (
            g.shaft.diameter < g.bearing.outer_diameter,
            "bearing.outer_diameter_mm",
            g.bearing.outer_diameter * mm,
            f"more than the shaft, {g.shaft.diameter * mm:.4g} mm",
        ),
        (
            g.bearing.outer_diameter / 2 < at.core,
            "bearing.outer_diameter_mm",
            g.bearing.outer_diameter * mm,
            f"less than the stator, {2 * at.core * mm:.4g} mm",
        ),
        (needed < at.length, "frame.length_mm", at.length * mm, f"more than {needed * mm:.4g} mm, for all it holds"),
    )
    skirt: Rule = (
        g.frame.skirt < 0.9 * (at.core - at.wire1),
        "frame.skirt_mm",
        g.frame.skirt * mm,
        f"less than {0.9 * (at.core - at.wire1) * mm:.4g} mm, to clear the end winding",
    )
    return (*rules, skirt) if g.housing.kind == "none" else rules


def _housing_rules(g: Geometry, at: Layout) -> tuple[Rule, ...]:
    around, h = 2 * math.pi * at.wall, g.housing
    along = at.cap1 - at.cap0
    turn = (at.core1 - at.core0) / (h.turns + 1)
    pitch = h.fin_spacing or (around if h.kind == "axial-fins" else along) / h.fins
    limits = {kind: 0.9 * pitch for kind in ("axial-fins", "radial-fins")}
    lengths = {"axial-fins": around, "radial-fins": along}
    rules: list[Rule] = []
    if h.kind in limits:
        rules += [
            (
                h.fin_thickness < limits[h.kind],
                "housing.fin_thickness_mm",
                h.fin_thickness * mm,
                f"less than {limits[h.kind] * mm:.4g} mm: {h.fins} fins overlap otherwise",
            )
        ]
        rules += [
            (
                h.fins * h.fin_spacing < lengths[h.kind],
                "housing.fin_spacing_mm",
                h.fin_spacing * mm,
                f"less than {lengths[h.kind] / h.fins * mm:.4g} mm for {h.fins} fins",
            )
        ]
    if h.kind == "spiral":
        wide = (at.core1 - at.core0 - h.rib) / h.turns - h.rib
        rules += [
            (h.rib < 0.9 * turn, "housing.rib_mm", h.rib * mm, f"less than {0.9 * turn * mm:.4g} mm"),
            (h.port < 0.8 * wide, "housing.port_mm", h.port * mm, f"less than {0.8 * wide * mm:.4g} mm, the channel"),
            (
                h.port >= 0.8 * wide or not too_near(nozzles(g, at)),
                "housing.port_mm",
                h.port * mm,
                "less, to keep the ports apart",
            ),
        ]
    if g.base.kind != "none":
        limit = 1.8 * at.body
        rules += [
            (g.foot.width < limit, "foot.width_mm", g.foot.width * mm, f"less than {limit * mm:.4g} mm"),
            (g.foot.width <= g.base.width, "base.width_mm", g.base.width * mm, "at least the foot"),
            (g.foot.length <= g.base.length, "base.length_mm", g.base.length * mm, "at least the foot"),
            (
                g.foot.length < g.stator.stack_length,
                "foot.length_mm",
                g.foot.length * mm,
                f"less than the stack, {g.stator.stack_length * mm:.4g} mm",
            ),
        ]
    return tuple(rules)


def check_magnets(g: Geometry, at: Layout) -> None:
    """Magnets stay inside the rotor, off the shaft and apart from each other."""
    import shapely

    r = g.rotor
    span = r.magnet_width * (1 if r.magnet_shape == "flat" else 2 * math.cos(r.v))
    refuse(
        (
            (
                span < 2 * at.rotor * math.sin(math.pi / r.poles),
                "rotor.magnet_width_mm",
                r.magnet_width * mm,
                "less than the pole pitch",
            ),
        )
    )
    magnets = shapely.polygons([[(x, y) for x, y, _ in magnet.outer] for magnet in shapes_of_magnets(g, at)])
    corners = shapely.get_coordinates(magnets)
    limit = max(0.998 * at.rotor, at.rotor - 0.9 * r.bridge)
    inside = bool((corners**2).sum(axis=1).max() < limit**2)
    clear = shapely.distance(magnets, shapely.Point(0, 0)).min() > 1.02 * g.shaft.diameter / 2
    clearance = 0.004 * 2 * at.rotor * math.sin(math.pi / r.poles)
    near, far = shapely.STRtree(magnets).query(magnets, predicate="dwithin", distance=min(5e-4, clearance))
    refuse(
        (
            (inside, "rotor.bridge_mm", r.bridge * mm, "more, to keep the magnets under the surface"),
            (bool(clear), "rotor.magnet_thickness_mm", r.magnet_thickness * mm, "less, to clear the shaft"),
            (
                bool((near == far).all()),
                "rotor.magnet_width_mm",
                r.magnet_width * mm,
                "less, to keep the magnets apart",
            ),
        )
    )


def check_cage(g: Geometry, at: Layout) -> None:
    """Bars leave teeth between them and stay off the shaft."""
    r = g.rotor
    bottom = at.rotor - r.bar_depth
    pitch = 2 * math.pi * bottom / r.bars
    end = at.core0 - at.cap0
    refuse(
        (
            (
                bottom > 0.55 * g.shaft.diameter,
                "rotor.bar_depth_mm",
                r.bar_depth * mm,
                f"less than {(at.rotor - 0.55 * g.shaft.diameter) * mm:.4g} mm, where the shaft begins",
            ),
            (r.bar_width < 0.9 * pitch, "rotor.bar_width_mm", r.bar_width * mm, f"less than {0.9 * pitch * mm:.4g} mm"),
            (r.ring < 0.95 * end, "rotor.ring_mm", r.ring * mm, f"less than {0.95 * end * mm:.4g} mm, the end space"),
        )
    )
