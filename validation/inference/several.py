"""More than two at once: from the best explanation so far the tangents of all others are made anew, and the next is
fitted beside it, as long as that pays.

A greedy search: of three effects none of which explains much without the others it may find another three.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from measured.case import Case
from measured.doubt import PRIOR
from validation.calibration.calibrate import no_progress
from validation.effects.during import During
from validation.inference.evidence import Evidence, scored
from validation.inference.posterior import Hypothesis, prior_shares, singles, weights
from validation.inference.refits import NEAR, laplace
from validation.threads import side_by_side

MOST = 3  # effects at once: who forgot more begins with another model
RIVALS = 4  # effects that are tried beside the same others
AGAIN = float(np.log(PRIOR["two"].share / (PRIOR["effect"].share + PRIOR["fault"].share)))  # as a second beside a first


def further(
    case: Case, evidence: Evidence, hypotheses: Sequence[Hypothesis], progress: Callable[[str], None] = no_progress
) -> list[Hypothesis]:
    """The hypotheses, with larger ones where two effects explain most, or heat of unknown cause explains more."""
    out, weight = list(hypotheses), weights(hypotheses)
    refits = [i for i, h in enumerate(out) if usable(evidence, h)]
    if not refits:
        return out
    first = max(refits, key=lambda i: weight[i])
    best = out[first]
    goes_on = len(best.members) > 1 or weight[first] < max((w for w, h in zip(weight, out) if h.heat), default=-np.inf)
    while goes_on and len(best.members) < MOST:
        new = with_one_more(case, evidence, best, progress)
        goes_on = bool(new) and pays(out, best, new[0])
        if goes_on:
            best = new[0]
            out += new
    return out


def usable(evidence: Evidence, h: Hypothesis) -> bool:
    """Has it a refit with amplitudes that another may join?"""
    return bool(h.fit and h.members) and not any(evidence.effects[k].whole for k in h.members)


def pays(hypotheses: Sequence[Hypothesis], before: Hypothesis, new: Hypothesis) -> bool:
    """Is an explanation more probable than the one that it adds an effect to?"""
    *_, old, weight = weights([*hypotheses, before, new])
    return bool(weight > old)


def with_one_more(
    case: Case, evidence: Evidence, best: Hypothesis, progress: Callable[[str], None]
) -> list[Hypothesis]:
    """The best explanation that adds one lasting effect, the most probable first, then those that add a rival of it;
    none if there is nothing to add."""
    assert best.fit is not None
    others = [k for k, e in enumerate(evidence.effects) if k not in best.members and not isinstance(e, During)]
    others = [k for k in others if not evidence.effects[k].whole]
    if not others:
        return []
    now = scored(case, [evidence.effects[k] for k in others], best.fit)
    rivals, out = most_probable(singles(now)), []
    for one in rivals:
        progress(f"refitting {best.name(evidence)} + {one.name(now)}")
    for refitted in side_by_side(lambda one: laplace(now, one), rivals):
        k = others[refitted.members[0]]
        prior = best.log_prior + AGAIN + float(np.log(prior_shares(evidence)[k]))
        out.append(
            Hypothesis((*best.members, k), "", prior, best.log_bayes + refitted.log_bayes, best.loud, refitted.fit)
        )
    return [out[i] for i in np.argsort(-weights(out))]


def most_probable(hypotheses: Sequence[Hypothesis]) -> list[Hypothesis]:
    """The single effect with most weight, and those that come near it: tangents do not tell them apart."""
    first, *others = [hypotheses[i] for i in np.argsort(-weights(hypotheses)) if hypotheses[i].members]
    return [first, *(h for h in others if h.log_bayes > NEAR * first.log_bayes > 0.0)][:RIVALS]
