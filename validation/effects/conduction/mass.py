"""More heat capacity than assumed."""

from lumped.model.network import Network
from lumped.model.sites import solids
from validation.effects.base import Effect, Scene, with_parameter


class Mass(Effect):
    """Extra mass that takes part in the heating of a node: C = C0 (1 + a)."""

    kind = "mass"
    title = "extra mass"
    sits = "a part with a heat capacity"
    source = "definition: attached parts, fixture, water in the jacket"
    isolating_test = "weigh it; step the loss and read the first minutes"
    typical = (0.1, 1.0)
    prior_sd = 0.5
    high = 10.0
    mapping = "relative"
    confused_with = ("sensor.lag", "contact")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        groups = scene.network.capacity_group
        return [p.name for p in solids(scene.network) if groups and groups[p.states[0]]]

    def extend(self, network: Network) -> Network:
        group = network.capacity_group[network.places[self.place].states[0]]
        return with_parameter(network, self.parameter(f"capacity:{group}"))
