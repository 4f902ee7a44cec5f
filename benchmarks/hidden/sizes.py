"""The smallest detectable size of every effect that can be hidden, and its rivals, where nothing is missing.

Made once on development seeds by `hidden_effects.py --sizes` and kept in detectable.json, so that a case stays the same
case while the diagnosis improves.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from hidden.kinds import KINDS
from hidden.truth.archetype import Hidden, measured
from hidden.truth.change import NOTHING
from hidden.user import case_of
from validation.case import Test
from validation.detectable import Search, mistaken, readings_with, smallest
from validation.evidence import Evidence, calibrated_case, candidates, null_of, scored
from validation.score import POWER
from validation.side_by_side import side_by_side

FILE = Path(__file__).parent / "detectable.json"
REFERENCE_SEED = 900001
MORE_SEEDS = (900002, 900003)
LIKE, MOST = 0.4, 12
MULTIPLES = (1.0, 2.0, 4.0)


def detectable() -> dict[str, dict[str, dict]]:
    return json.loads(FILE.read_text()) if FILE.exists() else {}


def measure(kind: str, draws: int) -> dict[str, dict]:
    """Per effect: smallest detectable amplitude, median of three machines; the physical bound; how much of the true
    machine's amplitude its thermometers show in the catalogue's terms; and for each multiple of the size the deviance
    by which other candidates would explain it worse, over kappa^2."""
    search, *more = (_search(kind, seed, draws) for seed in (REFERENCE_SEED, *MORE_SEEDS))
    wanted = [h for h in KINDS[kind].missing if h.name in search.evidence.names]
    given = (kind, search, more, wanted)
    rows = side_by_side(_row, given, len(wanted), 2, lambda words: None, "effects")
    return {h.name: row for h, row in zip(wanted, rows, strict=True) if row}


def _search(kind: str, seed: int, draws: int) -> Search:
    case = case_of("reference", kind, measured(KINDS[kind], seed, NOTHING))
    evidence = scored(case, candidates(case), calibrated_case(case))
    null = null_of(evidence, draws)
    return Search(evidence, null.kappa, null.threshold() + POWER, small=0.0)


def _row(given: tuple[str, Search, list[Search], list[Hidden]], i: int) -> dict:
    (kind, search, more, wanted), e = given, given[1].evidence
    k, high = e.names.index(wanted[i].name), e.parameters[e.names.index(wanted[i].name)].high
    sizes = [smallest(s, s.evidence.names.index(wanted[i].name)) for s in (search, *more)]
    size = float(np.median(sizes))
    if not np.isfinite(size):
        return {}
    gaps = {f"{m:g}": _gaps(e, k, m * size, float(search.kappa[k])) for m in MULTIPLES if m * size <= high}
    return {"size": size, "unit": e.parameters[k].unit, "high": high, "gaps": gaps,
            "shown": _shown(kind, e, k, wanted[i], 2.0 * size)}  # fmt: skip


def _shown(kind: str, evidence: Evidence, k: int, hidden: Hidden, amplitude: float) -> float:
    """The catalogue's amplitude over the true machine's: the one that moves the thermometers as much, least squares."""
    tests = {name: case_of("", kind, measured(KINDS[kind], REFERENCE_SEED, c)).tests
             for name, c in (("with", hidden.make(amplitude)), ("without", NOTHING))}  # fmt: skip
    names = [t.name for t in evidence.tests]
    wanted = _moved(*([t for t in tests[n] if t.name in names] for n in ("with", "without")))
    still = readings_with(evidence, {k: 0.0})

    def miss(a: float) -> float:
        return float(np.nansum((wanted - _moved(readings_with(evidence, {k: a}), still)) ** 2))

    most = min(4.0 * amplitude, evidence.parameters[k].high)
    return (
        float(minimize_scalar(miss, bounds=(0.0, most), method="bounded", options={"xatol": 1e-3 * most}).x) / amplitude
    )


def _moved(one: Sequence[Test], other: Sequence[Test]) -> NDArray[np.float64]:
    """Differences of all readings."""
    pairs = [(a.y - b.y) for s, t in zip(one, other, strict=True) for a, b in zip(s.channels, t.channels, strict=True)]
    return np.concatenate(pairs)


def _gaps(evidence: Evidence, k: int, amplitude: float, kappa: float) -> dict[str, float]:
    """Candidate -> deviance gap, for those whose traces are alike."""
    alike = np.abs(evidence.score.cosine[k])
    near = [int(m) for m in np.argsort(-alike) if m != k and alike[m] > LIKE][:MOST]
    return {evidence.names[m]: round(mistaken(evidence, k, amplitude, m) / kappa**2, 2) for m in near}


def write(draws: int, machines: Sequence[str]) -> None:
    """Measure some machines anew and leave the others as they are."""
    for kind in machines:
        table = {**detectable(), kind: measure(kind, draws)}
        FILE.write_text(json.dumps(table, indent=1, sort_keys=True) + "\n")
