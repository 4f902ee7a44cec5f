"""A scale error of one sensor."""

from dataclasses import dataclass

from lumped.model.network import Network
from validation.effects.base import Effect, Scene, with_parameter


@dataclass(frozen=True)
class SensorGain(Effect):
    """reading = 20 degC + (1 + a) (T - 20 degC)."""

    kind = "sensor.gain"
    title = "sensor reads a wrong slope"
    sits = "a measured temperature"
    unit = "1"
    source = "definition; wrong thermocouple type gives tens of percent"
    isolating_test = "compare with a reference sensor at two temperatures"
    typical = (-0.2, 0.2)
    sign = 0
    prior_sd = 0.1
    low = -0.9
    high = 5.0
    mapping = "relative"
    confused_with = ("sensor.stem", "sensor.bias")
    fault = True

    @classmethod
    def where(cls, scene: Scene) -> tuple[str, ...]:
        return scene.channels

    def extend(self, network: Network) -> Network:
        return with_parameter(network, self.parameter(f"gain:{self.place}"))
