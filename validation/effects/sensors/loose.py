"""A sensor that came loose."""

from dataclasses import dataclass

from lumped.model.sites import ambient
from validation.effects.base import Scene
from validation.effects.sensors.reading_fault import ReadingFault


@dataclass(frozen=True)
class SensorLoose(ReadingFault):
    """reading = T + a (T_ambient - T), 0 <= a <= 1, since it slipped off, or in a test in which it sat elsewhere."""

    kind = "sensor.loose"
    title = "sensor has come loose"
    unit = "1"
    source = "definition: between the part and the air, it reads a mean of both"
    isolating_test = "look at the sensor; read the part with a second one"
    typical = (0.1, 1.0)
    sign = 1
    prior_sd = 0.4
    high = 1.0
    confused_with = ("sensor.stem", "convection.constant")
    changes = "stem"
    temporary = True

    @classmethod
    def candidate_places(cls, scene: Scene) -> tuple[str, ...]:
        return scene.channels if ambient(scene.network) else ()
