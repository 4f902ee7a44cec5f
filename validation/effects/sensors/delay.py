"""Temperatures and inputs logged on two clocks."""

from dataclasses import dataclass

from validation.effects.base import Scene
from validation.effects.sensors.reading_fault import ReadingFault


@dataclass(frozen=True)
class SensorDelay(ReadingFault):
    """All readings of one test come a seconds late."""

    kind = "time.offset"
    title = "clock of the temperatures is off"
    sits = "a test"
    unit = "s"
    source = "definition"
    isolating_test = "a loss step that both loggers see"
    typical = (-60.0, 60.0)
    prior_sd = 30.0
    low = -3600.0
    high = 3600.0
    mapping = "offset"
    confused_with = ("sensor.lag",)
    changes = "delay"

    @property
    def large(self) -> tuple[float, ...]:
        """Clocks that were set by hand are off by minutes, which no tangent foretells."""
        return (-300.0, -150.0, -60.0, 60.0, 150.0, 300.0)

    @classmethod
    def candidate_places(cls, scene: Scene) -> tuple[str, ...]:
        return scene.tests
