"""What the lengths of a slotted stator, its rotor and its housing are measured in, so that any ratios fit together.

A bound is where a rule of checks.py would begin, with room to spare for what the other ratios may do.
"""

from __future__ import annotations

import math

from geom.description.geometry import Geometry
from geom.description.parameters import scale
from geom.families.radial_flux.layout import Layout
from geom.families.radial_flux.magnets import widest

outer = scale("the laminations' outer diameter", lambda g: g.stator.outer_diameter)
bore = scale("the bore", lambda g: g.stator.bore_diameter)
shaft = scale("the shaft's diameter", lambda g: g.shaft.diameter)
stack = scale("the stack's length", lambda g: g.stator.stack_length)
build = scale("bore to outside of the laminations", lambda g: (g.stator.outer_diameter - g.stator.bore_diameter) / 2)
depth = scale("the slot's depth", lambda g: g.stator.slot_depth)


def _pitch(g: Geometry) -> float:
    return g.stator.bore_diameter * math.sin(math.pi / g.stator.slots)


pitch = scale("the slot pitch at the bore", _pitch)
lining = scale("slot pitch or depth, the smaller", lambda g: min(_pitch(g), g.stator.slot_depth))


def _mouth(g: Geometry) -> float:
    return g.stator.slot_width if g.stator.slot_shape == "parallel" else _pitch(g) - g.stator.tooth


mouth = scale("the slot's width at the bore", _mouth)
tip = scale("the tooth tip", lambda g: g.stator.tip)


def _content(g: Geometry) -> float:
    return g.stator.stack_length + 2 * (g.winding.straight + g.winding.end + g.frame.cap)


content = scale("stack, end windings and end-caps together", _content)
yoke = scale(
    "the yoke behind the slots", lambda g: (g.stator.outer_diameter - g.stator.bore_diameter) / 2 - g.stator.slot_depth
)


def _even_pitch(g: Geometry) -> float:
    """Of fins spread evenly."""
    if g.housing.kind == "radial-fins":
        return (g.frame.length - 2 * g.frame.cap) / g.housing.fins
    return 2 * math.pi * (g.stator.outer_diameter / 2 + g.housing.thickness) / g.housing.fins


even_pitch = scale("the pitch of fins spread evenly", _even_pitch)
fin_pitch = scale(
    "the fins' pitch, or 0.3 of the laminations where it is less",
    lambda g: min(g.housing.fin_spacing or _even_pitch(g), 0.3 * g.stator.outer_diameter),
)


def _turn(g: Geometry) -> float:
    return g.stator.stack_length / (g.housing.turns + 1)


turn = scale("the stack's length over turns + 1", _turn)


def _channel(g: Geometry) -> float:
    """Width of the jacket's channel; the two ports of a single turn share it."""
    wide = (g.stator.stack_length - g.housing.rib) / g.housing.turns - g.housing.rib
    return min(wide if g.housing.turns > 1 else 0.6 * wide, g.stator.outer_diameter / 6)


channel = scale("the channel's width (0.6 of it with one turn), or a sixth of the laminations, the smaller", _channel)
length = scale("the length over the end-caps", lambda g: g.frame.length)


def _pole(g: Geometry) -> float:
    """Pole pitch at the rotor's surface or the iron under it, whichever is smaller."""
    radius = g.stator.bore_diameter / 2 - g.stator.air_gap
    return min(2 * radius * math.sin(math.pi / g.rotor.poles), radius - g.shaft.diameter / 2)


pole = scale("pole pitch or rotor iron, the smaller", _pole)
magnet = scale("the widest magnet that fits", widest)


def _rotor(g: Geometry) -> float:
    return g.stator.bore_diameter / 2 - g.stator.air_gap


iron = scale("rotor surface to shaft", lambda g: _rotor(g) - 0.55 * g.shaft.diameter)
bar_pitch = scale(
    "the bars' pitch at their bottom", lambda g: 2 * math.pi * (_rotor(g) - g.rotor.bar_depth) / g.rotor.bars
)
end_space = scale("stack to end-cap", lambda g: (g.frame.length - g.stator.stack_length) / 2 - g.frame.cap)
fan = scale(
    "the way from the bearing's diameter to the end-cap's",
    lambda g: 2 * (Layout(g).cap_radius - g.fan.cowl) - 1.02 * g.bearing.outer_diameter,
    lambda g: 1.02 * g.bearing.outer_diameter,
)
fan_hub = scale(
    "the way from the shaft's diameter to 0.9 of the cowl's",
    lambda g: 0.9 * g.fan.diameter - 1.05 * g.shaft.diameter,
    lambda g: 1.05 * g.shaft.diameter,
)
