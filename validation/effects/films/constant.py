"""Cooling to ambient that does not depend on speed."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import Fixed
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import film_unit, to_fluid
from validation.effects.sites import ambient, outside


@dataclass(frozen=True)
class ConstantConvection(Effect):
    """Extra heat transfer to ambient, constant coefficient a (W/m2/K; W/K at a bare node): mounting, cable, draught."""

    kind = "convection.constant"
    empirical = True
    title = "steady extra cooling to ambient"
    sits = "an outer part or face, with an ambient"
    unit = "W/m2/K"
    source = "Newton's law of cooling; still air 5 to 15 W/m2/K (Staton and Cavagnino 2008)"
    isolating_test = "insulate the face; cool down with and without it"
    typical = (2.0, 15.0)
    prior_sd = 10.0
    high = 200.0
    confused_with = ("radiation", "convection.buoyant", "conduction.bench", "convection")

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return outside(scene.network)

    def extend(self, network: Network) -> Network:
        air = str(ambient(network))
        unit, scale = film_unit(network, self.place, air)
        links = to_fluid(network, self.name, self.place, air, Fixed(1.0))
        parameter = self.parameter(*(link.name for link in links), scale=scale, unit=unit)
        return with_parameter(network.extended(links=links), parameter)
