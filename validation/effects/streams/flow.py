"""More or less fan air or coolant than stated."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from lumped.model.network import Link, Network, Parameter
from lumped.model.quantities import AIR, LIQUID
from validation.effects.base import Effect, Scene, with_parameter


def flows(network: Network) -> list[Parameter]:
    """Parameters that are said to be a flow, or act as one: on streams, and on films by an exponent."""
    links = {link.name: link for link in network.links}
    return [p for p in network.parameters if p.mapping == "log" and (p.flow or _acts_as_flow(network, links, p))]


def _acts_as_flow(network: Network, links: Mapping[str, Link], p: Parameter) -> bool:
    pairs = [(links[t], e) for t, e in p.targets if t in links]
    if len(pairs) < len(p.targets) or not pairs:
        return False
    streams = [e == 1.0 for link, e in pairs if link.kind == "stream"]
    films = [
        e != 1.0 and any(network.measures(name) in (AIR, LIQUID) for name in link.law.reads)
        for link, e in pairs
        if link.kind != "stream"
    ]
    return all(streams) and all(films)


@dataclass(frozen=True)
class Flow(Effect):
    """A flow that differs from the stated one: V = V0 (1 + a), with everything that follows the flow."""

    kind = "flow"
    title = "fan or coolant flow differs from the stated one"
    sits = "a declared flow"
    unit = "1"
    source = "definition; films follow the flow with the exponents the network declares"
    isolating_test = "measure the flow; inlet and outlet temperature at constant loss; run with the fan off"
    typical = (-0.5, 0.7)
    sign = 0
    prior_sd = 0.3
    low = -0.9
    high = 3.0
    mapping = "relative"
    confused_with = ("convection", "convection.constant")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return [p.name for p in flows(scene.network)]

    def extend(self, network: Network) -> Network:
        (original,) = [p for p in flows(network) if p.name == self.place]
        return with_parameter(network, replace(self.parameter(), targets=original.targets))
