"""Natural convection on an outer face."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import Fixed, Power
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import film_unit, to_fluid
from validation.effects.sites import ambient, outside


@dataclass(frozen=True)
class BuoyantConvection(Effect):
    """h = a (|T - T_ambient| / 40 K)^(1/4), a the coefficient at 40 K (W/m2/K; W/K at a bare node)."""

    kind = "convection.buoyant"
    empirical = True
    title = "natural convection growing with the rise"
    sits = "an outer part or face, with an ambient"
    unit = "W/m2/K"
    at = "40 K"
    source = "McAdams 1954, vertical plate, laminar, Nu ~ Ra^(1/4)"
    isolating_test = "hold two loss levels to steady state: h must grow with the rise to the power 1/4"
    typical = (1.0, 8.0)
    prior_sd = 5.0
    high = 100.0
    confused_with = ("convection.constant", "radiation")

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return outside(scene.network)

    def extend(self, network: Network) -> Network:
        air = str(ambient(network))
        unit, scale = film_unit(network, self.place, air)
        links = to_fluid(network, self.name, self.place, air, Fixed(40.0**-0.25, Power(0.25)))
        parameter = self.parameter(*(link.name for link in links), scale=scale, unit=unit)
        return with_parameter(network.extended(links=links), parameter)
