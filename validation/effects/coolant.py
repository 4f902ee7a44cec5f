"""Coolant that reaches further than assumed."""

from dataclasses import dataclass

from lumped.laws import Fixed
from lumped.motor_path import stem
from lumped.network import Network
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import film_unit, to_fluid
from validation.effects.sites import like, neighbours, solids, washed


def coolants(network: Network) -> list[str]:
    """Boundaries and fluid nodes that are a liquid coolant, those that wash a part first (an inlet washes none)."""
    nodes = [p.name for p in network.places.values() if p.kind == "fluid"]
    names = [n for n in (*network.boundaries, *nodes) if like(n, "coolant")]
    return sorted(names, key=lambda n: not washed(network, n))


def cells(network: Network) -> list[str]:
    """The first coolant, and where it is a jacket's cell all cells of that jacket."""
    found = coolants(network)
    return [fluid for fluid in found if fluid == found[0] or ("@" in fluid and stem(fluid) == stem(found[0]))]


@dataclass(frozen=True)
class CoolantLink(Effect):
    """Extra heat transfer a to the coolant (W/m2/K on wetted faces, W/K at a bare node)."""

    kind = "coolant"
    title = "extra heat path to the coolant"
    unit = "W/m2/K"
    source = "Newton's law of cooling; jacket sides beyond the modelled wall, hoses, manifolds"
    isolating_test = "step the coolant's inlet temperature at constant loss"
    typical = (50.0, 1000.0)
    prior_sd = 200.0
    high = 5000.0
    confused_with = ("contact", "convection.constant")

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        network = scene.network
        wet = list(dict.fromkeys(part for fluid in cells(network) for part in washed(network, fluid)))
        near = {b for part in wet for b in neighbours(network).get(part, set())}
        return [*wet, *(p.name for p in solids(network) if p.name in near - set(wet))]

    def extend(self, network: Network) -> Network:
        touching = [fluid for fluid in cells(network) if self.place in washed(network, fluid)] or cells(network)[:1]
        unit, scale = film_unit(network, self.place, touching[0])
        links = [x for fluid in touching for x in to_fluid(network, self.name, self.place, fluid, Fixed(1.0))]
        return with_parameter(
            network.extended(links=links), self.parameter(*(link.name for link in links), scale=scale, unit=unit)
        )
