"""Eddy currents in magnets or rotor surface."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import InputPower
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import heat, power_scale
from validation.effects.sites import turning


@dataclass(frozen=True)
class MagnetLoss(Effect):
    """P = a (n / 1000 rpm)^2, a the loss (W) at 1000 rpm: slotting and PWM harmonics."""

    kind = "loss.rotor"
    empirical = True
    title = "loss in rotor or magnets"
    sits = "a turning part"
    unit = "W"
    at = "1000 rpm"
    source = "eddy currents in thin conductors, P ~ f^2"
    isolating_test = "spin without current and with a dummy rotor"
    typical = (5.0, 200.0)
    prior_sd = 0.5
    high = 20.0
    confused_with = ("iron", "windage", "bearing.friction")
    needs = ("speed",)

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return turning(scene.network)

    def extend(self, network: Network) -> Network:
        source = heat(
            network, self.name, "iron", self.place, InputPower(1.0, ((network.signal("speed"), 1000.0, 2.0),))
        )
        network = network.extended(sources=[source])
        return with_parameter(network, self.parameter(source.name, scale=power_scale(network)))
