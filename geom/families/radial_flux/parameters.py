"""Parameters of machines with a slotted stator around a round rotor: parameters.csv has them, with those of each rotor.

Here stands what their lengths are measured in, so that any ratios fit together: a bound is where a rule of checks.py
would begin, with room to spare for what the other ratios may do.
"""

import math
from pathlib import Path

from geom.description.geometry import Features, Geometry
from geom.description.parameters import Measure, parameter_sets
from geom.families.radial_flux import hairpin
from geom.families.radial_flux.layout import Layout
from geom.families.radial_flux.rotors import widest
from geom.families.shaft_fan import fan_measures

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
bar_room = Measure("the slot's width inside the liner", hairpin.bar_room)
layer = Measure("the slot's depth inside the liner over layers", hairpin.layer_height)
enamel_room = Measure("what bars leave on either side, the smaller", hairpin.enamel_room)
end_height = Measure("the bore, above where end turns of bars would cut each other", bore.span, hairpin.least_end)
length = Measure("the length over the end-caps", lambda g: g.frame.length)
turn = Measure("the stack's length over turns + 1", lambda g: g.stator.stack_length / (g.housing.turns + 1))


def features(g: Geometry) -> Features:
    """What formulas ask beside the solids."""
    bars = hairpin.bars(g) if g.winding.kind == "hairpin" else None
    return Features(air_gap=g.stator.air_gap, bars=bars)


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


even_pitch = Measure("the pitch of fins spread evenly", _even_pitch)
fin_pitch = Measure(
    "the fins' pitch, or 0.3 of the laminations where it is less",
    lambda g: min(g.housing.fin_spacing or _even_pitch(g), 0.3 * g.stator.outer_diameter),
)
channel = Measure("the channel's width (0.6 of it with one turn), or a sixth of the laminations, the smaller", _channel)
pole = Measure(
    "pole pitch or rotor iron, the smaller",
    lambda g: min(2 * _rotor(g) * math.sin(math.pi / g.rotor.poles), _rotor(g) - g.shaft.diameter / 2),
)
magnet = Measure("the widest magnet that fits", widest)
iron = Measure("rotor surface to shaft", lambda g: _rotor(g) - 0.55 * g.shaft.diameter)
bar_pitch = Measure(
    "the bars' pitch at their bottom", lambda g: 2 * math.pi * (_rotor(g) - g.rotor.bar_depth) / g.rotor.bars
)
end_space = Measure("stack to end-cap", lambda g: (g.frame.length - g.stator.stack_length) / 2 - g.frame.cap)
fan, fan_hub = fan_measures("end-cap", lambda g: Layout(g).cap_radius, lambda g: g.shaft.diameter)

MEASURES = {name: measure for name, measure in globals().items() if isinstance(measure, Measure)}
TABLE = Path(__file__).with_name("parameters.csv")
_SETS = parameter_sets(TABLE, MEASURES)
COMMON, MAGNETS, FAN = _SETS["common"], _SETS["magnets"], _SETS["fan"]
_TEFC_SETS = parameter_sets(TABLE, MEASURES, "tefc")
TEFC = (*_TEFC_SETS["common"], *_TEFC_SETS["cage"], *_TEFC_SETS["fan"])
