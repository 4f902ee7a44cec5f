"""Air friction of the rotor."""

from dataclasses import dataclass

from lumped.model.sites import turning
from validation.effects.base import Scene
from validation.effects.losses.added_loss import AddedLoss


@dataclass(frozen=True)
class Windage(AddedLoss):
    """P = a (n / 1000 rpm)^3, a the loss (W) at 1000 rpm."""

    kind = "windage"
    title = "windage"
    sits = "a turning part"
    at = "1000 rpm"
    source = "Saari 1998, rotating cylinder, P ~ n^3 at constant friction factor"
    isolating_test = "spin at two gas pressures, or with the fan taken off"
    typical = (2.0, 100.0)
    confused_with = ("bearing.friction", "iron")
    needs = ("speed",)
    heats = "windage"
    follows = (("speed", 1000.0, 3.0),)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return turning(scene.network)
