"""Core loss that the loss table misses."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import InputPower
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import heat, power_scale
from validation.effects.sites import cores, heated


@dataclass(frozen=True)
class IronLoss(Effect):
    """P = a (n / 1000 rpm)^1.5, a the loss (W) at 1000 rpm, between hysteresis (1) and eddy currents (2)."""

    kind = "iron"
    empirical = True
    title = "iron loss growing with speed"
    sits = "a part with role iron or rotor, or one with iron loss"
    unit = "W"
    at = "1000 rpm"
    source = "Steinmetz 1892, exponent 1 (hysteresis) to 2 (eddy current)"
    isolating_test = "back-driven spin without current, then with field current"
    typical = (20.0, 500.0)
    prior_sd = 0.5
    high = 20.0
    confused_with = ("bearing.friction", "windage", "copper.ac")
    needs = ("speed",)

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return heated(scene.network, "iron", cores(scene.network))

    def extend(self, network: Network) -> Network:
        source = heat(
            network, self.name, "iron", self.place, InputPower(1.0, ((network.signal("speed"), 1000.0, 1.5),))
        )
        network = network.extended(sources=[source])
        return with_parameter(network, self.parameter(source.name, scale=power_scale(network)))
