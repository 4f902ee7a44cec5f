"""A slow sensor."""

from dataclasses import dataclass

from validation.effects.sensors.reading_fault import ReadingFault


@dataclass(frozen=True)
class SensorLag(ReadingFault):
    """First-order lag: a dT_r/dt + T_r = T, a the extra time constant (s)."""

    kind = "sensor.lag"
    title = "sensor follows late"
    unit = "s"
    source = "first-order instrument; contact and mass of the sensor"
    isolating_test = "plunge test; a step of the loss"
    typical = (5.0, 300.0)
    sign = 1
    prior_sd = 60.0
    high = 3600.0
    mapping = "offset"
    confused_with = ("mass",)
    changes = "lag"
