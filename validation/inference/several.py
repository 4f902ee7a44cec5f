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
from validation.inference.posterior import Hypothesis, prior_shares, singles
from validation.inference.refits import laplace

MOST = 3  # effects at once: who forgot more begins with another model


def further(
    case: Case, evidence: Evidence, hypotheses: Sequence[Hypothesis], progress: Callable[[str], None] = no_progress
) -> list[Hypothesis]:
    """The hypotheses, with larger ones where two effects explain most, or heat of unknown cause explains more."""
    out, heat = list(hypotheses), max((h.weight for h in hypotheses if h.heat), default=-np.inf)
    fitted = [h for h in out if h.fit and h.members and not any(evidence.effects[k].whole for k in h.members)]
    best = max(fitted, key=lambda h: h.weight, default=None)
    while best is not None and (best.weight < heat or len(best.members) > 1) and len(best.members) < MOST:
        best = with_one_more(case, evidence, best, progress)
        out += [best] if best else []
    return out


def with_one_more(
    case: Case, evidence: Evidence, best: Hypothesis, progress: Callable[[str], None]
) -> Hypothesis | None:
    """The best explanation that adds one lasting effect; None if none pays for itself."""
    assert best.fit is not None
    others = [k for k, e in enumerate(evidence.effects) if k not in best.members and not isinstance(e, During)]
    others = [k for k in others if not evidence.effects[k].whole]
    if not others:
        return None
    now = scored(case, [evidence.effects[k] for k in others], best.fit)
    lead = max(singles(now)[1:], key=lambda h: h.weight)
    progress(f"refitting {best.name(evidence)} + {lead.name(now)}")
    found, k = laplace(now, lead), others[lead.members[0]]
    again = PRIOR["two"].share / (PRIOR["effect"].share + PRIOR["fault"].share)  # as rare as a second beside a first
    prior = best.log_prior + float(np.log(again * prior_shares(evidence)[k]))
    new = Hypothesis((*best.members, k), "", prior, best.log_bayes + found.log_bayes, best.loud, found.fit)
    return new if new.weight > best.weight else None
