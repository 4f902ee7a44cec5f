"""A scale error of one sensor."""

from dataclasses import dataclass

from validation.effects.sensors.reading_fault import ReadingFault


@dataclass(frozen=True)
class SensorGain(ReadingFault):
    """reading = 20 degC + (1 + a) (T - 20 degC)."""

    kind = "sensor.gain"
    title = "sensor reads a wrong slope"
    unit = "1"
    source = "definition; wrong thermocouple type gives tens of percent"
    isolating_test = "compare with a reference sensor at two temperatures"
    typical = (-0.2, 0.2)
    prior_sd = 0.1
    low = -0.9
    high = 5.0
    mapping = "relative"
    confused_with = ("sensor.stem", "sensor.bias")
    changes = "gain"
