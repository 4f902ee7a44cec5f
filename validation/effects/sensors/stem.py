"""Heat lost along the sensor's leads."""

from dataclasses import dataclass

from validation.effects.sensors.reading_fault import ReadingFault


@dataclass(frozen=True)
class SensorStem(ReadingFault):
    """reading = T + a (T_ambient - T), 0 <= a < 1."""

    kind = "sensor.stem"
    title = "stem conduction pulls the reading to ambient"
    unit = "1"
    source = "fin equation of the leads, a = h-dependent share (VDI/VDE 3511)"
    isolating_test = "insulate or anneal the leads; a second sensor with thinner wires"
    typical = (0.02, 0.2)
    sign = 1
    prior_sd = 0.1
    high = 0.95
    mapping = "relative"
    confused_with = ("sensor.gain", "convection.constant")
    changes = "stem"
