"""Two channels exchanged."""

from collections.abc import Iterator
from dataclasses import dataclass

from validation.effects.base import Scene
from validation.effects.sensors.reading_fault import ReadingFault


@dataclass(frozen=True)
class Swap(ReadingFault):
    """Two plugs exchanged: reading_1 = T_1 + a (T_2 - T_1) and the reverse; a = 1 is a full swap."""

    kind = "sensor.swap"
    title = "two channels are exchanged"
    sits = "two measured temperatures"
    unit = "1"
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
