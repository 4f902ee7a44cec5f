"""Parameters shared by machines with a slotted stator around a round rotor, and those of each rotor.

First what their lengths are measured in, so that any ratios fit together: a bound is where a rule of checks.py would
begin, with room to spare for what the other ratios may do.
"""

from __future__ import annotations

import math
from dataclasses import replace

from geom.description.geometry import Features, Geometry
from geom.description.parameters import Measure, Parameter, choice
from geom.description.parameters import length as mm
from geom.families.radial_flux.layout import Layout
from geom.families.radial_flux.magnets import widest
from geom.families.shaft_fan import fan_measures, fan_parameters

outer = Measure("the laminations' outer diameter", lambda g: g.stator.outer_diameter)
bore = Measure("the bore", lambda g: g.stator.bore_diameter)
shaft = Measure("the shaft's diameter", lambda g: g.shaft.diameter)
stack = Measure("the stack's length", lambda g: g.stator.stack_length)
build = Measure("bore to outside of the laminations", lambda g: (outer.span(g) - bore.span(g)) / 2)
depth = Measure("the slot's depth", lambda g: g.stator.slot_depth)
yoke = Measure("the yoke behind the slots", lambda g: build.span(g) - g.stator.slot_depth)
pitch = Measure("the slot pitch at the bore", lambda g: g.stator.bore_diameter * math.sin(math.pi / g.stator.slots))
lining = Measure("slot pitch or depth, the smaller", lambda g: min(pitch.span(g), g.stator.slot_depth))
mouth = Measure(
    "the slot's width at the bore",
    lambda g: g.stator.slot_width if g.stator.slot_shape == "parallel" else pitch.span(g) - g.stator.tooth,
)
tip = Measure("the tooth tip", lambda g: g.stator.tip)
content = Measure(
    "stack, end windings and end-caps together",
    lambda g: g.stator.stack_length + 2 * (g.winding.straight + g.winding.end + g.frame.cap),
)
length = Measure("the length over the end-caps", lambda g: g.frame.length)
turn = Measure("the stack's length over turns + 1", lambda g: g.stator.stack_length / (g.housing.turns + 1))


def features(g: Geometry) -> Features:
    """What formulas ask beside the solids."""
    return Features(air_gap=g.stator.air_gap)


def _even_pitch(g: Geometry) -> float:
    if g.housing.kind == "radial-fins":
        return (g.frame.length - 2 * g.frame.cap) / g.housing.fins
    return 2 * math.pi * (g.stator.outer_diameter / 2 + g.housing.thickness) / g.housing.fins


def _channel(g: Geometry) -> float:
    """Width of the jacket's channel; the two ports of a single turn share it."""
    wide = (g.stator.stack_length - g.housing.rib) / g.housing.turns - g.housing.rib
    return min(wide if g.housing.turns > 1 else 0.6 * wide, g.stator.outer_diameter / 6)


def _rotor(g: Geometry) -> float:
    return g.stator.bore_diameter / 2 - g.stator.air_gap


def _pole(g: Geometry) -> float:
    """Pole pitch at the rotor's surface or the iron under it, whichever is smaller."""
    return min(2 * _rotor(g) * math.sin(math.pi / g.rotor.poles), _rotor(g) - g.shaft.diameter / 2)


even_pitch = Measure("the pitch of fins spread evenly", _even_pitch)
fin_pitch = Measure(
    "the fins' pitch, or 0.3 of the laminations where it is less",
    lambda g: min(g.housing.fin_spacing or _even_pitch(g), 0.3 * g.stator.outer_diameter),
)
channel = Measure("the channel's width (0.6 of it with one turn), or a sixth of the laminations, the smaller", _channel)
pole = Measure("pole pitch or rotor iron, the smaller", _pole)
magnet = Measure("the widest magnet that fits", widest)
iron = Measure("rotor surface to shaft", lambda g: _rotor(g) - 0.55 * g.shaft.diameter)
bar_pitch = Measure(
    "the bars' pitch at their bottom", lambda g: 2 * math.pi * (_rotor(g) - g.rotor.bar_depth) / g.rotor.bars
)
end_space = Measure("stack to end-cap", lambda g: (g.frame.length - g.stator.stack_length) / 2 - g.frame.cap)
fan, fan_hub = fan_measures("end-cap", lambda g: Layout(g).cap_radius, lambda g: g.shaft.diameter)

