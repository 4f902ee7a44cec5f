"""Radiation from an outer face."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import Fixed
from lumped.transfer.laws import Radiation as FourthPower
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import film_unit, to_fluid
from validation.effects.sites import ambient, outside


@dataclass(frozen=True)
class Radiation(Effect):
    """q = a sigma A (T^4 - T_ambient^4), a the extra effective emissivity (1; emissivity times m2 at a bare node)."""

    kind = "radiation"
    title = "thermal radiation to the surroundings"
    sits = "an outer part or face, with an ambient"
    unit = "1"
    source = "Stefan-Boltzmann; grey body in large surroundings"
    isolating_test = "paint the face matt black or cover it with bright foil; wide range of temperature"
    typical = (0.1, 0.9)
    prior_sd = 0.5
    high = 1.0
    confused_with = ("convection.constant", "convection.buoyant")

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return outside(scene.network)

    def extend(self, network: Network) -> Network:
        air = str(ambient(network))
        unit, scale = film_unit(network, self.place, air)
        unit, scale = ("1", 1.0) if unit == "W/m2/K" else ("m2", scale / 5.0)
        links = to_fluid(network, self.name, self.place, air, Fixed(1.0, FourthPower()))
        parameter = self.parameter(*(link.name for link in links), scale=scale, unit=unit)
        return with_parameter(network.extended(links=links), parameter)
