"""The effects that the readings cannot tell apart, each refitted under one noise."""

from __future__ import annotations

from dataclasses import dataclass

from validation.calibration.calibrate import Fit
from validation.noise import Noise


@dataclass(frozen=True)
class CompetingModels:
    """group : indices of effects, most probable first;  fits : with each in the model"""

    group: tuple[int, ...]
    fits: tuple[Fit, ...]
    noise: Noise

    @property
    def best(self) -> Fit:
        return self.fits[0]

    def fit(self, k: int) -> Fit:
        """The refit with effect k."""
        return self.fits[self.group.index(k)]


def deviance_difference(fit: Fit, best: Fit) -> float:
    """Deviance by which a fit is worse."""
    return 2.0 * (fit.objective - best.objective)
