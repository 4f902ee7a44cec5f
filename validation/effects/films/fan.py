"""A fan on the shaft that blows over what stands still."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.model.quantities import AIR
from lumped.transfer.laws import InputPower
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import film_unit, to_fluid
from validation.effects.sites import AXLE, ambient, outside, role, turns


@dataclass(frozen=True)
class FanConvection(Effect):
    """Air of a shaft fan over a standing face, parallel to what cools it already: h = a (n / 1000 rpm)^0.8.

    a the coefficient at 1000 rpm (W/m2/K; W/K at a bare node); the fan's flow goes with its speed (affinity).
    """

    kind = "convection.fan"
    empirical = True
    title = "air of a fan on the shaft over a standing face"
    sits = "a standing outer part off the axle, with no air flow recorded"
    unit = "W/m2/K"
    at = "1000 rpm"
    source = "fin channels and end shields of TEFC machines, h ~ v^0.8 (Staton and Cavagnino 2008), v ~ n"
    isolating_test = "cool down without current, once turning and once at rest; take the fan off"
    typical = (5.0, 60.0)
    prior_sd = 30.0
    high = 300.0
    confused_with = ("convection", "convection.constant", "convection.rotation", "windage")
    needs = ("speed",)

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        network = scene.network
        if AIR in scene.recorded:  # a motor of its own drives the fan: then none is on the shaft
            return []
        return [p for p in outside(network) if not turns(network, p) and role(network, p) not in AXLE]

    def extend(self, network: Network) -> Network:
        air = str(ambient(network))
        unit, scale = film_unit(network, self.place, air)
        law = InputPower(1.0, ((network.signal("speed"), 1000.0, 0.8),))
        links = to_fluid(network, self.name, self.place, air, law)
        parameter = self.parameter(*(link.name for link in links), scale=scale, unit=unit)
        return with_parameter(network.extended(links=links), parameter)
