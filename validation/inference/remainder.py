"""What is still off with the best explanation in the model, and what that may be: the model's own doubts, or a second
effect, or nothing that these readings can tell."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from validation.calibration.calibrate import Fit, InnerProduct
from validation.comparison.linearisation import Segment
from validation.inference.decision import Decision
from validation.inference.posterior import Hypothesis, Posterior, probabilities
from validation.inference.refits import REPORTED
from validation.inference.result import Remainder

OFF = 2.0  # deviations of what a sensor and a good model allow, from which a record is called off
MOST = 3  # are told, worst first
LESS = 0.7  # of its error: what another effect must bring a record to, to be its explanation


def remainder(posterior: Posterior, choice: Decision, single: Mapping[int, Hypothesis]) -> tuple[Remainder, ...]:
    """The records that stay off, one per sensor, worst first."""
    lead = frozenset(g[0] for g in choice.groups)
    fit = _fit_of(posterior, lead, single)
    left = {(s.test, s.channel): rms(s.r) / (OFF * s.weight) for s in fit.parts}
    rows: dict[str, Segment] = {}
    for s in sorted(fit.parts, key=lambda s: -left[s.test, s.channel]):
        if left[s.test, s.channel] > 1.0:
            rows.setdefault(s.channel, s)
    measure = InnerProduct(fit.parts, fit.noise, fit.error)
    return tuple(_of(s, posterior, lead, fit, measure) for s in list(rows.values())[:MOST])


def rms(r: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(r**2)))


def _fit_of(posterior: Posterior, lead: frozenset[int], single: Mapping[int, Hypothesis]) -> Fit:
    """The refit with all that is named; where there is none, that of the first of them, or of nothing."""
    whole = [h.fit for h in posterior.hypotheses if h.fit and h.members and set(h.members) == lead]
    alone = [h.fit for k in sorted(lead) if (h := single[k]).fit]
    return (*whole, *alone, posterior.evidence.fit)[0]


def _of(s: Segment, posterior: Posterior, lead: frozenset[int], fit: Fit, measure: InnerProduct) -> Remainder:
    error, doubt, model_K = rms(s.r), "", 0.0
    if fit.error is not None:
        parts = fit.error.of(s) * measure.doubts(fit.parts)
        model_K = error - rms(s.r - parts.sum(axis=1))
        doubt = fit.error.names[int(np.argmax(np.mean(parts**2, axis=0)))]
    effect, p, brought = second(posterior, lead, s)
    how = posterior.evidence.effects[effect].isolating_test if effect is not None else ""
    name = posterior.evidence.names[effect] if effect is not None else ""
    return Remainder(s.channel, s.test, error, max(model_K, 0.0), doubt, name, p, brought, how)


def second(posterior: Posterior, lead: frozenset[int], s: Segment) -> tuple[int | None, float, float]:
    """The effect beside the leading ones that brings a record down most surely, its probability, the error (K) then."""
    rows = [
        (h, float(p))
        for h, p in zip(posterior.hypotheses, probabilities(posterior.hypotheses), strict=True)
        if lead <= set(h.members) and not h.heat
    ]
    whole = sum(p for _, p in rows)
    better = [(p / whole, h, e) for h, p in rows if (e := _brought(h, lead, s)) is not None and e < LESS * rms(s.r)]
    if not better:
        return None, 0.0, 0.0
    p, h, error = max(better, key=lambda x: x[0])
    if p < REPORTED:
        return None, 0.0, 0.0
    return min(set(h.members) - lead), p, error


def _brought(h: Hypothesis, lead: frozenset[int], s: Segment) -> float | None:
    """Error (K) of a record with a hypothesis that adds one effect."""
    if h.fit is None or len(set(h.members) - lead) != 1:
        return None
    return next(rms(x.r) for x in h.fit.parts if (x.test, x.channel) == (s.test, s.channel))
