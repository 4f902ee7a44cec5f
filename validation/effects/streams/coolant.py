"""Coolant that reaches further than assumed."""

from itertools import chain

from geom.description.roles import Role
from lumped.model.network import Network
from lumped.model.sites import boundaries, fluids, neighbours, solids, washed
from lumped.transfer.laws import Fixed
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import film_unit, to_fluid


def coolants(network: Network) -> list[str]:
    """Boundaries and fluid nodes that are a coolant and wash a part; where none washes any, the boundaries."""
    inlets = boundaries(network, Role.COOLANT)
    names = [n for n in (*inlets, *fluids(network, Role.COOLANT)) if n in network.states or n in inlets]
    return [n for n in names if washed(network, n)] or inlets


def reached(network: Network, place: str) -> list[str]:
    """The coolants that wash a part, or its neighbours, or else all."""
    near = neighbours(network).get(place, set())
    beside = [fluid for fluid in coolants(network) if near & set(washed(network, fluid))]
    return [fluid for fluid in coolants(network) if place in washed(network, fluid)] or beside or coolants(network)


class CoolantLink(Effect):
    """Extra heat transfer a to the coolant (W/m2/K on wetted faces, W/K at a bare node)."""

    kind = "coolant"
    empirical = True
    title = "extra heat path to the coolant"
    sits = "a part at or beside a fluid with role coolant"
    unit = "W/m2/K"
    source = "Newton's law of cooling; jacket sides beyond the modelled wall, hoses, manifolds"
    isolating_test = "step the coolant's inlet temperature at constant loss"
    typical = (50.0, 1000.0)
    prior_sd = 200.0
    high = 5000.0
    confused_with = ("contact", "convection.constant")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        network = scene.network
        wet = list(dict.fromkeys(part for fluid in coolants(network) for part in washed(network, fluid)))
        near = {b for part in wet for b in neighbours(network).get(part, set())}
        return [*wet, *(p.name for p in solids(network) if p.name in near - set(wet))]

    def extend(self, network: Network) -> Network:
        touching = reached(network, self.place)
        unit, scale = film_unit(network, self.place, touching[0])
        names = [self.name] if len(touching) == 1 else [f"{self.name}:{fluid}" for fluid in touching]
        each = [to_fluid(network, n, self.place, x, Fixed(1.0)) for n, x in zip(names, touching, strict=True)]
        links = list(chain(*each))
        parameter = self.parameter(*(link.name for link in links), scale=scale, unit=unit)
        return with_parameter(network.extended(links=links), parameter)
