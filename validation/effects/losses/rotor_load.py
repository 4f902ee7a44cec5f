"""Eddy currents in rotor or magnets that grow with the stator's current."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import InputPower
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import heat, power_scale
from validation.effects.losses.copper_ac import AcCopper
from validation.effects.sites import turning


@dataclass(frozen=True)
class RotorLoadLoss(Effect):
    """P = a (n / 1000 rpm)^2 (I / 100 A)^2, a the loss (W) at 1000 rpm and 100 A."""

    kind = "loss.rotor.load"
    empirical = True
    title = "load-dependent loss in rotor or magnets"
    sits = "a turning part that is no wound winding"
    unit = "W"
    at = "1000 rpm and 100 A"
    source = "winding harmonics of the armature field, B ~ I; eddy currents in thin conductors, P ~ (f B)^2"
    isolating_test = "same speed at two currents; rotor temperature from back-EMF"
    typical = (1.0, 50.0)
    prior_sd = 0.1
    high = 20.0
    confused_with = ("loss.rotor", "iron", "copper.ac")
    needs = ("speed", "current")

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        """Rotors and magnets; a winding that turns has the same law as AC copper loss."""
        return [p for p in turning(scene.network) if p not in AcCopper.where(scene)]

    def extend(self, network: Network) -> Network:
        law = InputPower(1.0, ((network.signal("speed"), 1000.0, 2.0), (network.signal("current"), 100.0, 2.0)))
        source = heat(network, self.name, "iron", self.place, law)
        network = network.extended(sources=[source])
        return with_parameter(network, self.parameter(source.name, scale=power_scale(network)))
