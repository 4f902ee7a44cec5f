"""Losses of a series-wound DC machine as sources of its network."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from lumped.laws import InputPower, Law, Linear
from lumped.motor_settings import Losses
from lumped.network import Network, Row, Source

ARMATURE = ("winding.armature", "winding.armature.left", "winding.armature.right")


def dc_sources(network: Network, losses: Losses, rated: Mapping[str, float]) -> list[Source]:
    """Every loss of the machine as a source; the weights of each sum to 1.

    rated : "current_A", "speed_rpm"
    """
    copper = Linear(losses.temperature_coefficient_per_K, losses.reference_C)
    current = ("current_A", 1.0, 2.0)
    amps, turns = rated["current_A"], rated["speed_rpm"]
    iron_terms = (("current_A", amps, losses.iron_current_exponent), ("speed_rpm", turns, losses.iron_speed_exponent))
    spin = ("speed_rpm", turns, 1.0)

    bearing = InputPower(losses.bearing_friction_W, (spin,))

    def source(name: str, kind: str, parts: Mapping[str, float], law: Law) -> Source:
        index = np.array([network.column(part) for part in parts])
        weights = np.array(list(parts.values())) / sum(parts.values())
        return Source(f"loss:{name}", kind, next(iter(parts)), index, weights, law, Row(index, weights))

    armature = InputPower(losses.armature_resistance_mOhm * 1e-3, (current,), copper)
    winding = InputPower(losses.field_resistance_mOhm * 1e-3, (current,), copper)
    share, ends, gap = losses.iron_in_poles, losses.armature_in_end_windings, losses.windage_in_gap
    conductors = dict(zip(ARMATURE, (1 - ends, ends / 2, ends / 2), strict=True))
    air = {"airgap": gap, "air.left": (1 - gap) / 2, "air.right": (1 - gap) / 2}
    return [
        source("copper.armature", "copper", conductors, armature),
        source("copper.field", "copper", {"winding.field": 1.0}, winding),
        source("iron", "iron", {"rotor.core": 1 - share, "poles": share}, InputPower(losses.iron_W, iron_terms)),
        source("brush.drop", "brush", {"commutator": 1.0}, InputPower(losses.brush_drop_V, (("current_A", 1.0, 1.0),))),
        source("brush.friction", "friction", {"commutator": 1.0}, InputPower(losses.brush_friction_W, (spin,))),
        source("bearing.left", "friction", {"bearing.left": 1.0}, bearing),
        source("bearing.right", "friction", {"bearing.right": 1.0}, bearing),
        source("windage", "windage", air, InputPower(losses.windage_W, (("speed_rpm", turns, 3.0),))),
    ]
