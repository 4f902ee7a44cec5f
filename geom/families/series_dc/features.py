"""What formulas ask of a series-wound machine beside its solids."""

import math

from geom.description.geometry import Duct, Features, Geometry, PoleCoils, SeriesWound
from geom.description.shapes import evenly
from geom.families.series_dc.layout import Axial


def features(g: Geometry) -> Features:
    """Field coils around the poles, ways for air beside the gap, and where the losses are."""
    z = Axial(g)
    armature = ("winding.armature", "winding.armature.left", "winding.armature.right")
    sliding = ("commutator", "brushes") if g.brushes.arms else ("commutator",)
    bearings = ("bearing.left", "bearing.right")
    number, d = g.rotor.ducts, g.rotor.duct_diameter
    length = g.rotor.stack_length
    in_rotor = Duct(number * math.pi * d**2 / 4, number * math.pi * d, length, turns=True)
    return Features(
        air_gap=g.stator.air_gap,
        coils={"winding.field": _coils(g, z)},
        shoes={"poles": g.stator.shoe},
        fan_space="air.fan" if g.fan.depth else "",
        ducts={"air.interpolar": _between_poles(g), **({"air.ducts": in_rotor} if number else {})},
        series=SeriesWound(armature, "winding.field", "rotor.core", "poles", sliding, bearings),
    )


def _coils(g: Geometry, z: Axial) -> PoleCoils:
    """The wire runs along the axis beside a pole and across it at the ends."""
    half = (z.core1 - z.core0) / 2 + g.field.insulation
    width = g.stator.body_width / 2 + g.field.insulation
    return PoleCoils(tuple(evenly(g.stator.poles, math.pi / 2)), (z.core0 + z.core1) / 2, half, width)


def _between_poles(g: Geometry) -> Duct:
    bore = g.rotor.outer_diameter / 2 + g.stator.air_gap
    poles, body = g.stator.poles, g.stator.body_width
    depth = g.stator.yoke_inner_diameter / 2 - bore
    coils = 2 * poles * g.field.coil_width * g.field.coil_height
    area = math.pi * (bore + depth) ** 2 - math.pi * bore**2 - poles * body * depth - coils
    perimeter = 2 * math.pi * (2 * bore + depth) + 2 * poles * (depth - body)
    return Duct(area, perimeter, g.rotor.stack_length)
