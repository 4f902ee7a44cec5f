"""More than two at once: from the best explanation so far the tangents of all others are made anew, and the next is
fitted beside it, as long as that pays.

A greedy search: of three effects none of which explains much without the others it may find another three.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from validation.calibration.calibrate import no_progress
from validation.case import Case
from validation.doubt import PRIOR
from validation.effects.during import During
from validation.inference.evidence import Evidence, scored
from validation.inference.posterior import Hypothesis, prior_shares, singles, weights
from validation.inference.refits import laplace

MOST = 3  # effects at once: who forgot more begins with another model


def further(
    case: Case, evidence: Evidence, hypotheses: Sequence[Hypothesis], progress: Callable[[str], None] = no_progress
) -> list[Hypothesis]:
    """The hypotheses, with larger ones where two effects explain most, or heat of unknown cause explains more."""
    out, weight = list(hypotheses), weights(hypotheses)
    fitted = [i for i, h in enumerate(out) if usable(evidence, h)]
    if not fitted:
        return out
    first = max(fitted, key=lambda i: weight[i])
    best = out[first]
    goes_on = len(best.members) > 1 or weight[first] < max((w for w, h in zip(weight, out) if h.heat), default=-np.inf)
    while goes_on and len(best.members) < MOST:
        new = with_one_more(case, evidence, best, progress)
        goes_on = new is not None and pays(out, best, new)
        if new is not None and goes_on:
            best = new
            out.append(new)
    return out


def usable(evidence: Evidence, h: Hypothesis) -> bool:
    """Has it a refit with amplitudes that another may join?"""
    return bool(h.fit and h.members) and not any(evidence.effects[k].whole for k in h.members)


def pays(hypotheses: Sequence[Hypothesis], before: Hypothesis, new: Hypothesis) -> bool:
    """Is an explanation more probable than the one that it adds an effect to?"""
    *_, old, added = weights([*hypotheses, before, new])
    return bool(added > old)


def with_one_more(
    case: Case, evidence: Evidence, best: Hypothesis, progress: Callable[[str], None]
) -> Hypothesis | None:
    """The best explanation that adds one lasting effect; None if there is none to add."""
    assert best.fit is not None
    others = [k for k, e in enumerate(evidence.effects) if k not in best.members and not isinstance(e, During)]
    others = [k for k in others if not evidence.effects[k].whole]
    if not others:
        return None
    now = scored(case, [evidence.effects[k] for k in others], best.fit)
    ones = singles(now)
    lead = ones[1 + int(np.argmax(weights(ones)[1:]))]
    progress(f"refitting {best.name(evidence)} + {lead.name(now)}")
    found, k = laplace(now, lead), others[lead.members[0]]
    again = PRIOR["two"].share / (PRIOR["effect"].share + PRIOR["fault"].share)  # as rare as a second beside a first
    prior = best.log_prior + float(np.log(again * prior_shares(evidence)[k]))
    return Hypothesis((*best.members, k), "", prior, best.log_bayes + found.log_bayes, best.loud, found.fit)
