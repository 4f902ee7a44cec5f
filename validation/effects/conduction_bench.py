"""Heat into what the machine stands on."""

from dataclasses import dataclass

from lumped.laws import Fixed
from lumped.network import Network
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import conductance_scale, exchange
from validation.effects.sites import like, outside, solids, touches, turns


def stands(network: Network) -> list[str]:
    """Boundaries that are a bench, base or mount."""
    return [b for b in network.boundaries if like(b, "bench")]


@dataclass(frozen=True)
class BenchConduction(Effect):
    """Conduction from an outer part into the bench or base whose temperature is recorded: q = a (T - T_bench), W/K."""

    kind = "conduction.bench"
    title = "conduction into the bench"
    unit = "W/K"
    source = "one-dimensional conduction through the feet"
    isolating_test = "heat or insulate the bench plate (G10 spacer) and read its temperature"
    typical = (0.5, 10.0)
    high = 50.0
    confused_with = ("convection.constant",)

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        network = scene.network
        outer = [p for p in outside(network) or [p.name for p in solids(network)] if not turns(p)]
        return [p for p in outer for b in stands(network) if not touches(network, p, b)]

    def extend(self, network: Network) -> Network:
        link = exchange(network, self.name, self.place, stands(network)[0], Fixed(1.0))
        return with_parameter(
            network.extended(links=[link]), self.parameter(link.name, scale=conductance_scale(network))
        )
