"""Eddy currents in magnets or rotor surface."""

from dataclasses import dataclass

from lumped.model.sites import turning
from validation.effects.base import Scene
from validation.effects.losses.added_loss import AddedLoss


@dataclass(frozen=True)
class MagnetLoss(AddedLoss):
    """P = a (n / 1000 rpm)^2, a the loss (W) at 1000 rpm: slotting and PWM harmonics."""

    kind = "loss.rotor"
    title = "loss in rotor or magnets"
    sits = "a turning part"
    at = "1000 rpm"
    source = "eddy currents in thin conductors, P ~ f^2"
    isolating_test = "spin without current and with a dummy rotor"
    typical = (5.0, 200.0)
    confused_with = ("iron", "windage", "bearing.friction")
    needs = ("speed",)
    heats = "iron"
    follows = (("speed", 1000.0, 2.0),)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return turning(scene.network)
