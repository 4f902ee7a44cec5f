"""A fault of what one sensor says; the machine is as warm as before."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar

from lumped.model.network import Network
from validation.effects.base import Effect, Scene, with_parameter


@dataclass(frozen=True)
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
