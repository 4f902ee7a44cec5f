"""Meters as their data sheets have them: limit of error by range, and which range a reading belongs to."""

from collections.abc import Sequence
from dataclasses import dataclass

from geom.errors import InputError
from measured.electrical.propagation import Reading


@dataclass(frozen=True)
class Range:
    """One range of a meter, in its unit; limit of error = percent of the reading + offset."""

    low: float
    high: float
    percent: float
    offset: float
    resolution: float

    def limit(self, value: float) -> float:
        return self.percent / 100.0 * abs(value) + self.offset


@dataclass(frozen=True)
class Meter:
    """A meter with its ranges, finest first."""

    name: str
    unit: str
    ranges: tuple[Range, ...]

    def range_for(self, value: float, where: str = "") -> Range:
        """The finest range that holds the value."""
        for one in sorted(self.ranges, key=lambda r: r.high):
            if one.low <= value <= one.high:
                return one
        top, bottom = max(r.high for r in self.ranges), min(r.low for r in self.ranges)
        right = f"readings from {bottom:g} to {top:g} {self.unit}"
        raise InputError(f"{value:g} {self.unit} is outside the ranges of the {self.name}", where, right)

    def chosen(self, value: float, range_high: float | None, where: str) -> Range:
        """The range the reading was taken on; refused when a finer one would have held it.

        range_high : upper end of the range that was set, None when the meter chose
        """
        best = self.range_for(value, where)
        if range_high is None or abs(range_high - best.high) < 1e-9 * best.high:
            return best
        names = ", ".join(f"{r.low:g}-{r.high:g} {self.unit}" for r in self.ranges)
        if all(abs(range_high - r.high) > 1e-9 * r.high for r in self.ranges):
            raise InputError(
                f"the {self.name} has no range up to {range_high:g} {self.unit}", where, f"ranges: {names}"
            )
        nearest = min(self.ranges, key=lambda r: abs(r.high - range_high))
        why = f"{value:g} {self.unit} was read on the range up to {range_high:g} {self.unit}, "
        if nearest.high < value:
            raise InputError(why + "which ends below it", where, f"the range up to {best.high:g} {self.unit}")
        right = f"the range up to {best.high:g} {self.unit} (resolution {best.resolution:g})"
        raise InputError(f"{why}resolution {nearest.resolution:g} {self.unit}", where, right)

    def reading(self, name: str, value: float) -> Reading:
        """The value with the limit of error of its range."""
        return Reading(name, value, self.range_for(value, name).limit(value))

    def mean(self, name: str, values: Sequence[float]) -> Reading:
        """The mean of repeated readings: the limit of error is common to them, so it does not shrink."""
        return self.reading(name, sum(values) / len(values))


# Chauvin Arnoux C.A 6240 and Yokogawa WT1600 as published with the procedure; the next ohm range by its resolution.
OHMMETER = Meter("micro-ohmmeter", "ohm", (Range(0.4, 4.0, 0.25, 2e-3, 2e-3), Range(4.0, 40.0, 0.25, 20e-3, 20e-3)))
VOLTMETER = Meter("power meter", "V", (Range(0.0, 1000.0, 0.1, 1.0, 0.01),))
