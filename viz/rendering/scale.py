"""Colour scales whose ends and marks are round numbers."""

from __future__ import annotations

import math

INTERVALS = (
    8  # at most between marks before the ends are widened: few enough to read, and little of the range is wasted
)
LEAST = 0.8  # K or W: a uniform field has two ends 0.1 apart


def step_of(span: float) -> float:
    """The smallest of 1, 2 and 5 times a power of ten that covers a span in at most eight steps."""
    rough = max(span, LEAST) / INTERVALS
    power = 10.0 ** math.floor(math.log10(rough))
    return next(round(n * power, 12) for n in (1, 2, 5, 10) if n * power >= rough * (1 - 1e-9))


def rounded(low: float, high: float) -> tuple[float, float]:
    """The range widened to whole steps; one that is round already stays as it is."""
    while True:
        step = step_of(high - low)
        first = math.floor(low / step + 1e-9)
        last = max(math.ceil(high / step - 1e-9), first + 1)
        ends = round(first * step, 12), round(last * step, 12)
        if ends == (low, high):
            return ends
        low, high = ends


def marks(low: float, high: float) -> list[float]:
    """The round numbers of a rounded range, both ends among them."""
    step = step_of(high - low)
    return [round(low + i * step, 12) for i in range(round((high - low) / step) + 1)]


def decimals(span: float) -> int:
    """Digits after the point that tell the marks of a range apart."""
    return max(0, -math.floor(math.log10(step_of(span)) + 1e-9))
