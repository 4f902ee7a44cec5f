"""The air gap between rotor and stator as an equivalent conductance of speed: two films onto one node of gap air."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from geom.errors import InputError


@dataclass(frozen=True)
class AirGap:
    """rotor_radius, gap (m); k : of air (W/m/K); nusselt : Nu = h gap / k of one wall at a speed (rad/s), 2 at rest.

    At rest the conductance is that of an annulus of still air, 2 pi k / ln(stator radius / rotor radius) per metre.
    """

    rotor_radius: float
    gap: float
    k: float
    nusselt: Callable[[float], float]

    def __post_init__(self) -> None:
        if not min(self.rotor_radius, self.gap, self.k) > 0:
            raise InputError("an air gap without width, radius or conductivity", "air gap", "values above 0")

    @property
    def _log(self) -> float:
        return float(np.log1p(self.gap / self.rotor_radius))

    def conductance(self, speed: float) -> float:
        """W/K per metre of axial length, from rotor to stator."""
        return float(np.pi * self.k * self.nusselt(speed) / self._log)

    def films(self, speed: float) -> tuple[float, float]:
        """h (W/m2/K) of the rotor's and of the stator's wall; they halve the resistance between them."""
        per_metre = 2 * self.conductance(speed) / (2 * np.pi)
        return per_metre / self.rotor_radius, per_metre / (self.rotor_radius + self.gap)
