"""What the pictures are drawn from, besides meshes and result documents."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from validation.case import Channel, Test

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sensor:
    """A thermocouple on the machine.

    xyz : position (m);  residual_K : measured - modelled, None where only the position is known
    limit_K : what the sensor's uncertainty explains (2 sigma)
    """

    name: str
    xyz: tuple[float, float, float]
    residual_K: float | None = None
    limit_K: float = 1.0

    @property
    def verdict(self) -> str:
        """unknown, within, hot (measured above the model) or cold."""
        if self.residual_K is None or not np.isfinite(self.residual_K):
            return "unknown"
        if abs(self.residual_K) <= self.limit_K:
            return "within"
        return "hot" if self.residual_K > 0 else "cold"


@dataclass(frozen=True)
class Comparison:
    """One test held against a model.

    model : channel name -> (n_time,) degC;  before : the same of an earlier revision, if it is to be shown
    """

    test: Test
    model: Mapping[str, Array]
    before: Mapping[str, Array] | None = None

    def __post_init__(self) -> None:
        missing = [c.name for c in self.test.channels if c.name not in self.model]
        if missing:
            raise InputError(f"no model curve for {', '.join(missing)}", f"test '{self.test.name}'", "one per channel")

    @property
    def minutes(self) -> Array:
        return np.asarray(self.test.time, float) / 60.0

    def residual(self, channel: Channel) -> Array:
        """Measured - modelled (K), NaN where nothing was read."""
        return np.asarray(channel.y, float) - np.asarray(self.model[channel.name], float)

    def rmse(self, channel: Channel) -> float:
        return float(np.sqrt(np.nanmean(self.residual(channel) ** 2)))


def sensors(comparison: Comparison, positions: Mapping[str, Sequence[float]]) -> tuple[Sensor, ...]:
    """Sensors of a test at their positions (m) with the mean residual of its last fifth, where the machine is warm."""
    late = slice(int(0.8 * len(comparison.test.time)), None)
    return tuple(
        Sensor(c.name, tuple(positions[c.name]), float(np.nanmean(comparison.residual(c)[late])), 2 * c.sigma_K)  # type: ignore[arg-type]
        for c in comparison.test.channels
        if c.name in positions
    )
