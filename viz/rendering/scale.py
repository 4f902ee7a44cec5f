"""Colour scales that span the data, marked at round numbers."""

from __future__ import annotations

import math

INTERVALS = 8  # between marks at most: few enough to read
FINE = 10  # parts of an interval to which the ends are widened: a scale from 12 to 93 wastes nothing, and says both
LEAST = 0.8  # K or W: a uniform field has two ends 0.1 apart


def step_of(span: float) -> float:
    """The smallest of 1, 2 and 5 times a power of ten that covers a span in at most eight steps."""
    rough = max(span, LEAST) / INTERVALS
    power = 10.0 ** math.floor(math.log10(rough))
    return next(round(n * power, 12) for n in (1, 2, 5, 10) if n * power >= rough * (1 - 1e-9))


def rounded(low: float, high: float) -> tuple[float, float]:
    """The range widened to whole tenths of the steps between its marks; one that is round already stays as it is."""
    while True:
        fine = step_of(high - low) / FINE
        first = math.floor(low / fine + 1e-6)
        last = max(math.ceil(high / fine - 1e-6), first + 1)
        ends = round(first * fine, 12), round(last * fine, 12)
        if ends == (low, high):
            return ends
        low, high = ends


def marks(low: float, high: float) -> list[float]:
    """Both ends of a rounded range, and the round numbers between that are half a step or more from them."""
    step = step_of(high - low)
    first, last = math.ceil(low / step + 0.5 - 1e-9), math.floor(high / step - 0.5 + 1e-9)
    return [low, *(round(i * step, 12) for i in range(first, last + 1)), high]


def decimals(low: float, high: float) -> int:
    """Digits after the point that all marks of a rounded range need."""
    every, most = marks(low, high), max(0, -math.floor(math.log10(step_of(high - low) / FINE) + 1e-9))
    return next((n for n in range(most) if all(abs(round(m, n) - m) < 1e-9 for m in every)), most)
