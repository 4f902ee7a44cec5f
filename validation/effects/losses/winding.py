"""Current heat beyond the assumed resistance."""

from dataclasses import dataclass

from lumped.model.sites import heated, windings
from validation.effects.base import Scene
from validation.effects.losses.added_loss import AddedLoss


@dataclass(frozen=True)
class WindingLoss(AddedLoss):
    """P = a (I / 100 A)^2, a the extra loss (W) at 100 A: joints, leads, a wrong resistance."""

    kind = "loss.winding"
    title = "copper loss larger than assumed"
    sits = "a winding with copper loss"
    at = "100 A"
    source = "Joule's law"
    isolating_test = "four-wire resistance of the winding at a known temperature"
    typical = (10.0, 300.0)
    confused_with = ("copper.feedback", "copper.ac", "brush.drop")
    needs = ("current",)
    heats = "copper"
    follows = (("current", 100.0, 2.0),)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return heated(scene.network, "copper", windings(scene.network))
