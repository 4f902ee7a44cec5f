"""Faults of what one sensor says; the machine is as warm as before."""

from collections.abc import Iterable, Iterator
from typing import ClassVar

from lumped.model.network import Network
from lumped.model.sites import ambient
from validation.effects.base import Effect, Scene, with_parameter


class ReadingFault(Effect):
    """changes : which part of a reading, as targets of parameters name it ("bias", "gain", "lag", ...)"""

    changes: ClassVar[str]
    sits = "a measured temperature"
    sign = 0
    fault = True

    @classmethod
    def candidate_places(cls, scene: Scene) -> Iterable[str]:
        return scene.channels

    def extend(self, network: Network) -> Network:
        return with_parameter(network, self.parameter(f"{self.changes}:{self.place}"))


class SensorBias(ReadingFault):
    """A constant error: reading = T + a (K)."""

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


class SensorDrift(ReadingFault):
    """A sensor that works loose or ages: reading = T + a t, a the drift (K/h), from the start of each test."""

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


class SensorGain(ReadingFault):
    """A scale error: reading = 20 degC + (1 + a) (T - 20 degC)."""

    kind = "sensor.gain"
    title = "sensor reads a wrong slope"
    source = "definition; wrong thermocouple type gives tens of percent"
    isolating_test = "compare with a reference sensor at two temperatures"
    typical = (-0.2, 0.2)
    prior_sd = 0.1
    low = -0.9
    high = 5.0
    mapping = "relative"
    confused_with = ("sensor.stem", "sensor.bias")
    changes = "gain"


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


class SensorStem(ReadingFault):
    """Heat lost along the sensor's leads: reading = T + a (T_ambient - T), 0 <= a < 1."""

    kind = "sensor.stem"
    title = "stem conduction pulls the reading to ambient"
    source = "fin equation of the leads, a = h-dependent share (VDI/VDE 3511)"
    isolating_test = "insulate or anneal the leads; a second sensor with thinner wires"
    typical = (0.02, 0.2)
    sign = 1
    prior_sd = 0.1
    high = 0.95
    mapping = "relative"
    confused_with = ("sensor.gain", "convection.constant")
    changes = "stem"


class SensorLoose(ReadingFault):
    """reading = T + a (T_ambient - T), 0 <= a <= 1, since it slipped off, or in a test in which it sat elsewhere."""

    kind = "sensor.loose"
    title = "sensor has come loose"
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


class SensorSlip(SensorLoose):
    """The same, but its own mass takes a minute to get there (`measured.sensors.operators.SLIP_S`)."""

    kind = "sensor.slip"
    title = "sensor has come loose and settles slowly"
    confused_with = ("sensor.loose", "convection.constant")
    changes = "slip"


class SensorDelay(ReadingFault):
    """Temperatures and inputs logged on two clocks: all readings of one test come a seconds late."""

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


class Swap(ReadingFault):
    """Two plugs exchanged: reading_1 = T_1 + a (T_2 - T_1) and the reverse; a = 1 is a full swap."""

    kind = "sensor.swap"
    title = "two channels are exchanged"
    sits = "two measured temperatures"
    source = "definition"
    isolating_test = "warm one sensor by hand"
    typical = (1.0, 1.0)
    sign = 1
    prior_sd = 0.5
    high = 1.0
    mapping = "relative"
    confused_with = ("sensor.gain", "contact")
    changes = "swap"
    whole = True

    @classmethod
    def candidate_places(cls, scene: Scene) -> Iterator[str]:
        names = scene.channels
        return (f"{a}|{b}" for i, a in enumerate(names) for b in names[i + 1 :])
