"""A slow sensor."""

from dataclasses import dataclass

from lumped.model.network import Network
from validation.effects.base import Effect, Scene, with_parameter


@dataclass(frozen=True)
class SensorLag(Effect):
    """First-order lag: a dT_r/dt + T_r = T, a the extra time constant (s)."""

    kind = "sensor.lag"
    title = "sensor follows late"
    sits = "a measured temperature"
    unit = "s"
    source = "first-order instrument; contact and mass of the sensor"
    isolating_test = "plunge test; a step of the loss"
    typical = (5.0, 300.0)
    sign = 1
    prior_sd = 60.0
    low = 0.0
    high = 3600.0
    mapping = "offset"
    confused_with = ("mass",)
    fault = True

    @classmethod
    def where(cls, scene: Scene) -> tuple[str, ...]:
        return scene.channels

    def extend(self, network: Network) -> Network:
        return with_parameter(network, self.parameter(f"lag:{self.place}"))
