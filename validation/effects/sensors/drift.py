"""A sensor that works loose or ages."""

from dataclasses import dataclass

from lumped.model.network import Network
from validation.effects.base import Effect, Scene, with_parameter


@dataclass(frozen=True)
class SensorDrift(Effect):
    """reading = T + a t, a the drift (K/h), from the start of each test."""

    kind = "sensor.drift"
    title = "sensor drifts during the test"
    sits = "a measured temperature"
    unit = "K/h"
    source = "definition: adhesive that lets go, thermocouple decalibration"
    isolating_test = "repeat the start of the test; ice bath before and after"
    typical = (-5.0, 5.0)
    sign = 0
    prior_sd = 1.0
    low = -50.0
    high = 50.0
    mapping = "offset"
    confused_with = ("fouling",)
    fault = True

    @classmethod
    def where(cls, scene: Scene) -> tuple[str, ...]:
        return scene.channels

    def extend(self, network: Network) -> Network:
        return with_parameter(network, self.parameter(f"drift:{self.place}"))
