"""Heat lost along the sensor's leads."""

from dataclasses import dataclass

from lumped.model.network import Network
from validation.effects.base import Effect, Scene, with_parameter


@dataclass(frozen=True)
class SensorStem(Effect):
    """reading = T + a (T_ambient - T), 0 <= a < 1."""

    kind = "sensor.stem"
    title = "stem conduction pulls the reading to ambient"
    sits = "a measured temperature"
    unit = "1"
    source = "fin equation of the leads, a = h-dependent share (VDI/VDE 3511)"
    isolating_test = "insulate or anneal the leads; a second sensor with thinner wires"
    typical = (0.02, 0.2)
    sign = 1
    prior_sd = 0.1
    low = 0.0
    high = 0.95
    mapping = "relative"
    confused_with = ("sensor.gain", "convection.constant")
    fault = True

    @classmethod
    def where(cls, scene: Scene) -> tuple[str, ...]:
        return scene.channels

    def extend(self, network: Network) -> Network:
        return with_parameter(network, self.parameter(f"stem:{self.place}"))
