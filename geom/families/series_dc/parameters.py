"""Parameters of the series-wound DC motor.

First what their lengths are measured in, so that any ratios fit together: a bound is where a rule of checks.py would
begin, with room to spare for what the other ratios may do.
"""

from __future__ import annotations

import math

from geom.description.geometry import Geometry
from geom.description.parameters import Measure, Parameter, choice
from geom.description.parameters import length as mm
from geom.families.series_dc.layout import Radii
from geom.families.shaft_fan import fan_measures, fan_parameters

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


def _outermost(g: Geometry) -> float:
    r = Radii(g)
    return max(r.fins, r.jacket) if g.jacket.sides else r.fins


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
outermost = Measure("the radius over fins or jacket", _outermost)
beside = Measure("the inner side of a foot to the edge of the housing", lambda g: 0.95 * _shell(g) - g.feet.inner)
stance = Measure("the width over the feet", lambda g: 2 * (g.feet.inner + g.feet.width))
footing = Measure("the length over the feet", lambda g: _inside(g) - 2 * g.feet.inset)
above = Measure(
    "the armature's radius over the commutator's", lambda g: (g.rotor.outer_diameter - g.commutator.diameter) / 2
)

P = Parameter
PARAMETERS = (
    mm("shaft.length", 440, 100, 3000, content(1.015, 1.4), "overall length of the machine, shaft end to shaft end"),
    mm("shaft.bearing_diameter", 70, 10, 400, core(0.5, 0.95), "shaft diameter in the bearings"),
    mm("shaft.core_diameter", 90, 12, 600, rotor(0.2, 0.45), "shaft diameter inside the rotor core"),
    mm("shaft.hub_diameter", 124, 14, 800, hub(0.05, 0.7), "shaft diameter under the commutator"),
    mm("rotor.outer_diameter", 290, 40, 2000, None, "rotor core, over the teeth", like="stator.yoke_inner_diameter_mm"),
    mm("rotor.stack_length", 200, 20, 1500, rotor(0.3, 1.5), "length of the laminated core and of the poles"),
    P("rotor.slots", 46, 8, 200, "number of armature slots"),
    mm("rotor.slot_width", 9, 1, 60, slot_pitch(0.3, 0.7), "parallel-sided slot, before the liner"),
    mm("rotor.slot_depth", 32, 3, 200, iron(0.15, 0.45), "rotor surface to slot bottom"),
    mm("rotor.liner", 0.3, 0.05, 3, slot(0.01, 0.08), "thickness of the slot liner"),
    mm("rotor.wedge", 3, 0.3, 20, depth(0.03, 0.2), "insulating closure at the slot opening, part of slot.liner"),
    mm("rotor.straight", 8, 1, 100, rotor(0.01, 0.06), "straight length of the coils outside the core"),
    mm("rotor.end_winding", 37, 3, 400, rotor(0.05, 0.25), "axial length of the end-winding ring"),
    P("rotor.ducts", 0, 2, 60, "axial air ducts through the rotor core", off=True),
    mm("rotor.duct_diameter", 16, 2, 200, duct(0.2, 0.8), "diameter of an air duct"),
    P("rotor.fill", 0.45, 0.05, 0.9, "share of conductor in the slot, inside the liner"),
    P("rotor.end_fill", 0.35, 0.05, 0.9, "share of conductor in the end winding"),
    P("rotor.impregnation", 1.0, 0.0, 1.0, "share of the space between wires in the slot that resin fills"),
    P("rotor.end_impregnation", 1.0, 0.0, 1.0, "the same in the end winding"),
    P("commutator.bars", 0, 3, 400, "bars with mica between them; 0 is one homogeneous body", off=True),
    mm("commutator.mica", 0.8, 0.2, 5, bar(0.05, 0.3), "mica between bars, and between bars and hub"),
    mm("commutator.diameter", 200, 20, 1500, brushes(0.2, 0.95), "brush surface"),
    mm("commutator.length", 47, 5, 600, rotor(0.08, 0.4), "axial length of the brush surface"),
    mm("commutator.riser", 8, 1, 60, rotor(0.01, 0.06), "axial thickness of the risers that join the winding"),
    P("stator.poles", 4, 2, 12, "number of main poles"),
    mm("stator.air_gap", 2, 0.3, 20, rotor(0.003, 0.02), "rotor surface to pole shoe"),
    P("stator.pole_arc", 0.65, 0.3, 0.9, "pole shoe arc divided by the pole pitch"),
    mm("stator.tip", 8, 1, 60, shoe(0.3, 0.95), "radial thickness of the shoe at its tips"),
    mm("stator.shoe", 9, 1, 100, rotor(0.02, 0.08), "radial thickness of the shoe in the middle"),
    mm("stator.body_width", 92, 5, 800, shoe_width(0.3, 0.85), "width of the pole body"),
    mm("stator.yoke_inner_diameter", 408, 50, 3000, corner(1.01, 1.2), "bore of the yoke"),
    mm("stator.yoke_thickness", 30, 3, 300, yoke(0.03, 0.15), "radial thickness of the yoke"),
    mm("stator.yoke_overhang", 35, 0, 500, stack(0.03, 0.4), "yoke beyond the poles, on either side"),
    mm("field.coil_width", 26, 2, 300, between(0.15, 0.8), "field coil, along the pole pitch"),
    mm("field.coil_height", 30, 2, 300, rotor(0.04, 0.2), "field coil, along the radius"),
    P("field.fill", 0.7, 0.05, 0.95, "share of conductor in the field coil"),
    P("field.impregnation", 1.0, 0.0, 1.0, "share of the space between its turns that resin fills"),
    mm("field.insulation", 1.5, 0.1, 10, between(0.01, 0.08), "insulation between field coil and pole body"),
    mm("field.clearance", 2, 0.1, 50, rotor(0.002, 0.03), "shoe back to field coil"),
    mm("housing.thickness", 6, 1, 100, yoke(0.005, 0.05), "wall of the housing"),
    P("housing.fins", 36, 0, 200, "number of axial fins, those in the way of the feet included"),
    mm("housing.fin_height", 18, 1, 150, shell(0.02, 0.2), "radial height of a fin"),
    mm("housing.fin_thickness", 4, 0.5, 40, fin_pitch(0.05, 0.65), "thickness of a fin"),
    mm(
        "housing.fin_spacing",
        0,
        0,
        500,
        even_pitch(0.5, 0.98),
        "fin to fin at the root, centred on top; 0 spreads them evenly",
        off=True,
    ),
    P("jacket.sides", 0, 0, 2, "liquid jackets: 0 none, 1 on the left half of the housing, 2 on both halves"),
    choice(
        "jacket.layout",
        ("zigzag", "helical"),
        "axial channels in series, joined at alternate ends, or turns around the axis",
    ),
    P("jacket.channels", 24, 2, 120, "axial channels of a zigzag jacket"),
    P("jacket.turns", 4, 1, 40, "turns of a helical jacket; rings in the mesh, a helix in CAD files"),
    mm("jacket.height", 12, 1, 80, shell(0.02, 0.1), "radial height of a channel"),
    mm("jacket.rib", 8, 1, 80, rib(0.1, 0.5), "wall between neighbouring channels or turns, and at the ends"),
    mm("jacket.wall", 5, 1, 60, shell(0.01, 0.05), "outer wall of the jacket; the inner wall is housing.thickness_mm"),
    mm("jacket.port", 10, 1, 100, port(0.15, 0.6), "bore of inlet and outlet"),
    mm("flange.thickness", 24, 2, 200, rotor(0.03, 0.15), "end flanges; the bearings are as wide"),
    mm("flange.shaft_end", 12, 1, 500, rotor(0.01, 0.3), "shaft beyond the outer face of a flange, both sides"),
    mm("flange.rotor_offset", 59, 5, 600, overhang(1.05, 2.0), "inner face of the left flange to the rotor core"),
    *fan_parameters(
        "flange",
        {"depth": rotor, "wall": shell, "cowl": fan, "hub": fan_hub},
        diameter=300.0,
        cowl=2.0,
        hub=110.0,
        within=0.9,
    ),
    mm("bearing.outer_diameter", 125, 15, 700, seat(1.3, 2.2), "bearing seat"),
    mm("feet.shaft_height", 280, 50, 2000, outermost(1.04, 1.6), "axis above the base plate"),
    mm("feet.inner", 120, 0, 1500, shell(0.1, 0.6), "axis to the inner side of a foot, horizontally"),
    mm("feet.width", 60, 3, 500, beside(0.2, 0.9), "width of a foot"),
    mm("feet.length", 40, 3, 500, inside(0.05, 0.2), "axial length of each of the four feet"),
    mm("feet.inset", 25, 0, 500, inside(0.02, 0.15), "inner face of a flange to the nearest foot"),
    mm("base.width", 700, 20, 5000, stance(1.05, 2.5), "base plate, across the axis"),
    mm("base.length", 360, 20, 5000, footing(1.01, 2.0), "base plate, along the axis, centred on the housing"),
    mm("base.thickness", 20, 1, 300, shell(0.02, 0.2), "base plate"),
    P("brushes.arms", 0, 2, 24, "rows of brushes, each on an arm from the right flange; 0 leaves them out", off=True),
    mm("brushes.height", 20, 1, 200, above(0.3, 0.6), "carbon: commutator to arm"),
    mm("brushes.arm", 6, 0.5, 60, above(0.08, 0.25), "radial thickness of an arm"),
    P("brushes.arc", 0.25, 0.05, 0.6, "share of the way from row to row that a carbon covers"),
)
