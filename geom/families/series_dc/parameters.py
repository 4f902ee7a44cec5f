"""Parameters of the series-wound DC motor: parameters.csv has them.

Here stands what their lengths are measured in, so that any ratios fit together: a bound is where a rule of checks.py
would begin, with room to spare for what the other ratios may do.
"""

import math
from pathlib import Path

from geom.description.geometry import Duct, Features, Geometry, PoleCoils, SeriesWound
from geom.description.parameters import Measure, parameter_sets
from geom.description.shapes import evenly
from geom.families.series_dc.layout import Axial, Radii
from geom.families.shaft_fan import fan_measures

STEEPEST = math.pi / 4  # of the line between two poles, where there are fewer than four


def _bottom(g: Geometry) -> float:
    return g.rotor.outer_diameter / 2 - g.rotor.slot_depth


def _duct(g: Geometry) -> float:
    room, middle = _bottom(g) - g.shaft.core_diameter / 2, (_bottom(g) + g.shaft.core_diameter / 2) / 2
    return min(room, 2 * middle * math.sin(math.pi / g.rotor.ducts)) if g.rotor.ducts > 1 else room


def _bar(g: Geometry) -> float:
    around = math.pi * g.commutator.diameter / (g.commutator.bars or 100)
    return min(around, (g.commutator.diameter - g.shaft.hub_diameter) / 2)


rotor = Measure("the rotor's diameter", lambda g: g.rotor.outer_diameter)
stack = Measure("the stack's length", lambda g: g.rotor.stack_length)
core = Measure("the shaft in the core", lambda g: g.shaft.core_diameter)
seat = Measure("the shaft in the bearings", lambda g: g.shaft.bearing_diameter)
iron = Measure("rotor surface to shaft", lambda g: (g.rotor.outer_diameter - g.shaft.core_diameter) / 2)
slot_pitch = Measure("the slot pitch at the slot bottom", lambda g: 2 * math.pi * _bottom(g) / g.rotor.slots)
slot = Measure("slot width or depth, the smaller", lambda g: min(g.rotor.slot_width, g.rotor.slot_depth))
depth = Measure("the slot's depth", lambda g: g.rotor.slot_depth)
duct = Measure("shaft to slots or duct to duct, the smaller", _duct)
hub = Measure(
    "the way from the shaft in the core to the winding's diameter",
    lambda g: 2 * (_bottom(g) + g.rotor.liner) - g.shaft.core_diameter,
    core.span,
)
brushes = Measure(
    "the way from the hub's diameter to the winding's",
    lambda g: g.rotor.outer_diameter - 2 * g.rotor.wedge - g.shaft.hub_diameter,
    lambda g: g.shaft.hub_diameter,
)
bar = Measure("a bar's pitch or height, the smaller", _bar)


def _bore(g: Geometry) -> float:
    return g.rotor.outer_diameter / 2 + g.stator.air_gap


def _between(g: Geometry) -> float:
    """Pole body to the middle between two poles, at the inner side of the coil."""
    inner = _bore(g) + g.stator.shoe + g.field.clearance
    return inner * math.tan(min(math.pi / g.stator.poles, STEEPEST)) - g.stator.body_width / 2


def _corner(g: Geometry) -> float:
    top = _bore(g) + g.stator.shoe + g.field.clearance + g.field.coil_height
    return 2 * math.hypot(top, g.stator.body_width / 2 + g.field.insulation + g.field.coil_width)


def _overhang(g: Geometry) -> float:
    return max(g.rotor.straight + g.rotor.end_winding, g.field.insulation + g.field.coil_width, g.stator.yoke_overhang)


def _content(g: Geometry) -> float:
    """From one end of the shaft to the other, with no room to spare on the right."""
    after = g.rotor.straight + g.rotor.end_winding + g.commutator.riser + g.commutator.length
    ends = 2 * (g.flange.shaft_end + g.flange.thickness) + g.fan.depth
    return ends + g.flange.rotor_offset + g.rotor.stack_length + max(after, _overhang(g))


shoe = Measure("the shoe in the middle", lambda g: g.stator.shoe)
shoe_width = Measure(
    "the shoe's width", lambda g: 2 * (_bore(g) + g.stator.tip) * math.sin(math.pi / g.stator.poles * g.stator.pole_arc)
)
between = Measure("pole body to the middle between two poles", _between)
corner = Measure("the circle around the field coils", _corner)
yoke = Measure("the yoke's bore", lambda g: g.stator.yoke_inner_diameter)
overhang = Measure("end winding, field coil or yoke beyond the core, the longest", _overhang)
content = Measure("all that the shaft carries", _content)


def _shell(g: Geometry) -> float:
    return g.stator.yoke_inner_diameter / 2 + g.stator.yoke_thickness + g.housing.thickness


def _even_pitch(g: Geometry) -> float:
    return 2 * math.pi * _shell(g) / max(g.housing.fins, 1)


def _inside(g: Geometry) -> float:
    return g.shaft.length - 2 * (g.flange.shaft_end + g.flange.thickness) - g.fan.depth


def _jacket_length(g: Geometry) -> float:
    return _inside(g) / 2 - g.feet.inset - g.feet.length


def _around(g: Geometry) -> float:
    return 2 * math.pi * _shell(g) / g.jacket.channels


def _rib(g: Geometry) -> float:
    length = _jacket_length(g)
    return min(_around(g) if g.jacket.layout == "zigzag" else length / (g.jacket.turns + 1), length / 2.5)


def _port(g: Geometry) -> float:
    length, around, turns = _jacket_length(g), _around(g), g.jacket.turns
    if g.jacket.layout == "zigzag":
        wide = min(min(around, length / 2) - g.jacket.rib, 0.8 * around)
    else:
        wide = (length - g.jacket.rib) / turns - g.jacket.rib
        wide = wide if turns > 1 else 0.6 * wide  # both ports on one turn
    return min(wide, 3 * g.jacket.rib, _shell(g) / 4)


shell = Measure("the housing's radius", _shell)
even_pitch = Measure("the pitch of fins spread evenly", _even_pitch)
fin_pitch = Measure(
    "the fins' pitch, or 0.6 of the housing's radius where it is less",
    lambda g: min(g.housing.fin_spacing or _even_pitch(g), 0.6 * _shell(g)),
)
inside = Measure("flange to flange", _inside)
rib = Measure("a channel with its rib, or 0.4 of the jacket's length, the smaller", _rib)
port = Measure(
    "the channel's width (0.6 of it with one turn), three ribs or a quarter of the housing's radius, the smallest",
    _port,
)
fan, fan_hub = fan_measures("housing", _shell, seat.span)
outermost = Measure(
    "the radius over fins or jacket", lambda g: max(Radii(g).fins, Radii(g).jacket) if g.jacket.sides else Radii(g).fins
)
beside = Measure("the inner side of a foot to the edge of the housing", lambda g: 0.95 * _shell(g) - g.feet.inner)
stance = Measure("the width over the feet", lambda g: 2 * (g.feet.inner + g.feet.width))
footing = Measure("the length over the feet", lambda g: _inside(g) - 2 * g.feet.inset)
above = Measure(
    "the armature's radius over the commutator's", lambda g: (g.rotor.outer_diameter - g.commutator.diameter) / 2
)


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


_MEASURES = {name: measure for name, measure in globals().items() if isinstance(measure, Measure)}
PARAMETERS = parameter_sets(Path(__file__).with_name("parameters.csv"), _MEASURES)["all"]
