"""How large an effect must be to be seen: the amplitude whose evidence outweighs nothing four times in five."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from measured.doubt import PRIOR, nats_worth
from validation.inference.evidence import Evidence
from validation.inference.posterior import prior_shares
from validation.inference.score import one_size

Array = NDArray[np.float64]
POWER = 0.842  # normal quantile of 80 %
HALVINGS = 60  # of the interval up to FARTHEST: past the last bit of a number
FARTHEST = 1e4  # prior deviations: beyond them an effect is never seen


def thresholds(evidence: Evidence) -> Array:
    """(K,) log Bayes factor from which each effect is more probable than nothing, temper in account."""
    return np.array([nats_worth(x) for x in np.log(PRIOR["nothing"].share / prior_shares(evidence))])


def smallest(evidence: Evidence) -> Array:
    """(K,) smallest amplitude that passes its threshold four times in five, inf where none does; linear."""
    s, sd = evidence.score, np.array([q.prior_sd for q in evidence.parameters])
    V, limit, side = np.diag(s.V), thresholds(evidence), np.where(s.sign == 0, 1, s.sign)
    low, high = np.zeros_like(sd), FARTHEST * sd

    def passes(a: Array) -> NDArray[np.bool_]:
        u = side * np.maximum(a * V - POWER * np.sqrt(np.maximum(V, 0.0)), 0.0)
        return one_size(u, V, sd, s.sign) > limit

    never = ~s.visible | ~passes(high)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        detectable = passes(middle)
        low, high = np.where(detectable, low, middle), np.where(detectable, middle, high)
    return np.where(never, np.inf, high)
