"""Heat into what the machine stands on."""

from dataclasses import dataclass

from geom.description.roles import Role
from lumped.model.network import Network
from lumped.model.sites import boundaries, outside, solids, touches, turns
from lumped.transfer.laws import Fixed
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import conductance_scale, exchange


def free(network: Network, part: str) -> list[str]:
    """Test beds that the part does not stand on yet."""
    return [b for b in boundaries(network, Role.TEST_BED) if not touches(network, part, b)]


@dataclass(frozen=True)
class BenchConduction(Effect):
    """Conduction from an outer part into the bench or base whose temperature is recorded: q = a (T - T_bench), W/K."""

    kind = "conduction.bench"
    title = "conduction into the bench"
    sits = "a standing outer part that the test bed does not hold yet"
    unit = "W/K"
    source = "one-dimensional conduction through the feet"
    isolating_test = "heat or insulate the bench plate (G10 spacer) and read its temperature"
    typical = (0.5, 10.0)
    high = 50.0
    confused_with = ("convection.constant",)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        network = scene.network
        outer = [p for p in outside(network) or [p.name for p in solids(network)] if not turns(network, p)]
        return [p for p in outer if free(network, p)]

    def extend(self, network: Network) -> Network:
        beds = free(network, self.place)
        names = [self.name] if len(beds) == 1 else [f"{self.name}:{bed}" for bed in beds]
        links = [exchange(network, n, self.place, bed, Fixed(1.0)) for n, bed in zip(names, beds, strict=True)]
        parameter = self.parameter(*names, scale=conductance_scale(network))
        return with_parameter(network.extended(links=links), parameter)
