"""Parameters of the series-wound DC motor."""

from __future__ import annotations

from geom.description.parameters import Parameter, choice, length
from geom.families.series_dc import scales as of
from geom.families.shaft_fan import fan_parameters

P = Parameter
PARAMETERS = (
    length(
        "shaft.length", 440, 100, 3000, of.content(1.015, 1.4), "overall length of the machine, shaft end to shaft end"
    ),
    length("shaft.bearing_diameter", 70, 10, 400, of.core(0.5, 0.95), "shaft diameter in the bearings"),
    length("shaft.core_diameter", 90, 12, 600, of.rotor(0.2, 0.45), "shaft diameter inside the rotor core"),
    length("shaft.hub_diameter", 124, 14, 800, of.hub(0.05, 0.7), "shaft diameter under the commutator"),
    length(
        "rotor.outer_diameter", 290, 40, 2000, None, "rotor core, over the teeth", like="stator.yoke_inner_diameter_mm"
    ),
    length("rotor.stack_length", 200, 20, 1500, of.rotor(0.3, 1.5), "length of the laminated core and of the poles"),
    P("rotor.slots", 46, 8, 200, "number of armature slots"),
    length("rotor.slot_width", 9, 1, 60, of.slot_pitch(0.3, 0.7), "parallel-sided slot, before the liner"),
    length("rotor.slot_depth", 32, 3, 200, of.iron(0.15, 0.45), "rotor surface to slot bottom"),
    length("rotor.liner", 0.3, 0.05, 3, of.slot(0.01, 0.08), "thickness of the slot liner"),
    length(
        "rotor.wedge", 3, 0.3, 20, of.depth(0.03, 0.2), "insulating closure at the slot opening, part of slot.liner"
    ),
    length("rotor.straight", 8, 1, 100, of.rotor(0.01, 0.06), "straight length of the coils outside the core"),
    length("rotor.end_winding", 37, 3, 400, of.rotor(0.05, 0.25), "axial length of the end-winding ring"),
    P("rotor.ducts", 0, 2, 60, "axial air ducts through the rotor core", off=True),
    length("rotor.duct_diameter", 16, 2, 200, of.duct(0.2, 0.8), "diameter of an air duct"),
    P("rotor.fill", 0.45, 0.05, 0.9, "share of conductor in the slot, inside the liner"),
    P("rotor.end_fill", 0.35, 0.05, 0.9, "share of conductor in the end winding"),
    P("rotor.impregnation", 1.0, 0.0, 1.0, "share of the space between wires in the slot that resin fills"),
    P("rotor.end_impregnation", 1.0, 0.0, 1.0, "the same in the end winding"),
    P("commutator.bars", 0, 3, 400, "bars with mica between them; 0 is one homogeneous body", off=True),
    length("commutator.mica", 0.8, 0.2, 5, of.bar(0.05, 0.3), "mica between bars, and between bars and hub"),
    length("commutator.diameter", 200, 20, 1500, of.brushes(0.2, 0.95), "brush surface"),
    length("commutator.length", 47, 5, 600, of.rotor(0.08, 0.4), "axial length of the brush surface"),
    length("commutator.riser", 8, 1, 60, of.rotor(0.01, 0.06), "axial thickness of the risers that join the winding"),
    P("stator.poles", 4, 2, 12, "number of main poles"),
    length("stator.air_gap", 2, 0.3, 20, of.rotor(0.003, 0.02), "rotor surface to pole shoe"),
    P("stator.pole_arc", 0.65, 0.3, 0.9, "pole shoe arc divided by the pole pitch"),
    length("stator.tip", 8, 1, 60, of.shoe(0.3, 0.95), "radial thickness of the shoe at its tips"),
    length("stator.shoe", 9, 1, 100, of.rotor(0.02, 0.08), "radial thickness of the shoe in the middle"),
    length("stator.body_width", 92, 5, 800, of.shoe_width(0.3, 0.85), "width of the pole body"),
    length("stator.yoke_inner_diameter", 408, 50, 3000, of.corner(1.01, 1.2), "bore of the yoke"),
    length("stator.yoke_thickness", 30, 3, 300, of.yoke(0.03, 0.15), "radial thickness of the yoke"),
    length("stator.yoke_overhang", 35, 0, 500, of.stack(0.03, 0.4), "yoke beyond the poles, on either side"),
    length("field.coil_width", 26, 2, 300, of.between(0.15, 0.8), "field coil, along the pole pitch"),
    length("field.coil_height", 30, 2, 300, of.rotor(0.04, 0.2), "field coil, along the radius"),
    P("field.fill", 0.7, 0.05, 0.95, "share of conductor in the field coil"),
    P("field.impregnation", 1.0, 0.0, 1.0, "share of the space between its turns that resin fills"),
    length("field.insulation", 1.5, 0.1, 10, of.between(0.01, 0.08), "insulation between field coil and pole body"),
    length("field.clearance", 2, 0.1, 50, of.rotor(0.002, 0.03), "shoe back to field coil"),
    length("housing.thickness", 6, 1, 100, of.yoke(0.005, 0.05), "wall of the housing"),
    P("housing.fins", 36, 0, 200, "number of axial fins, those in the way of the feet included"),
    length("housing.fin_height", 18, 1, 150, of.shell(0.02, 0.2), "radial height of a fin"),
    length("housing.fin_thickness", 4, 0.5, 40, of.fin_pitch(0.05, 0.65), "thickness of a fin"),
    length(
        "housing.fin_spacing",
        0,
        0,
        500,
        of.even_pitch(0.5, 0.98),
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
    length("jacket.height", 12, 1, 80, of.shell(0.02, 0.1), "radial height of a channel"),
    length("jacket.rib", 8, 1, 80, of.rib(0.1, 0.5), "wall between neighbouring channels or turns, and at the ends"),
    length(
        "jacket.wall",
        5,
        1,
        60,
        of.shell(0.01, 0.05),
        "outer wall of the jacket; the inner wall is housing.thickness_mm",
    ),
    length("jacket.port", 10, 1, 100, of.port(0.15, 0.6), "bore of inlet and outlet"),
    length("flange.thickness", 24, 2, 200, of.rotor(0.03, 0.15), "end flanges; the bearings are as wide"),
    length("flange.shaft_end", 12, 1, 500, of.rotor(0.01, 0.3), "shaft beyond the outer face of a flange, both sides"),
    length(
        "flange.rotor_offset", 59, 5, 600, of.overhang(1.05, 2.0), "inner face of the left flange to the rotor core"
    ),
    *fan_parameters(
        "flange",
        {"depth": of.rotor, "wall": of.shell, "cowl": of.fan, "hub": of.fan_hub},
        diameter=300.0,
        cowl=2.0,
        hub=110.0,
        within=0.9,
    ),
    length("bearing.outer_diameter", 125, 15, 700, of.seat(1.3, 2.2), "bearing seat"),
    length("feet.shaft_height", 280, 50, 2000, of.outermost(1.04, 1.6), "axis above the base plate"),
    length("feet.inner", 120, 0, 1500, of.shell(0.1, 0.6), "axis to the inner side of a foot, horizontally"),
    length("feet.width", 60, 3, 500, of.beside(0.2, 0.9), "width of a foot"),
    length("feet.length", 40, 3, 500, of.inside(0.05, 0.2), "axial length of each of the four feet"),
    length("feet.inset", 25, 0, 500, of.inside(0.02, 0.15), "inner face of a flange to the nearest foot"),
    length("base.width", 700, 20, 5000, of.stance(1.05, 2.5), "base plate, across the axis"),
    length("base.length", 360, 20, 5000, of.footing(1.01, 2.0), "base plate, along the axis, centred on the housing"),
    length("base.thickness", 20, 1, 300, of.shell(0.02, 0.2), "base plate"),
    P("brushes.arms", 0, 2, 24, "rows of brushes, each on an arm from the right flange; 0 leaves them out", off=True),
    length("brushes.height", 20, 1, 200, of.above(0.3, 0.6), "carbon: commutator to arm"),
    length("brushes.arm", 6, 0.5, 60, of.above(0.08, 0.25), "radial thickness of an arm"),
    P("brushes.arc", 0.25, 0.05, 0.6, "share of the way from row to row that a carbon covers"),
)
