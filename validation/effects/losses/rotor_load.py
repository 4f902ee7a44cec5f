"""Eddy currents in rotor or magnets that grow with the stator's current."""

from dataclasses import dataclass

from lumped.model.sites import turning
from validation.effects.base import Scene
from validation.effects.losses.added_loss import AddedLoss
from validation.effects.losses.copper_ac import AcCopper


@dataclass(frozen=True)
class RotorLoadLoss(AddedLoss):
    """P = a (n / 1000 rpm)^2 (I / 100 A)^2, a the loss (W) at 1000 rpm and 100 A."""

    kind = "loss.rotor.load"
    title = "load-dependent loss in rotor or magnets"
    sits = "a turning part that is no wound winding"
    at = "1000 rpm and 100 A"
    source = "winding harmonics of the armature field, B ~ I; eddy currents in thin conductors, P ~ (f B)^2"
    isolating_test = "same speed at two currents; rotor temperature from back-EMF"
    typical = (1.0, 50.0)
    prior_sd = 0.1
    confused_with = ("loss.rotor", "iron", "copper.ac")
    needs = ("speed", "current")
    heats = "iron"
    follows = (("speed", 1000.0, 2.0), ("current", 100.0, 2.0))

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        """Rotors and magnets; a winding that turns has the same law as AC copper loss."""
        return [p for p in turning(scene.network) if p not in AcCopper.candidate_places(scene)]
