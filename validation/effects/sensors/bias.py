"""A constant error of one sensor."""

from dataclasses import dataclass

from lumped.model.network import Network
from validation.effects.base import Effect, Scene, with_parameter


@dataclass(frozen=True)
class SensorBias(Effect):
    """reading = T + a (K)."""

    kind = "sensor.bias"
    title = "sensor reads too high or too low"
    sits = "a measured temperature"
    unit = "K"
    source = "IEC 60584-1 tolerance classes"
    isolating_test = "swap the sensor with its neighbour; ice bath"
    typical = (-5.0, 5.0)
    sign = 0
    prior_sd = 3.0
    low = -50.0
    high = 50.0
    mapping = "offset"
    confused_with = ("ambient.offset", "loss.constant")
    fault = True

    @classmethod
    def where(cls, scene: Scene) -> tuple[str, ...]:
        return scene.channels

    def extend(self, network: Network) -> Network:
        return with_parameter(network, self.parameter(f"bias:{self.place}"))
