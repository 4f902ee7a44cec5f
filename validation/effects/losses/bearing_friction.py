"""Friction in a bearing."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import InputPower
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import heat, power_scale
from validation.effects.sites import bearings


@dataclass(frozen=True)
class BearingFriction(Effect):
    """P = a (n / 1000 rpm)^(5/3), a the loss (W) at 1000 rpm."""

    kind = "bearing.friction"
    empirical = True
    title = "bearing friction"
    sits = "a part with role bearing"
    unit = "W"
    at = "1000 rpm"
    source = "Palmgren 1959: viscous moment ~ (nu n)^(2/3), so power ~ n^(5/3)"
    isolating_test = "back-driven spin, uncoupled; vary the grease temperature"
    typical = (5.0, 100.0)
    prior_sd = 0.5
    high = 20.0
    confused_with = ("windage", "iron")
    needs = ("speed",)

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return bearings(scene.network)

    def extend(self, network: Network) -> Network:
        source = heat(
            network, self.name, "friction", self.place, InputPower(1.0, ((network.signal("speed"), 1000.0, 5.0 / 3.0),))
        )
        network = network.extended(sources=[source])
        return with_parameter(network, self.parameter(source.name, scale=power_scale(network)))
