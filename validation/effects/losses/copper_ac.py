"""Eddy currents and proximity in the conductors."""

from dataclasses import dataclass

from geom.constants import ALPHA_CU
from geom.description.roles import Role
from lumped.model.network import Network
from lumped.model.sites import heated, role, windings
from lumped.transfer.laws import Conductivity, Law, WithTemperature
from validation.effects.base import Scene
from validation.effects.losses.added_loss import AddedLoss


@dataclass(frozen=True)
class AcCopper(AddedLoss):
    """P = a (n / 1000 rpm)^2 (I / 100 A)^2 / (1 + alpha (T - 20 degC)), a the loss (W) at 1000 rpm, 100 A and 20 degC.

    Eddy currents fall with the resistivity of copper, as those of a declared `ac` do.
    """

    kind = "copper.ac"
    title = "AC copper loss"
    sits = "a winding with copper loss"
    at = "1000 rpm and 100 A and 20 degC"
    source = "Dowell 1966, low-frequency limit, P ~ f^2 I^2"
    isolating_test = "DC against AC at the same current"
    typical = (5.0, 300.0)
    confused_with = ("copper.feedback", "iron")
    needs = ("speed", "current")
    heats = "copper.ac"
    follows = (("speed", 1000.0, 2.0), ("current", 100.0, 2.0))

    def law(self, network: Network) -> Law:
        return WithTemperature(super().law(network), Conductivity(ALPHA_CU, 20.0))

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        """Windings that carry a copper loss; a cage has no strands (its own is the load-dependent loss of a rotor)."""
        loaded = heated(scene.network, "copper", windings(scene.network))
        return [p for p in loaded if role(scene.network, p) is not Role.CAGE]
