"""A constant error of one sensor."""

from dataclasses import dataclass

from validation.effects.sensors.reading_fault import ReadingFault


@dataclass(frozen=True)
class SensorBias(ReadingFault):
    """reading = T + a (K)."""

    kind = "sensor.bias"
    title = "sensor reads too high or too low"
    unit = "K"
    source = "IEC 60584-1 tolerance classes"
    isolating_test = "swap the sensor with its neighbour; ice bath"
    typical = (-5.0, 5.0)
    prior_sd = 3.0
    low = -50.0
    high = 50.0
    mapping = "offset"
    confused_with = ("ambient.offset", "loss.constant")
    changes = "bias"
