"""A declared loss that is off by a factor."""

from lumped.model.network import Network, Source
from lumped.model.sites import part_of
from lumped.sources.loss_laws import declared_name
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import losses_at


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

    def sources(self, network: Network) -> list[Source]:
        return [s for s in network.sources if declared_name(s.name) == self.place]

    def extend(self, network: Network) -> Network:
        return with_parameter(network, self.parameter(*(s.name for s in self.sources(network))))


class PartLossFactor(LossFactor):
    """All declared losses of a part are larger or smaller by one share: an overload, a lost phase, shorted turns."""

    kind = "loss.factor.all"
    title = "all losses higher by a share"
    sits = "a part with declared losses"
    source = "definition: this part alone under another load, turns or sheets in short circuit"
    isolating_test = "the same load again with a power meter, or with the load shared anew"
    confused_with = ("loss.constant", "blockage", "input.factor")
    temporary = True

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        every = (s for s in scene.network.sources if not s.origin)
        return list(dict.fromkeys(part_of(scene.network, s.place) for s in every))

    def sources(self, network: Network) -> list[Source]:
        return [s for s in losses_at(network, self.place) if not s.origin]
