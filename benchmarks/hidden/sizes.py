"""The smallest detectable size of every effect that can be hidden, and its look-alikes, where nothing is missing.

Made once on development seeds by `hidden_effects.py --sizes` and kept in detectable.json, so that a case stays the same
case while the diagnosis improves.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from hidden.kinds import KINDS
from hidden.truth.archetype import measured
from hidden.truth.change import NOTHING
from hidden.user import case_of
from validation.evidence import calibrated_case, candidates, null_of, scored
from validation.score import POWER

FILE = Path(__file__).parent / "detectable.json"
REFERENCE_SEEDS = (900001,)
LIKE = 0.5


def detectable() -> dict[str, dict[str, dict]]:
    return json.loads(FILE.read_text()) if FILE.exists() else {}


def measure(kind: str, draws: int) -> dict[str, dict]:
    """Per effect: smallest detectable amplitude (mean over the reference machines) and its score, the physical bound,
    candidates alike (cosine > 0.5)."""
    rows = [_one(kind, seed, draws) for seed in REFERENCE_SEEDS]
    out = {}
    for hidden in KINDS[kind].missing:
        found = [r[hidden.name] for r in rows if hidden.name in r]
        if found:
            alike = {n: max(f["alike"].get(n, 0.0) for f in found) for f in found for n in f["alike"]}
            size = float(np.mean([f["size"] for f in found]))
            out[hidden.name] = {"size": size, "unit": found[0]["unit"], "alike": alike, "z": found[0]["z"],
                                "high": found[0]["high"]}  # fmt: skip
    return out


def _one(kind: str, seed: int, draws: int) -> dict[str, dict]:
    case = case_of("reference", kind, measured(KINDS[kind], seed, NOTHING))
    evidence = scored(case, candidates(case), calibrated_case(case))
    null = null_of(evidence, draws, workers=1)
    limit = null.threshold()
    size = evidence.score.detectable(null.kappa, limit)
    names, cosine = evidence.names, np.abs(evidence.score.cosine)
    wanted = {h.name for h in KINDS[kind].missing} & set(names)
    out = {}
    for k, name in enumerate(names):
        if name in wanted:
            alike = {names[m]: round(float(cosine[k, m]), 3) for m in np.flatnonzero(cosine[k] > LIKE) if m != k}
            out[name] = {"size": float(size[k]), "unit": evidence.parameters[k].unit, "alike": alike,
                         "z": round(limit + POWER, 3), "high": evidence.parameters[k].high}  # fmt: skip
    return out


def write(draws: int, machines: Sequence[str]) -> None:
    """Measure some machines anew and leave the others as they are."""
    for kind in machines:
        table = {**detectable(), kind: measure(kind, draws)}
        FILE.write_text(json.dumps(table, indent=1, sort_keys=True) + "\n")
