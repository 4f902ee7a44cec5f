"""Copper that heats more when it is hot."""

from dataclasses import dataclass

from lumped.laws import Linear
from lumped.network import Network
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import Shaped, copy_source

REFERENCE = 20.0


@dataclass(frozen=True)
class CopperFeedback(Effect):
    """Missing temperature feedback of a copper loss: P = P0 (1 + a (T - 20 degC)), a in 1/K."""

    kind = "copper.feedback"
    title = "copper resistance does not follow its temperature"
    unit = "1/K"
    source = "IEC 60034-1: copper, 0.00393 1/K at 20 degC"
    isolating_test = "log the winding resistance during a constant-current run"
    typical = (0.0035, 0.0042)
    prior_sd = 0.004
    high = 0.02
    confused_with = ("copper.ac", "loss.winding")

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        copper = [s for s in scene.network.sources if s.kind == "copper" and not s.origin]
        return [s.name.split(":", 1)[-1] for s in copper if not isinstance(s.law.temperature, Linear)]

    def extend(self, network: Network) -> Network:
        (source,) = [s for s in network.sources if s.name.split(":", 1)[-1] == self.place]
        rising, constant = f"{self.name}:rise", f"{self.name}:base"
        law = Shaped(source.law, lambda inputs: 1.0, Linear(1.0, REFERENCE))
        network = copy_source(network, source, rising, law)
        network = copy_source(network, source, constant, Shaped(source.law, lambda inputs: -1.0))
        return with_parameter(network, self.parameter(rising, constant))
