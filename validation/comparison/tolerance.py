"""When a model agrees with a sensor: one rule for tables, dots, bars, curves and the report.

The error, measured - model, is held against the expanded uncertainty of the reading, or against 4 % of what the sensor
rose, whichever is larger. What inputs and arithmetic leave open besides stands in `validation.comparison.uncertainty`.
"""

from __future__ import annotations

import numpy as np

from validation.case import Channel

COVERAGE = 2.0  # standard deviations: 95 %
RULE_PERCENT = 4.0  # of the rise: what published models of machines reach
WORDS = f"within: up to {COVERAGE:g} sigma of the sensor, or {RULE_PERCENT:g} % of its rise"


def limit_K(channel: Channel) -> float:
    """The largest error (K) that counts as agreement."""
    return limit(channel.sigma_K, rise_K(channel))


def limit(sigma_K: float, rise_K: float) -> float:
    """The same from a sensor's uncertainty and rise (K)."""
    return max(COVERAGE * sigma_K, 1e-2 * RULE_PERCENT * rise_K)


def rise_K(channel: Channel) -> float:
    """How far a sensor went from its first reading (K); 0 where it was never read."""
    seen = channel.y[np.isfinite(channel.y)]
    return float(np.max(np.abs(seen - seen[0]))) if seen.size else 0.0
