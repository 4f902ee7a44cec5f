"""A forgotten thermal bridge."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.model.sites import near_pairs
from lumped.transfer.laws import Fixed
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import conductance_scale, exchange, place_pair


@dataclass(frozen=True)
class Coupling(Effect):
    """A conductance a (W/K) between two parts that share a neighbour but are not joined in the network."""

    kind = "coupling"
    title = "thermal bridge"
    sits = "two parts near each other without a link"
    unit = "W/K"
    source = "conduction through bolts, leads, potting or air that the drawing does not show"
    isolating_test = "heat one of the two parts alone and watch the other"
    typical = (0.1, 5.0)
    prior_sd = 0.1
    high = 20.0
    confused_with = ("contact", "coupling")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return [f"{a}|{b}" for a, b in near_pairs(scene.network)]

    def extend(self, network: Network) -> Network:
        a, b = place_pair(network, self.place)
        link = exchange(network, self.name, a, b, Fixed(1.0))
        return with_parameter(
            network.extended(links=[link]), self.parameter(link.name, scale=conductance_scale(network))
        )
