"""What a correlation says about its own answer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from lumped.transfer.ranges import out_of_range


@dataclass(frozen=True)
class Info:
    """name and source of the correlation; numbers: Nu, Re, Ra, ... it went through."""

    name: str
    source: str
    numbers: Mapping[str, float]
    limits: Mapping[str, tuple[float, float]]

    @property
    def outside(self) -> tuple[str, ...]:
        """The dimensionless numbers that lie outside the source's range."""
        return tuple(k for k, (low, high) in self.limits.items() if not low <= self.numbers[k] <= high)


def checked(name: str, source: str, numbers: Mapping[str, float], limits: Mapping[str, tuple[float, float]]) -> Info:
    """Info, with one RangeWarning for every number outside its range."""
    info = Info(name, source, dict(numbers), dict(limits))
    for key in info.outside:
        low, high = limits[key]
        out_of_range(f"{name}: {key} = {numbers[key]:.4g} outside {low:g} to {high:g} ({source})")
    return info
