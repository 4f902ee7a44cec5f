"""Cooling air that never reaches the machine."""

from dataclasses import dataclass

from lumped.model.network import Link, Network
from lumped.model.sites import cell, model_links
from validation.effects.base import Effect, Scene, with_parameter


def streams(network: Network) -> list[Link]:
    return [link for link in model_links(network) if link.kind == "stream" and not cell(network, link.places[1])]


@dataclass(frozen=True)
class AirLeak(Effect):
    """A share of a fluid stream passes by: m = m0 (1 + a), -0.95 <= a <= 0, films on the rest unchanged."""

    kind = "bypass"
    empirical = True
    title = "part of the stream passes by"
    sits = "a stream"
    unit = "1"
    source = "mass balance of the stream"
    isolating_test = "inlet and outlet temperature at constant loss; flow sweep"
    typical = (-0.6, -0.1)
    sign = -1
    prior_sd = 0.3
    low = -0.95
    high = 0.0
    mapping = "relative"
    confused_with = ("flow",)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return [link.name.split(":", 1)[-1] for link in streams(scene.network)]

    def extend(self, network: Network) -> Network:
        names = [link.name for link in streams(network) if link.name.split(":", 1)[-1] == self.place]
        return with_parameter(network, self.parameter(*names))
