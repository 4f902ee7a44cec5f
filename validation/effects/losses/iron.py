"""Core loss that the loss table misses."""

from dataclasses import dataclass

from lumped.model.sites import cores, heated
from validation.effects.base import Scene
from validation.effects.losses.added_loss import AddedLoss


@dataclass(frozen=True)
class IronLoss(AddedLoss):
    """P = a (n / 1000 rpm)^1.5, a the loss (W) at 1000 rpm, between hysteresis (1) and eddy currents (2)."""

    kind = "iron"
    title = "iron loss growing with speed"
    sits = "a part with role iron or rotor, or one with iron loss"
    at = "1000 rpm"
    source = "Steinmetz 1892, exponent 1 (hysteresis) to 2 (eddy current)"
    isolating_test = "back-driven spin without current, then with field current"
    typical = (20.0, 500.0)
    confused_with = ("bearing.friction", "windage", "copper.ac")
    needs = ("speed",)
    heats = "iron"
    follows = (("speed", 1000.0, 1.5),)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return heated(scene.network, "iron", cores(scene.network))
