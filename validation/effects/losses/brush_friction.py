"""Rubbing of the brushes."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import InputPower
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import heat, power_scale
from validation.effects.sites import commutators


@dataclass(frozen=True)
class BrushFriction(Effect):
    """P = mu p A v: a n / 1000 rpm, a the loss (W) at 1000 rpm."""

    kind = "brush.friction"
    empirical = True
    title = "brush friction"
    sits = "a part with role commutator"
    unit = "W"
    at = "1000 rpm"
    source = "Coulomb friction, mu 0.15 to 0.3, 15 to 25 kPa"
    isolating_test = "lift the brushes and spin"
    typical = (20.0, 300.0)
    prior_sd = 0.5
    high = 20.0
    confused_with = ("brush.drop", "bearing.friction", "windage")
    needs = ("speed",)

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return commutators(scene.network)

    def extend(self, network: Network) -> Network:
        source = heat(
            network, self.name, "brush", self.place, InputPower(1.0, ((network.signal("speed"), 1000.0, 1.0),))
        )
        network = network.extended(sources=[source])
        return with_parameter(network, self.parameter(source.name, scale=power_scale(network)))
