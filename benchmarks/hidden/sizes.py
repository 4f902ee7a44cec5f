"""The smallest detectable size of every effect that can be hidden, and its rivals, where nothing is missing.

Made once on development seeds by `hidden_effects.py --sizes` and kept in detectable.json, so that a case stays the same
case while the diagnosis improves.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy.optimize import minimize_scalar

from hidden.kinds import KINDS
from hidden.rivals import Reference, differences, gaps, reference
from hidden.truth.archetype import Hidden, measured
from hidden.truth.change import NOTHING
from hidden.user import case_of
from validation.detectable import Search, readings_with, smallest
from validation.evidence import calibrated_case, candidates, null_of, scored
from validation.score import POWER
from validation.side_by_side import side_by_side

FILE = Path(__file__).parent / "detectable.json"
REFERENCE_SEED = 900001
MORE_SEEDS = (900002, 900003)
MULTIPLES = (1.0, 2.0, 4.0)


def detectable() -> dict[str, dict[str, dict]]:
    return json.loads(FILE.read_text()) if FILE.exists() else {}


def measure(kind: str, draws: int) -> dict[str, dict]:
    """Per effect: smallest detectable amplitude, median of three machines; the physical bound; how much of the true
    machine's amplitude its thermometers show in the catalogue's terms; and for each multiple of the size the deviance
    by which other candidates would explain what it does to the true machine worse (see rivals.gaps)."""
    search, *more = (_search(kind, seed, draws) for seed in (REFERENCE_SEED, *MORE_SEEDS))
    wanted = [h for h in KINDS[kind].missing if h.name in search.evidence.names]
    given = (reference(kind, REFERENCE_SEED, search.evidence), search, more, wanted)
    rows = side_by_side(_row, given, len(wanted), 2, lambda words: None, "effects")
    return {h.name: row for h, row in zip(wanted, rows, strict=True) if row}


def _search(kind: str, seed: int, draws: int) -> Search:
    case = case_of("reference", kind, measured(KINDS[kind], seed, NOTHING))
    evidence = scored(case, candidates(case), calibrated_case(case))
    null = null_of(evidence, draws)
    return Search(evidence, null.kappa, null.threshold() + POWER, small=0.0)


def _row(given: tuple[Reference, Search, list[Search], list[Hidden]], i: int) -> dict:
    on, search, more, wanted = given
    e, hidden = search.evidence, wanted[i]
    k = e.names.index(hidden.name)
    high, sizes = e.parameters[k].high, [smallest(s, s.evidence.names.index(hidden.name)) for s in (search, *more)]
    size = float(np.median(sizes))
    if not np.isfinite(size):
        return {}
    shown = _shown(on, k, hidden, 2.0 * size)
    found = {f"{m:g}": gaps(on, k, m * size, on.moved(hidden.make(m * size / shown)), float(search.kappa[k]))
             for m in MULTIPLES if m * size <= high}  # fmt: skip
    return {"size": size, "unit": e.parameters[k].unit, "high": high, "gaps": found, "shown": shown}


def _shown(on: Reference, k: int, hidden: Hidden, amplitude: float) -> float:
    """The catalogue's amplitude over the true machine's: the one that moves the thermometers as much, least squares."""
    wanted = np.concatenate(on.moved(hidden.make(amplitude)))

    def miss(a: float) -> float:
        moved = np.concatenate(differences(readings_with(on.evidence, {k: a}), on.still))
        return float(np.nansum((wanted - moved) ** 2))

    most = min(4.0 * amplitude, on.evidence.parameters[k].high)
    return (
        float(minimize_scalar(miss, bounds=(0.0, most), method="bounded", options={"xatol": 1e-3 * most}).x) / amplitude
    )


def write(draws: int, machines: Sequence[str]) -> None:
    """Measure some machines anew and leave the others as they are."""
    for kind in machines:
        table = {**detectable(), kind: measure(kind, draws)}
        FILE.write_text(json.dumps(table, indent=1, sort_keys=True) + "\n")
