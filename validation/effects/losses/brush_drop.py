"""Voltage drop of carbon brushes."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import InputPower
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import heat, power_scale
from validation.effects.sites import commutators


@dataclass(frozen=True)
class BrushDrop(Effect):
    """P = a |I| / 100 A, a the loss (W) at 100 A; 2 V of drop give 200 W."""

    kind = "brush.drop"
    empirical = True
    title = "brush contact drop"
    sits = "a part with role commutator"
    unit = "W"
    at = "100 A"
    source = "carbon brushes, about 1 V per brush (IEC 60276)"
    isolating_test = "measure the drop across the brushes at standstill"
    typical = (50.0, 250.0)
    prior_sd = 0.5
    high = 20.0
    confused_with = ("brush.friction", "loss.winding")
    needs = ("current",)

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return commutators(scene.network)

    def extend(self, network: Network) -> Network:
        source = heat(
            network, self.name, "brush", self.place, InputPower(1.0, ((network.signal("current"), 100.0, 1.0),))
        )
        network = network.extended(sources=[source])
        return with_parameter(network, self.parameter(source.name, scale=power_scale(network)))
