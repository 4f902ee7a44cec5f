"""A fan on the shaft that blows over what stands still."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.model.quantities import AIR
from lumped.model.sites import AXLE, outside, role, turns
from lumped.transfer.laws import InputPower, Law
from validation.effects.base import Scene
from validation.effects.films.ambient_film import AmbientFilm


@dataclass(frozen=True)
class FanConvection(AmbientFilm):
    """Air of a shaft fan over a standing face, parallel to what cools it already: h = a (n / 1000 rpm)^0.8.

    a the coefficient at 1000 rpm (W/m2/K; W/K at a bare node); the fan's flow goes with its speed (affinity).
    """

    kind = "convection.fan"
    empirical = True
    title = "air of a fan on the shaft over a standing face"
    sits = "a standing outer part off the axle, with no air flow recorded"
    at = "1000 rpm"
    source = "fin channels and end shields of TEFC machines, h ~ v^0.8 (Staton and Cavagnino 2008), v ~ n"
    isolating_test = "cool down without current, once turning and once at rest; take the fan off"
    typical = (5.0, 60.0)
    prior_sd = 30.0
    high = 300.0
    confused_with = ("convection", "convection.constant", "convection.rotation", "windage")
    needs = ("speed",)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        network = scene.network
        if AIR in scene.recorded:  # a motor of its own drives the fan: then none is on the shaft
            return []
        return [p for p in outside(network) if not turns(network, p) and role(network, p) not in AXLE]

    def law(self, network: Network) -> Law:
        return InputPower(1.0, ((network.signal("speed"), 1000.0, 0.8),))
