"""Surroundings at another temperature than recorded."""

from lumped.model.network import Network
from validation.effects.base import Effect, Scene, with_parameter


class AmbientOffset(Effect):
    """The machine feels a boundary temperature a (K) above the recorded one: recirculation, sun, sensor elsewhere."""

    kind = "ambient.offset"
    title = "boundary temperature is not the recorded one"
    sits = "a boundary"
    unit = "K"
    source = "definition"
    isolating_test = "read the air at the machine's inlet and on both sides; a step of the chamber's temperature"
    typical = (-10.0, 10.0)
    sign = 0
    prior_sd = 3.0
    low = -60.0
    high = 60.0
    mapping = "offset"
    confused_with = ("sensor.bias", "loss.constant")
    fault = True
    of_tests = True

    @classmethod
    def candidate_places(cls, scene: Scene) -> tuple[str, ...]:
        return scene.network.boundaries

    def extend(self, network: Network) -> Network:
        return with_parameter(network, self.parameter(f"boundary:{self.place}"))
