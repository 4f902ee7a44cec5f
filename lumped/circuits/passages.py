"""What oil passes besides channels of a jacket: a round bore, as of a hollow shaft, and nozzles above a face."""

import math
from dataclasses import dataclass

from lumped.correlations.ducts import duct_film
from lumped.correlations.info import Info
from lumped.correlations.oil import sprayed_face
from lumped.transfer.properties import Fluid

FILM_M = 1e-3  # of oil on a face
BORE = 3.0  # length of a nozzle over its diameter: where the pressure is lost


@dataclass(frozen=True)
class Bore:
    """Equal round bores side by side: diameter, length (m); bends of 90 degrees.

    One that turns about its own axis is as one that stands: a laminar flow turns with it, and its film stays.
    """

    diameter: float
    length: float
    bends: int = 0
    parallel: int = 1
    coil: float = 0.0

    @property
    def section(self) -> float:
        """Of all together (m2)."""
        return self.parallel * 0.25 * math.pi * self.diameter**2

    @property
    def volume(self) -> float:
        """m3"""
        return self.section * self.length

    @property
    def wall(self) -> float:
        """Wetted area (m2)."""
        return self.parallel * math.pi * self.diameter * self.length

    def film(self, flow: float, fluid: Fluid) -> tuple[float, Info]:
        """h (W/m2/K) at a flow (m3/s)."""
        return duct_film(flow / self.section, self.diameter, self.length, fluid)


@dataclass(frozen=True)
class Nozzles:
    """Equal nozzles and the face under them.

    diameter : of a nozzle (m);  wall : area of the face (m2);  run : way of the oil along it (m)
    drip : whether oil falls from them without a jet
    """

    number: int
    diameter: float
    wall: float
    run: float
    drip: bool = False
    bends: int = 0
    coil: float = 0.0

    @property
    def section(self) -> float:
        """Of all nozzles (m2)."""
        return self.number * 0.25 * math.pi * self.diameter**2

    @property
    def length(self) -> float:
        """Of a nozzle (m)."""
        return BORE * self.diameter

    @property
    def volume(self) -> float:
        """Of the oil on the face (m3)."""
        return FILM_M * self.wall

    def film(self, flow: float, fluid: Fluid) -> tuple[float, Info]:
        """h (W/m2/K) at a flow (m3/s)."""
        return sprayed_face(flow, self.number, self.diameter, self.wall, self.run, fluid, self.drip)
