"""Heat that flows in whatever the machine does."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import Fixed
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import heat, power_scale
from validation.effects.sites import outside


@dataclass(frozen=True)
class ConstantLoss(Effect):
    """P = a, a constant power (W): a heater, the sun, a neighbour, electronics on standby."""

    kind = "loss.constant"
    empirical = True
    title = "constant heat input"
    sits = "an outer part or face"
    unit = "W"
    source = "heat balance"
    isolating_test = "record with everything switched off"
    typical = (1.0, 100.0)
    prior_sd = 0.5
    high = 20.0
    confused_with = ("ambient.offset", "sensor.bias")
    needs = ()

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return outside(scene.network)

    def extend(self, network: Network) -> Network:
        source = heat(network, self.name, "extra", self.place, Fixed(1.0))
        network = network.extended(sources=[source])
        return with_parameter(network, self.parameter(source.name, scale=power_scale(network)))
