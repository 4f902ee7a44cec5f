"""One case, diagnosed. What comes back is what a user would see, and the time it took; the label is not looked at."""

from __future__ import annotations

import time

from validation import Case, Diagnosis, diagnose


def answer(case: Case, draws: int, plan: bool = True) -> tuple[dict, Diagnosis]:
    """The line of a case for the file of answers, and the diagnosis itself."""
    start = time.process_time()
    found = diagnose(case, draws=draws, workers=1, plan=plan)
    return {"case": case.name, **summary(found), "cpu_s": time.process_time() - start}, found


def summary(found: Diagnosis) -> dict:
    rows = {c.effect: _row(c) for c in found.candidates}
    return {
        "verdict": found.verdict, "words": found.words, "groups": [list(g) for g in found.groups],
        "rmse_K": found.rmse_K, "floor_K": found.floor_K, "threshold": found.threshold, "candidates": rows,
        "where": [[w.place, w.evidence_nats] for w in found.where[:5]],
        "next": [[t.test, t.predicted_gain, t.hours] for t in found.next_tests[:5]],
        "pulls": [list(p) for p in found.pulls], "cannot_see": [h.effect for h in found.cannot_see],
    }  # fmt: skip


def _row(c) -> dict:
    return {"score": c.score, "value": c.value, "ci95": list(c.ci95), "decision": c.decision,
            "smallest_detectable": c.smallest_detectable, "holdout_rmse_K": c.holdout_rmse_K}  # fmt: skip
