"""Air friction of the rotor."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import InputPower
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import heat, power_scale
from validation.effects.sites import turning


@dataclass(frozen=True)
class Windage(Effect):
    """P = a (n / 1000 rpm)^3, a the loss (W) at 1000 rpm."""

    kind = "windage"
    empirical = True
    title = "windage"
    sits = "a turning part"
    unit = "W"
    at = "1000 rpm"
    source = "Saari 1998, rotating cylinder, P ~ n^3 at constant friction factor"
    isolating_test = "spin at two gas pressures, or with the fan taken off"
    typical = (2.0, 100.0)
    prior_sd = 0.5
    high = 20.0
    confused_with = ("bearing.friction", "iron")
    needs = ("speed",)

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return turning(scene.network)

    def extend(self, network: Network) -> Network:
        source = heat(
            network, self.name, "windage", self.place, InputPower(1.0, ((network.signal("speed"), 1000.0, 3.0),))
        )
        network = network.extended(sources=[source])
        return with_parameter(network, self.parameter(source.name, scale=power_scale(network)))
