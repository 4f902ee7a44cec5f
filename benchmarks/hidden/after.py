"""What comes after a diagnosis: what the addition is worth on held-out tests, and whether the proposed test decides."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from hidden.answer import answer
from hidden.cases import Label, hidden_in
from hidden.kinds import KINDS
from hidden.odds import unordered
from hidden.truth.archetype import measured
from hidden.truth.candidate_tests import CANDIDATE_TESTS, carried_out
from hidden.user import test_of
from measured.case import Case
from validation import Revision, add, calibrate
from validation.inference.evidence import candidates
from validation.planning.rivals import DECISIVE

Answer = dict[str, Any]


def worth(case: Case, label: Label, found: Answer) -> dict[str, float] | None:
    """Held-out error (K) calibrated as it is, with what was claimed first, and with the truth; one effect only.

    Nothing claimed leaves the error as it is.
    """
    if label.group != "one":
        return None
    base = calibrate(case, roles=("calibrate", "validate"))
    ready, before = replace(case, model=base.model), held_out(base)
    names = set(unordered(label.right[0]))
    true = next((n for n in possible(case) if unordered(n) in names), None)
    best = held_out(add(ready, true)) if true else before
    claims = found["verdict"] in ("named", "group", "several") and found["groups"]
    if not claims:
        return {"before": before, "claimed": before, "best": best}
    first = found["groups"][0][0]
    claimed = best if first == true else held_out(add(ready, first))
    return {"before": before, "claimed": claimed, "best": best}


def possible(case: Case) -> list[str]:
    """Every effect of the catalogue that can sit somewhere in a case."""
    return [one.name for one in candidates(case)]


def held_out(done: Revision) -> float:
    """Error (K) after a revision on the held-out test."""
    return next(t.after for t in done.tests if t.role == "hold-out")


def followed(case: Case, label: Label, found: Answer) -> Answer | None:
    """The best test that is said to decide, carried out on the true machine, and what the diagnosis says then."""
    kind = KINDS[label.machine]
    said = [(name, factor) for name, gain, _, factor in found["next"] if gain >= DECISIVE and name in CANDIDATE_TESTS]
    if found["verdict"] != "group" or not said:
        return None
    name, factor = said[0]
    plan = carried_out(name, kind.plans[3], factor)
    (record,) = measured(kind, label.seed, hidden_in(kind, label), (plan,))
    longer = replace(case, tests=(test_of(kind, case.model.network, record), *case.tests))
    return {"test": name, **answer(longer, plan=False)}
