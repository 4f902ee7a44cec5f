"""Parameters shared by machines with a slotted stator around a round rotor, and those of each rotor."""

from __future__ import annotations

from dataclasses import replace

from geom.description.parameters import Parameter
from geom.families.radial_flux import scales
from geom.families.shaft_fan import fan_parameters

P = Parameter
COMMON = (
    P("frame.length_mm", 290.0, 50.0, 3000.0, "outer face to outer face of the end-caps", of=scales.content(1.05, 1.6)),
    P("frame.cap_mm", 20.0, 2.0, 200.0, "thickness of the end-caps; the bearings are as wide",
      of=scales.outer(0.03, 0.12)),
    P("frame.skirt_mm", 8.0, 1.0, 100.0, "without a housing: wall of the end-caps that rests on the stator",
      of=scales.yoke(0.1, 0.8)),
    P("shaft.diameter_mm", 50.0, 5.0, 500.0, "shaft", of=scales.bore(0.2, 0.5)),
    P("shaft.extension_mm", 60.0, 0.0, 500.0, "shaft beyond the right end-cap", of=scales.shaft(0.2, 3.0)),
    P("bearing.outer_diameter_mm", 90.0, 10.0, 700.0, "bearing seat", of=scales.shaft(1.3, 2.3)),
    P("stator.outer_diameter_mm", 270.0, 30.0, 3000.0, "laminations", like="stator.bore_diameter_mm"),
    P("stator.bore_diameter_mm", 174.0, 20.0, 2500.0, "bore", of=scales.outer(0.4, 0.8)),
    P("stator.stack_length_mm", 150.0, 10.0, 2000.0, "laminations, stator and rotor", of=scales.bore(0.2, 2.5)),
    P("stator.slots", 18, 3, 200, "number of slots"),
    P("stator.tooth_mm", 15.0, 0.5, 200.0, "width of the parallel-sided teeth", of=scales.pitch(0.3, 0.6)),
    P("stator.slot_depth_mm", 26.0, 2.0, 200.0, "bore to slot bottom", of=scales.build(0.35, 0.8)),
    P("stator.slot_shape", "tapered", choices=("tapered", "parallel"),
      doc="slots between parallel-sided teeth, or with parallel sides themselves"),
    P("stator.slot_width_mm", 12.0, 0.5, 200.0, "width of a slot with parallel sides", of=scales.pitch(0.3, 0.65)),
    P("stator.tip_mm", 3.0, 0.2, 30.0, "radial thickness of the tooth tips, depth of the slot opening",
      of=scales.depth(0.03, 0.15)),
    P("stator.opening_mm", 3.0, 0.2, 30.0, "width of the slot opening", of=scales.mouth(0.1, 0.6)),
    P("stator.wedge_mm", 0.0, 0.0, 30.0, "wedge that closes the slot opening; 0 is none",
      off=True, of=scales.tip(0.3, 0.95)),
    P("stator.liner_mm", 0.3, 0.05, 3.0, "thickness of the slot liner", of=scales.lining(0.005, 0.04)),
    P("stator.liner_gap_mm", 0.0, 0.0, 5.0, "layer between liner and laminations; 0 is none",
      off=True, of=scales.lining(0.01, 0.06)),
    P("stator.air_gap_mm", 1.0, 0.2, 20.0, "rotor to bore", of=scales.bore(0.002, 0.02)),
    P("winding.kind", "distributed", choices=("distributed", "concentrated"),
      doc="end windings as a ring, or as one arch on every tooth"),
    P("winding.fill", 0.45, 0.05, 0.9, "share of conductor in the slot, inside the liner"),
    P("winding.end_fill", 0.35, 0.05, 0.9, "share of conductor in the end winding"),
    P("winding.impregnation", 1.0, 0.0, 1.0, "share of the space between wires in the slot that resin fills"),
    P("winding.end_impregnation", 1.0, 0.0, 1.0, "the same in the end winding"),
    P("winding.straight_mm", 5.0, 0.5, 100.0, "straight length of the coils outside the stack",
      of=scales.bore(0.01, 0.1)),
    P("winding.end_mm", 25.0, 2.0, 300.0, "axial length of the end-winding ring", of=scales.bore(0.05, 0.5)),
    P("housing.kind", "none", choices=("none", "plain", "axial-fins", "radial-fins", "spiral"),
      doc="what surrounds the laminations"),
    P("housing.thickness_mm", 8.0, 1.0, 100.0, "wall of the housing", of=scales.outer(0.01, 0.08)),
    P("housing.fins", 40, 1, 200, "number of fins"),
    P("housing.fin_height_mm", 20.0, 1.0, 150.0, "radial height of a fin", of=scales.outer(0.02, 0.15)),
    P("housing.fin_thickness_mm", 4.0, 0.5, 40.0, "thickness of a fin", of=scales.fin_pitch(0.1, 0.65)),
    P("housing.fin_spacing_mm", 0.0, 0.0, 500.0, "fin to fin, centred on top or on the middle; 0 spreads them evenly",
      off=True, of=scales.even_pitch(0.5, 0.98)),
    P("housing.turns", 6, 1, 40, "turns of a spiral jacket; rings in the mesh, a helix in CAD files"),
    P("housing.channel_mm", 10.0, 1.0, 80.0, "radial height of the jacket's channel", of=scales.outer(0.02, 0.08)),
    P("housing.rib_mm", 5.0, 0.5, 80.0, "wall between turns, and at the ends", of=scales.turn(0.1, 0.4)),
    P("housing.wall_mm", 5.0, 0.5, 60.0, "outer wall of the jacket", of=scales.outer(0.01, 0.05)),
    P("housing.port_mm", 10.0, 1.0, 100.0, "bore of the jacket's inlet and outlet", of=scales.channel(0.15, 0.6)),
    P("base.kind", "none", choices=("none", "plate"), doc="what the machine stands on"),
    P("base.width_mm", 300.0, 20.0, 5000.0, "base plate, across the axis", of=scales.outer(0.9, 2.5)),
    P("base.length_mm", 1000.0, 20.0, 5000.0, "base plate, along the axis, centred on the stack",
      of=scales.length(1.0, 4.0)),
    P("base.thickness_mm", 10.0, 1.0, 300.0, "base plate", of=scales.outer(0.02, 0.15)),
    P("foot.width_mm", 120.0, 5.0, 2000.0, "pad between machine and base plate, across the axis",
      of=scales.outer(0.2, 0.8)),
    P("foot.length_mm", 100.0, 5.0, 2000.0, "pad, along the axis, centred on the stack", of=scales.stack(0.2, 0.9)),
    P("foot.height_mm", 40.0, 1.0, 500.0, "lowest point of the machine's body to the base plate",
      of=scales.outer(0.02, 0.3)),
)  # fmt: skip
MAGNETS = (
    P("rotor.poles", 16, 2, 80, "number of magnet poles"),
    P("rotor.magnet_shape", "flat", choices=("flat", "v"), doc="one magnet per pole, or two in a V"),
    P("rotor.magnet_width_mm", 22.0, 1.0, 300.0, "width of a magnet in the plane", of=scales.magnet(0.4, 0.95)),
    P("rotor.magnet_thickness_mm", 5.0, 0.5, 60.0, "thickness of a magnet in the plane", of=scales.pole(0.05, 0.2)),
    P("rotor.bridge_mm", 2.0, 0.2, 60.0, "least iron between magnet and rotor surface", of=scales.pole(0.02, 0.1)),
    P("rotor.v_deg", 16.0, 0.0, 60.0, "tilt of each magnet of a V against the flat position"),
)
CAGE = (
    P("rotor.bars", 28, 5, 120, "number of cage bars"),
    P("rotor.bar_width_mm", 5.0, 0.5, 60.0, "parallel-sided bar, open to the air gap", of=scales.bar_pitch(0.25, 0.7)),
    P("rotor.bar_depth_mm", 18.0, 1.0, 120.0, "rotor surface to bar bottom", of=scales.iron(0.15, 0.6)),
    P("rotor.ring_mm", 14.0, 1.0, 100.0, "axial thickness of the cage's end rings", of=scales.end_space(0.1, 0.8)),
)
FAN = fan_parameters(
    "end-cap", {"depth": scales.outer, "wall": scales.outer, "cowl": scales.fan, "hub": scales.fan_hub},
    diameter=200.0, cowl=1.5, hub=70.0, within=0.95,
)  # fmt: skip
TEFC_DEFAULTS: dict[str, float | int | str] = {
    "frame.length_mm": 300.0, "frame.cap_mm": 14.0, "shaft.diameter_mm": 38.0, "shaft.extension_mm": 80.0,
    "bearing.outer_diameter_mm": 80.0, "stator.outer_diameter_mm": 210.0, "stator.bore_diameter_mm": 130.0,
    "stator.stack_length_mm": 140.0, "stator.slots": 36, "stator.tooth_mm": 5.5, "stator.slot_depth_mm": 20.0,
    "stator.slot_width_mm": 5.5, "stator.tip_mm": 1.0, "stator.opening_mm": 2.5, "stator.air_gap_mm": 0.5,
    "winding.straight_mm": 8.0, "winding.end_mm": 40.0, "housing.kind": "axial-fins", "housing.thickness_mm": 6.0,
    "base.kind": "plate", "base.width_mm": 400.0, "base.length_mm": 400.0, "base.thickness_mm": 20.0,
    "foot.width_mm": 80.0,
}  # fmt: skip
TEFC = tuple(replace(p, default=TEFC_DEFAULTS.get(p.key, p.default)) for p in (*COMMON, *CAGE, *FAN))
