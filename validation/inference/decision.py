"""From probabilities to one of seven verdicts by three costs: of a wrong name, of a miss, of an abstention."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from measured.doubt import COSTS
from validation.inference.evidence import Evidence
from validation.inference.posterior import Hypothesis, inclusion, probabilities
from validation.inference.result import Verdict

Array = NDArray[np.float64]
SURE = 1.0 - COSTS["abstain"].share / COSTS["wrong"].share  # probability from which a name costs less than a group
SILENT = COSTS["miss"].share / (COSTS["wrong"].share + COSTS["miss"].share)  # P(nothing) from which silence costs less


@dataclass(frozen=True)
class Decision:
    """groups : per thing that is missing the effects that may be it, most probable first;  sure : P(something)

    others : what halves of the instants would decide, where that is something else
    """

    verdict: Verdict
    groups: tuple[tuple[int, ...], ...]
    sure: float
    others: tuple[Decision, ...] = ()


def decide(evidence: Evidence, hypotheses: Sequence[Hypothesis]) -> Decision:
    """The statement of least expected cost."""
    P = probabilities(hypotheses)
    nothing = float(sum(p for p, h in zip(P, hypotheses, strict=True) if not h.members and not h.heat))
    heat = float(sum(p for p, h in zip(P, hypotheses, strict=True) if h.heat))
    if nothing > SILENT:
        return Decision("adequate", (), 1.0 - nothing)
    if heat > 0.5 * (1.0 - nothing):
        return Decision("outside", (), 1.0 - nothing)
    groups_in_turn = [cover(evidence, hypotheses, P)]
    while more := beside(evidence, hypotheses, P, groups_in_turn):
        groups_in_turn.append(more)
    groups = tuple(groups_in_turn)
    return Decision(_verdict(evidence, groups, P, hypotheses), groups, 1.0 - nothing)


def _verdict(
    evidence: Evidence, groups: tuple[tuple[int, ...], ...], P: Array, hypotheses: Sequence[Hypothesis]
) -> Verdict:
    if len(groups) > 1:
        return "several"
    if all(evidence.effects[k].fault for k in groups[0]):
        return "data"
    alone = len(groups[0]) == 1 and inclusion(hypotheses, len(evidence.effects))[groups[0][0]] >= SURE
    return "named" if alone else "group"


def cover(
    evidence: Evidence, hypotheses: Sequence[Hypothesis], P: Array, without: frozenset[int] = frozenset()
) -> tuple[int, ...]:
    """The fewest effects of which one is present with the probability SURE, given that any is; most probable first."""
    rows = [(frozenset(h.members) - without, float(p)) for h, p in zip(hypotheses, P, strict=True)]
    rows = [(m, p) for m, p in rows if m]
    goal, out = SURE * sum(p for _, p in rows), []
    while rows and goal > 0.0:
        weight = np.zeros(len(evidence.effects))
        for members, p in rows:
            weight[list(members)] += p
        best = int(np.argmax(weight))
        out.append(best)
        goal -= weight[best]
        rows = [(m, p) for m, p in rows if best not in m]
        if goal <= 1e-12:
            break
    return tuple(out)


def beside(
    evidence: Evidence, hypotheses: Sequence[Hypothesis], P: Array, groups: Sequence[tuple[int, ...]]
) -> tuple[int, ...]:
    """What is missing beside the leads of the groups so far, if to keep silent about it costs more than to say it."""
    lead, last = frozenset(g[0] for g in groups), groups[-1]
    others = lead - set(last)
    compatible = [
        (h, p) for h, p in zip(hypotheses, P, strict=True) if others <= set(h.members) and set(h.members) & set(last)
    ]
    both = [(h, p) for h, p in compatible if len(h.members) > len(groups)]
    if sum(p for _, p in both) < (1.0 - SILENT) * sum(p for _, p in compatible):
        return ()
    rest = [(h, p) for h, p in both if lead <= set(h.members)]
    return cover(evidence, [h for h, _ in rest], np.array([p for _, p in rest]), lead)
