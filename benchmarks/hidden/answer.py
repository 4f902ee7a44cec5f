"""One case, diagnosed. What comes back is what a user would see, and the time it took; the label is not looked at."""

from __future__ import annotations

import time

from validation import Case, Diagnosis, diagnose
from validation.findings import Candidate


def answer(case: Case, draws: int, plan: bool = True) -> dict:
    """The line of a case for the file of answers."""
    start = time.process_time()
    found = diagnose(case, draws=draws, workers=1, plan=plan)
    return {"case": case.name, **summary(found), "cpu_s": time.process_time() - start}


def summary(found: Diagnosis) -> dict:
    rows = {c.effect: _row(c) for c in found.candidates}
    return {
        "lead": lead(found), "verdict": found.verdict, "words": found.words, "groups": [list(g) for g in found.groups],
        "rmse_K": found.rmse_K, "floor_K": found.floor_K, "threshold": found.threshold, "candidates": rows,
        "where": [[w.place, w.evidence_nats] for w in found.where[:5]],
        "next": [[t.test, t.predicted_gain, t.hours] for t in found.next_tests[:5]],
        "pulls": [list(p) for p in found.pulls], "cannot_see": [h.effect for h in found.cannot_see],
    }  # fmt: skip


def lead(found: Diagnosis) -> str:
    """What it would name if it had to name something."""
    return found.groups[0][0] if found.groups else max(found.candidates, key=lambda c: c.score).effect


def _row(c: Candidate) -> dict:
    return {"score": c.score, "value": c.value, "ci95": list(c.ci95), "decision": c.decision,
            "smallest_detectable": c.smallest_detectable, "holdout_rmse_K": c.holdout_rmse_K}  # fmt: skip
