"""Current heat beyond the assumed resistance."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import InputPower
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import heat, power_scale
from validation.effects.sites import heated, windings


@dataclass(frozen=True)
class WindingLoss(Effect):
    """P = a (I / 100 A)^2, a the extra loss (W) at 100 A: joints, leads, a wrong resistance."""

    kind = "loss.winding"
    empirical = True
    title = "copper loss larger than assumed"
    sits = "a winding with copper loss"
    unit = "W"
    at = "100 A"
    source = "Joule's law"
    isolating_test = "four-wire resistance of the winding at a known temperature"
    typical = (10.0, 300.0)
    prior_sd = 0.5
    high = 20.0
    confused_with = ("copper.feedback", "copper.ac", "brush.drop")
    needs = ("current",)

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return heated(scene.network, "copper", windings(scene.network))

    def extend(self, network: Network) -> Network:
        source = heat(
            network, self.name, "copper", self.place, InputPower(1.0, ((network.signal("current"), 100.0, 2.0),))
        )
        network = network.extended(sources=[source])
        return with_parameter(network, self.parameter(source.name, scale=power_scale(network)))
