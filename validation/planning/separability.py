"""By how much the wrong one of two candidates would fit worse, as tangents have it: a^2 V_kk (1 - c_kl^2)."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from validation.inference.evidence import Evidence, extended_prior
from validation.inference.score import Gram, score, total
from validation.planning.competing_models import CompetingModels

Array = NDArray[np.float64]
Gaps = dict[tuple[int, int], float]
GAP, DECISIVE = 10.0, 20.0  # deviance from which two begin to come apart, and from which a test decides


def separation(evidence: Evidence, models: CompetingModels, more: Gram) -> Gaps:
    """For every pair of a group the gap with more readings than the evidence has, the smaller way."""
    group = models.group
    sign = evidence.score.sign[list(group)]
    s = score(total(evidence.grams).of(group) + more, *extended_prior(evidence.fit), sign)
    V, c = np.diag(s.V), s.cosine
    size = [models.fit(k).values[evidence.names[k]] for k in group]
    strength = [a**2 * v for a, v in zip(size, V, strict=True)]
    return {
        (group[i], group[j]): float(min(strength[i], strength[j]) * (1.0 - c[i, j] ** 2))
        for i, j in combinations(range(len(group)), 2)
    }


def separable_pairs(evidence: Evidence, gaps: Gaps) -> tuple[str, ...]:
    """The pairs whose gap decides, by name."""
    return tuple(f"{evidence.names[k]} / {evidence.names[m]}" for (k, m), gap in gaps.items() if gap >= DECISIVE)
