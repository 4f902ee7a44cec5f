"""A declared loss that is off by a factor."""

from lumped.model.network import Network
from lumped.sources.loss_laws import declared_name
from validation.effects.base import Effect, Scene, with_parameter


class LossFactor(Effect):
    """P = P0 (1 + a) of one declared loss, in proportion at all loads."""

    kind = "loss.factor"
    title = "a declared loss is off by a factor"
    sits = "a declared loss"
    source = "definition: a loss map of another machine, a wrong number of phases or of watts per phase"
    isolating_test = "no-load and locked-rotor runs with a power meter"
    typical = (-0.5, 1.0)
    sign = 0
    prior_sd = 0.3
    low = -0.95
    high = 5.0
    mapping = "relative"
    confused_with = ("input.factor", "loss.winding", "iron")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return list(dict.fromkeys(declared_name(s.name) for s in scene.network.sources if not s.origin))

    def extend(self, network: Network) -> Network:
        parts = (s.name for s in network.sources if declared_name(s.name) == self.place)
        return with_parameter(network, self.parameter(*parts))
