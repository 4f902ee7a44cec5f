"""More or less fan air or coolant than stated."""

from dataclasses import dataclass, replace

from lumped.network import Network, Parameter
from validation.effects.base import Effect, Scene, with_parameter


def flows(network: Network) -> list[Parameter]:
    """Parameters that stand for a flow, e.g. 'fan.flow'."""
    return [p for p in network.parameters if p.name.endswith("flow") and p.mapping == "log"]


@dataclass(frozen=True)
class Flow(Effect):
    """A flow that differs from the stated one: V = V0 (1 + a), with everything that follows the flow."""

    kind = "flow"
    title = "fan or coolant flow differs from the stated one"
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
    def where(cls, scene: Scene) -> list[str]:
        return [p.name for p in flows(scene.network)]

    def extend(self, network: Network) -> Network:
        (original,) = [p for p in flows(network) if p.name == self.place]
        return with_parameter(network, replace(self.parameter(), targets=original.targets))
