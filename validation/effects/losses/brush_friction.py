"""Rubbing of the brushes."""

from dataclasses import dataclass

from lumped.model.sites import commutators
from validation.effects.base import Scene
from validation.effects.losses.added_loss import AddedLoss


@dataclass(frozen=True)
class BrushFriction(AddedLoss):
    """P = mu p A v: a n / 1000 rpm, a the loss (W) at 1000 rpm."""

    kind = "brush.friction"
    title = "brush friction"
    sits = "a part with role commutator"
    at = "1000 rpm"
    source = "Coulomb friction, mu 0.15 to 0.3, 15 to 25 kPa"
    isolating_test = "lift the brushes and spin"
    typical = (20.0, 300.0)
    confused_with = ("brush.drop", "bearing.friction", "windage")
    needs = ("speed",)
    heats = "brush"
    follows = (("speed", 1000.0, 1.0),)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return commutators(scene.network)
