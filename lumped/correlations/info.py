"""What a correlation says about its own answer."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial

from lumped.transfer.ranges import Domain, out_of_range

SIZES = 12  # sizes between the least and the largest, where a range may lie
HALVINGS = 8  # of a step between temperatures: 20 K to 0.1 K


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

    @property
    def words(self) -> tuple[str, ...]:
        """Of each of them, with value and range."""
        each = ((key, self.numbers[key], *self.limits[key]) for key in self.outside)
        return tuple(f"{self.name}: {k} = {x:.4g} outside {a:g} to {b:g} ({self.source})" for k, x, a, b in each)


def checked(name: str, source: str, numbers: Mapping[str, float], limits: Mapping[str, tuple[float, float]]) -> Info:
    """Info, with one RangeWarning for every number outside its range."""
    info = Info(name, source, dict(numbers), dict(limits))
    for words in info.words:
        out_of_range(words)
    return info


def domain(
    info: Callable[[float, float], Info], degC: Iterable[float], usual: tuple[float, float], least: float, most: float
) -> Domain:
    """Where a correlation holds between two sizes and the temperatures.

    info : what it says of itself at a temperature (degC) and a size;  usual : the same two, where it is asked first
    """

    def span(T: float) -> tuple[float, float] | None:
        """The sizes around the usual one, or around the first other that is in range; to 1 %."""
        at, sizes = partial(info, T), (usual[1], *(least * (most / least) ** (k / SIZES) for k in range(SIZES + 1)))
        inside = next((size for size in sizes if not at(size).outside), None)
        if inside is None:
            return None
        low = _last(at, inside, least)
        return (0.0 if low == least else low), _last(at, inside, most)

    every = list(degC)
    spans = {T: ends for T in every if (ends := span(T))}
    if not spans:
        one = info(*usual)
        return Domain(", ".join(one.words) or one.name, (), (), ())
    for inside, step in ((min(spans), -1), (max(spans), 1)):
        outer = every.index(inside) + step
        if 0 <= outer < len(every):
            edge = _edge(span, inside, every[outer])
            spans[edge] = span(edge) or spans[inside]
    low, high = zip(*(spans[T] for T in sorted(spans)), strict=True)
    return Domain(info(*usual).name, tuple(sorted(spans)), low, high)


def _last(info: Callable[[float], Info], inside: float, gone: float) -> float:
    if not info(gone).outside:
        return gone
    while max(inside / gone, gone / inside) > 1.01:
        middle = math.sqrt(inside * gone)
        inside, gone = (inside, middle) if info(middle).outside else (middle, gone)
    return inside


def _edge(span: Callable[[float], object], inside: float, gone: float) -> float:
    for _ in range(HALVINGS):
        middle = 0.5 * (inside + gone)
        inside, gone = (middle, gone) if span(middle) else (inside, middle)
    return inside