P = Parameter
COMMON = (
    mm("frame.length", 290, 50, 3000, content(1.05, 1.6), "outer face to outer face of the end-caps"),
    mm("frame.cap", 20, 2, 200, outer(0.03, 0.12), "thickness of the end-caps; the bearings are as wide"),
    mm("frame.skirt", 8, 1, 100, yoke(0.1, 0.8), "without a housing: wall of the end-caps that rests on the stator"),
    mm("shaft.diameter", 50, 5, 500, bore(0.2, 0.5), "shaft"),
    mm("shaft.extension", 60, 0, 500, shaft(0.2, 3.0), "shaft beyond the right end-cap"),
    mm("bearing.outer_diameter", 90, 10, 700, shaft(1.3, 2.3), "bearing seat"),
    mm("stator.outer_diameter", 270, 30, 3000, None, "laminations", like="stator.bore_diameter_mm"),
    mm("stator.bore_diameter", 174, 20, 2500, outer(0.4, 0.8), "bore"),
    mm("stator.stack_length", 150, 10, 2000, bore(0.2, 2.5), "laminations, stator and rotor"),
    P("stator.slots", 18, 3, 200, "number of slots"),
    mm("stator.tooth", 15, 0.5, 200, pitch(0.3, 0.6), "width of the parallel-sided teeth"),
    mm("stator.slot_depth", 26, 2, 200, build(0.35, 0.8), "bore to slot bottom"),
    choice(
        "stator.slot_shape",
        ("tapered", "parallel"),
        "slots between parallel-sided teeth, or with parallel sides themselves",
    ),
    mm("stator.slot_width", 12, 0.5, 200, pitch(0.3, 0.65), "width of a slot with parallel sides"),
    mm("stator.tip", 3, 0.2, 30, depth(0.03, 0.15), "radial thickness of the tooth tips, depth of the slot opening"),
    mm("stator.opening", 3, 0.2, 30, mouth(0.1, 0.6), "width of the slot opening"),
    mm("stator.wedge", 0, 0, 30, tip(0.3, 0.95), "wedge that closes the slot opening; 0 is none", off=True),
    mm("stator.liner", 0.3, 0.05, 3, lining(0.005, 0.04), "thickness of the slot liner"),
    mm("stator.liner_gap", 0, 0, 5, lining(0.01, 0.06), "layer between liner and laminations; 0 is none", off=True),
    mm("stator.air_gap", 1, 0.2, 20, bore(0.002, 0.02), "rotor to bore"),
    choice("winding.kind", ("distributed", "concentrated"), "end windings as a ring, or as one arch on every tooth"),
    P("winding.fill", 0.45, 0.05, 0.9, "share of conductor in the slot, inside the liner"),
    P("winding.end_fill", 0.35, 0.05, 0.9, "share of conductor in the end winding"),
    P("winding.impregnation", 1.0, 0.0, 1.0, "share of the space between wires in the slot that resin fills"),
    P("winding.end_impregnation", 1.0, 0.0, 1.0, "the same in the end winding"),
    mm("winding.straight", 5, 0.5, 100, bore(0.01, 0.1), "straight length of the coils outside the stack"),
    mm("winding.end", 25, 2, 300, bore(0.05, 0.5), "axial length of the end-winding ring"),
    choice("housing.kind", ("none", "plain", "axial-fins", "radial-fins", "spiral"), "what surrounds the laminations"),
    mm("housing.thickness", 8, 1, 100, outer(0.01, 0.08), "wall of the housing"),
    P("housing.fins", 40, 1, 200, "number of fins"),
    mm("housing.fin_height", 20, 1, 150, outer(0.02, 0.15), "radial height of a fin"),
    mm("housing.fin_thickness", 4, 0.5, 40, fin_pitch(0.1, 0.65), "thickness of a fin"),
    mm(
        "housing.fin_spacing",
        0,
        0,
        500,
        even_pitch(0.5, 0.98),
        "fin to fin, centred on top or on the middle; 0 spreads them evenly",
        off=True,
    ),
    P("housing.turns", 6, 1, 40, "turns of a spiral jacket; rings in the mesh, a helix in CAD files"),
    mm("housing.channel", 10, 1, 80, outer(0.02, 0.08), "radial height of the jacket's channel"),
    mm("housing.rib", 5, 0.5, 80, turn(0.1, 0.4), "wall between turns, and at the ends"),
    mm("housing.wall", 5, 0.5, 60, outer(0.01, 0.05), "outer wall of the jacket"),
    mm("housing.port", 10, 1, 100, channel(0.15, 0.6), "bore of the jacket's inlet and outlet"),
    choice("base.kind", ("none", "plate"), "what the machine stands on"),
    mm("base.width", 300, 20, 5000, outer(0.9, 2.5), "base plate, across the axis"),
    mm("base.length", 1000, 20, 5000, length(1.0, 4.0), "base plate, along the axis, centred on the stack"),
    mm("base.thickness", 10, 1, 300, outer(0.02, 0.15), "base plate"),
    mm("foot.width", 120, 5, 2000, outer(0.2, 0.8), "pad between machine and base plate, across the axis"),
    mm("foot.length", 100, 5, 2000, stack(0.2, 0.9), "pad, along the axis, centred on the stack"),
    mm("foot.height", 40, 1, 500, outer(0.02, 0.3), "lowest point of the machine's body to the base plate"),
)
MAGNETS = (
    P("rotor.poles", 16, 2, 80, "number of magnet poles"),
    choice("rotor.magnet_shape", ("flat", "v"), "one magnet per pole, or two in a V"),
    mm("rotor.magnet_width", 22, 1, 300, magnet(0.4, 0.95), "width of a magnet in the plane"),
    mm("rotor.magnet_thickness", 5, 0.5, 60, pole(0.05, 0.2), "thickness of a magnet in the plane"),
    mm("rotor.bridge", 2, 0.2, 60, pole(0.02, 0.1), "least iron between magnet and rotor surface"),
    P("rotor.v_deg", 16.0, 0.0, 60.0, "tilt of each magnet of a V against the flat position"),
)
CAGE = (
    P("rotor.bars", 28, 5, 120, "number of cage bars"),
    mm("rotor.bar_width", 5, 0.5, 60, bar_pitch(0.25, 0.7), "parallel-sided bar, open to the air gap"),
    mm("rotor.bar_depth", 18, 1, 120, iron(0.15, 0.6), "rotor surface to bar bottom"),
    mm("rotor.ring", 14, 1, 100, end_space(0.1, 0.8), "axial thickness of the cage's end rings"),
)
FAN = fan_parameters(
    "end-cap",
    {"depth": outer, "wall": outer, "cowl": fan, "hub": fan_hub},
    diameter=200.0,
    cowl=1.5,
    hub=70.0,
    within=0.95,
)
TEFC_DEFAULTS: dict[str, float | int | str] = {
    "frame.length_mm": 300.0,
    "frame.cap_mm": 14.0,
    "shaft.diameter_mm": 38.0,
    "shaft.extension_mm": 80.0,
    "bearing.outer_diameter_mm": 80.0,
    "stator.outer_diameter_mm": 210.0,
    "stator.bore_diameter_mm": 130.0,
    "stator.stack_length_mm": 140.0,
    "stator.slots": 36,
    "stator.tooth_mm": 5.5,
    "stator.slot_depth_mm": 20.0,
    "stator.slot_width_mm": 5.5,
    "stator.tip_mm": 1.0,
    "stator.opening_mm": 2.5,
    "stator.air_gap_mm": 0.5,
    "winding.straight_mm": 8.0,
    "winding.end_mm": 40.0,
    "housing.kind": "axial-fins",
    "housing.thickness_mm": 6.0,
    "base.kind": "plate",
    "base.width_mm": 400.0,
    "base.length_mm": 400.0,
    "base.thickness_mm": 20.0,
    "foot.width_mm": 80.0,
}
TEFC = tuple(replace(p, default=TEFC_DEFAULTS.get(p.key, p.default)) for p in (*COMMON, *CAGE, *FAN))
