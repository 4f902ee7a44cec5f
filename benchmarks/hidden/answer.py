"""One case, diagnosed. What comes back is what a user would see, and the time it took; the label is not looked at."""

import time
from typing import Any

from measured.case import Case
from validation import diagnose


def answer(case: Case, plan: bool = True) -> dict:
    """The line of a case for the file of answers."""
    start = time.process_time()
    found = diagnose(case, plan=plan)
    return {"case": case.name, **summary(found.document()), "cpu_s": time.process_time() - start}


def summary(found: dict[str, Any]) -> dict:
    """What is kept of a document of a diagnosis."""
    rows = {c["effect"]: _row(c) for c in found["candidates"]}
    return {
        "lead": lead(found),
        "verdict": found["verdict"],
        "words": found["words"],
        "groups": found["groups"],
        "odds": found.get("odds", []),
        "p_nothing": found.get("p_nothing"),
        "rmse_K": found["rmse_K"],
        "floor_K": found.get("floor_K", 0.0),
        "threshold": found.get("threshold", 0.0),
        "candidates": rows,
        "where": [[w["place"], w["evidence_nats"]] for w in found["where"][:5]],
        "next": [[t["test"], t["predicted_gain"], t["hours"], t["current_factor"]] for t in found["next_tests"][:5]],
        "pulls": [list(p.values()) if isinstance(p, dict) else list(p) for p in found["pulls"]],
        "cannot_see": [h["effect"] for h in found["cannot_see"]],
    }


def lead(found: dict[str, Any]) -> str:
    """What it would name if it had to name something."""
    said = [o["effects"][0] for o in found.get("odds", []) if o["effects"]]
    if said or found["groups"]:
        return str(said[0] if said else found["groups"][0][0])
    return str(max(found["candidates"], key=lambda c: c["score"])["effect"]) if found["candidates"] else ""


def _row(c: dict[str, Any]) -> dict:
    return {
        "score": c["score"],
        "value": c["amplitude"]["value"],
        "ci95": c["amplitude"]["ci95"],
        "decision": c["decision"],
    }
