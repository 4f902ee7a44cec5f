"""What the lengths of a slotted stator, its rotor and its housing are measured in, so that any ratios fit together.

A bound is where a rule of checks.py would begin, with room to spare for what the other ratios may do.
"""

from __future__ import annotations

import math
from typing import Any

from geom.description.parameters import Scale
from geom.families.radial_flux.magnets import widest


def outer(low: float, high: float) -> Scale:
    return Scale("the laminations' outer diameter", low, high, lambda g: g.stator.outer_diameter)


def bore(low: float, high: float) -> Scale:
    return Scale("the bore", low, high, lambda g: g.stator.bore_diameter)


def shaft(low: float, high: float) -> Scale:
    return Scale("the shaft's diameter", low, high, lambda g: g.shaft.diameter)


def stack(low: float, high: float) -> Scale:
    return Scale("the stack's length", low, high, lambda g: g.stator.stack_length)


def build(low: float, high: float) -> Scale:
    return Scale("bore to outside of the laminations", low, high,
                 lambda g: (g.stator.outer_diameter - g.stator.bore_diameter) / 2)  # fmt: skip


def depth(low: float, high: float) -> Scale:
    return Scale("the slot's depth", low, high, lambda g: g.stator.slot_depth)


def _pitch(g: Any) -> float:
    return g.stator.bore_diameter * math.sin(math.pi / g.stator.slots)


def pitch(low: float, high: float) -> Scale:
    return Scale("the slot pitch at the bore", low, high, _pitch)


def lining(low: float, high: float) -> Scale:
    return Scale("slot pitch or depth, the smaller", low, high, lambda g: min(_pitch(g), g.stator.slot_depth))


def _mouth(g: Any) -> float:
    return g.stator.slot_width if g.stator.slot_shape == "parallel" else _pitch(g) - g.stator.tooth


def mouth(low: float, high: float) -> Scale:
    return Scale("the slot's width at the bore", low, high, _mouth)


def tip(low: float, high: float) -> Scale:
    return Scale("the tooth tip", low, high, lambda g: g.stator.tip)


def _content(g: Any) -> float:
    return g.stator.stack_length + 2 * (g.winding.straight + g.winding.end + g.frame.cap)


def content(low: float, high: float) -> Scale:
    return Scale("stack, end windings and end-caps together", low, high, _content)


def yoke(low: float, high: float) -> Scale:
    return Scale("the yoke behind the slots", low, high,
                 lambda g: (g.stator.outer_diameter - g.stator.bore_diameter) / 2 - g.stator.slot_depth)  # fmt: skip


def _even_pitch(g: Any) -> float:
    """Of fins spread evenly."""
    if g.housing.kind == "radial-fins":
        return (g.frame.length - 2 * g.frame.cap) / g.housing.fins
    return 2 * math.pi * (g.stator.outer_diameter / 2 + g.housing.thickness) / g.housing.fins


def even_pitch(low: float, high: float) -> Scale:
    return Scale("the pitch of fins spread evenly", low, high, _even_pitch)


def fin_pitch(low: float, high: float) -> Scale:
    return Scale("the fins' pitch, or 0.3 of the laminations where it is less", low, high,
                 lambda g: min(g.housing.fin_spacing or _even_pitch(g), 0.3 * g.stator.outer_diameter))  # fmt: skip


def _turn(g: Any) -> float:
    return g.stator.stack_length / (g.housing.turns + 1)


def turn(low: float, high: float) -> Scale:
    return Scale("the stack's length over turns + 1", low, high, _turn)


def _channel(g: Any) -> float:
    """Width of the jacket's channel; the two ports of a single turn share it."""
    wide = (g.stator.stack_length - g.housing.rib) / g.housing.turns - g.housing.rib
    return min(wide if g.housing.turns > 1 else 0.6 * wide, g.stator.outer_diameter / 6)


def channel(low: float, high: float) -> Scale:
    return Scale("the channel's width (0.6 of it with one turn), or a sixth of the laminations, the smaller",
                 low, high, _channel)  # fmt: skip


def length(low: float, high: float) -> Scale:
    return Scale("the length over the end-caps", low, high, lambda g: g.frame.length)


def _pole(g: Any) -> float:
    """Pole pitch at the rotor's surface or the iron under it, whichever is smaller."""
    radius = g.stator.bore_diameter / 2 - g.stator.air_gap
    return min(2 * radius * math.sin(math.pi / g.rotor.poles), radius - g.shaft.diameter / 2)


def pole(low: float, high: float) -> Scale:
    return Scale("pole pitch or rotor iron, the smaller", low, high, _pole)


def magnet(low: float, high: float) -> Scale:
    return Scale("the widest magnet that fits", low, high, widest)


def _rotor(g: Any) -> float:
    return g.stator.bore_diameter / 2 - g.stator.air_gap


def iron(low: float, high: float) -> Scale:
    return Scale("rotor surface to shaft", low, high, lambda g: _rotor(g) - 0.55 * g.shaft.diameter)


def bar_pitch(low: float, high: float) -> Scale:
    return Scale("the bars' pitch at their bottom", low, high,
                 lambda g: 2 * math.pi * (_rotor(g) - g.rotor.bar_depth) / g.rotor.bars)  # fmt: skip


def end_space(low: float, high: float) -> Scale:
    return Scale("stack to end-cap", low, high,
                 lambda g: (g.frame.length - g.stator.stack_length) / 2 - g.frame.cap)  # fmt: skip
