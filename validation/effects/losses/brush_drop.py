"""Voltage drop of carbon brushes."""

from dataclasses import dataclass

from lumped.model.sites import commutators
from validation.effects.base import Scene
from validation.effects.losses.added_loss import AddedLoss


@dataclass(frozen=True)
class BrushDrop(AddedLoss):
    """P = a |I| / 100 A, a the loss (W) at 100 A; 2 V of drop give 200 W."""

    kind = "brush.drop"
    title = "brush contact drop"
    sits = "a part with role commutator"
    at = "100 A"
    source = "carbon brushes, about 1 V per brush (IEC 60276)"
    isolating_test = "measure the drop across the brushes at standstill"
    typical = (50.0, 250.0)
    confused_with = ("brush.friction", "loss.winding")
    needs = ("current",)
    heats = "brush"
    follows = (("current", 100.0, 1.0),)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return commutators(scene.network)
