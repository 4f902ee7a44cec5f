"""By how much the wrong one of two candidates would fit worse, as tangents have it: a^2 V_kk (1 - c_kl^2) / kappa^2."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from validation.evidence import Evidence
from validation.rivals import Race
from validation.score import Gram, score, total

Array = NDArray[np.float64]
Gaps = dict[tuple[int, int], float]
DECISIVE = 20.0  # deviance


def separation(evidence: Evidence, found: Race, more: Gram, kappa: Array) -> Gaps:
    """For every pair of a race's group the gap with more readings than the evidence has, the smaller way."""
    chosen = found.group
    fit, sign = evidence.fit, evidence.score.sign[list(chosen)]
    s = score(total(evidence.grams).of(chosen) + more, fit.theta, fit.unknowns.sd, sign)
    V, c = np.diag(s.V), s.cosine
    size = [found.fit(k).values[evidence.names[k]] for k in chosen]
    strength = [size[i] ** 2 * V[i] / kappa[k] ** 2 for i, k in enumerate(chosen)]
    return {
        (chosen[i], chosen[j]): float(min(strength[i], strength[j]) * (1.0 - c[i, j] ** 2))
        for i, j in combinations(range(len(chosen)), 2)
    }


def told_apart(evidence: Evidence, gaps: Gaps) -> tuple[str, ...]:
    """The pairs whose gap decides, by name."""
    return tuple(f"{evidence.names[k]} / {evidence.names[m]}" for (k, m), gap in gaps.items() if gap >= DECISIVE)
