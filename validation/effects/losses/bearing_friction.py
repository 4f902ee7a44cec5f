"""Friction in a bearing."""

from dataclasses import dataclass

from lumped.model.sites import bearings
from validation.effects.base import Scene
from validation.effects.losses.added_loss import AddedLoss


@dataclass(frozen=True)
class BearingFriction(AddedLoss):
    """P = a (n / 1000 rpm)^(5/3), a the loss (W) at 1000 rpm."""

    kind = "bearing.friction"
    title = "bearing friction"
    sits = "a part with role bearing"
    at = "1000 rpm"
    source = "Palmgren 1959: viscous moment ~ (nu n)^(2/3), so power ~ n^(5/3)"
    isolating_test = "back-driven spin, uncoupled; vary the grease temperature"
    typical = (5.0, 100.0)
    confused_with = ("windage", "iron")
    needs = ("speed",)
    heats = "friction"
    follows = (("speed", 1000.0, 5.0 / 3.0),)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return bearings(scene.network)
