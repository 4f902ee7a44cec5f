"""The evidence of what carries weight without linearisation: refitted, with Laplace's integral at its own optimum."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from validation.calibrate import Fit, silent
from validation.doubt import SIZES
from validation.inference.evidence import Evidence, refit, starts
from validation.inference.posterior import Hypothesis, probabilities, told

Array = NDArray[np.float64]
WEIGHT = 0.01  # posterior probability from which a hypothesis is refitted
ROUNDS, MOST = 4, 8  # what a refit promotes is refitted too; so many at once


def refitted(
    evidence: Evidence, hypotheses: Sequence[Hypothesis], progress: Callable[[str], None] = silent
) -> list[Hypothesis]:
    """The hypotheses with those that carry weight refitted, until none does that is not."""
    out = list(hypotheses)
    for _ in range(ROUNDS):
        P = probabilities(out)
        due = [i for i in np.argsort(-P) if P[i] > WEIGHT and out[i].members and out[i].fit is None][:MOST]
        if not due:
            break
        for i in due:
            progress(f"refitting {out[i].name(evidence)}")
            out[i] = laplace(evidence, out[i])
    return out


def laplace(evidence: Evidence, h: Hypothesis) -> Hypothesis:
    """The hypothesis with the best of its refits and the evidence that follows."""
    fits = [refit(evidence, h.members, theta) for theta in starts(evidence, h.members)]
    best = min(fits, key=lambda fit: fit.objective)
    return replace(h, fit=best, log_bayes=log_bayes(evidence, best, h.members))


def log_bayes(evidence: Evidence, fit: Fit, members: Sequence[int]) -> float:
    """Log evidence over that of nothing: the gain at the optimum, times what the prior of the amplitudes gives there.

    The curvature of what calibration moves is taken to be the same for all.
    """
    free = [k for k in members if not evidence.effects[k].whole]
    p, m = evidence.p, len(free)
    if not m:
        return evidence.fit.objective - fit.objective
    wide = fit.unknowns.sd[p:]
    a = fit.theta[p:]
    gain = evidence.fit.objective - (fit.objective - 0.5 * float(np.sum((a / wide) ** 2)))
    bare = fit.H - np.diag(np.concatenate([np.zeros(p), wide**-2.0]))
    v = np.linalg.inv(bare)[p:, p:]
    sd = np.array([evidence.parameters[k].prior_sd for k in free])
    sign = np.array([evidence.parameters[k].sign for k in free], int)
    return gain + float(logsumexp([_seen(a, v, f * sd, sign) for f in SIZES]) - np.log(len(SIZES)))


def _seen(a: Array, v: Array, sd: Array, sign: NDArray[np.int64]) -> float:
    """log of the integral of exp(-1/2 (x - a)' v^-1 (x - a)) over the prior of x, signs in account."""
    wide = v + np.diag(sd**2)
    posterior = np.linalg.inv(np.linalg.inv(v) + np.diag(sd**-2.0))
    mean = posterior @ np.linalg.solve(v, a)
    log = -0.5 * a @ np.linalg.solve(wide, a) + 0.5 * (np.linalg.slogdet(v)[1] - np.linalg.slogdet(wide)[1])
    return float(log + np.sum(told(mean / np.sqrt(np.diag(posterior)), sign)))
