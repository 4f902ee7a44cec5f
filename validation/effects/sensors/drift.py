"""A sensor that works loose or ages."""

from dataclasses import dataclass

from validation.effects.sensors.reading_fault import ReadingFault


@dataclass(frozen=True)
class SensorDrift(ReadingFault):
    """reading = T + a t, a the drift (K/h), from the start of each test."""

    kind = "sensor.drift"
    title = "sensor drifts during the test"
    unit = "K/h"
    source = "definition: adhesive that lets go, thermocouple decalibration"
    isolating_test = "repeat the start of the test; ice bath before and after"
    typical = (-5.0, 5.0)
    prior_sd = 1.0
    low = -50.0
    high = 50.0
    mapping = "offset"
    confused_with = ("fouling",)
    changes = "drift"
