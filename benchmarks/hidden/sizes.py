"""The smallest detectable size of every effect that can be hidden, and what it could be taken for.

Made once on development seeds by `hidden_effects.py --sizes` and kept in detectable.json, so that a case stays the same
case while the diagnosis improves.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from scipy.optimize import minimize_scalar
from validation.detectable import Search, readings_with, smallest
from validation.evidence import calibrated_case, candidates, null_of, scored
from validation.side_by_side import side_by_side

from hidden.kinds import KINDS
from hidden.rivals import Reference, differences, gaps, reference
from hidden.truth.archetype import Hidden, measured
from hidden.truth.change import NOTHING, Change
from hidden.user import case_of
from validation.case import Test
from validation.score import POWER

FILE = Path(__file__).parent / "detectable.json"
SEEDS = (900001, 900002, 900003)  # of the machines with nothing missing that all is measured on
MULTIPLES = (1.0, 2.0, 4.0)


def detectable() -> dict[str, dict[str, dict]]:
    return json.loads(FILE.read_text()) if FILE.exists() else {}


def measure(kind: str, draws: int) -> dict[str, dict]:
    """Per effect, medians of three machines: smallest detectable amplitude; the physical bound; how much of the true
    machine's amplitude its thermometers show in the catalogue's terms; and for each multiple of the size the deviance
    by which other candidates would explain what it does to the true machine worse (see rivals.gaps): on top of what the
    calibrated model foretells, and for one of a pair also in the readings as they are logged."""
    searches = [_search(kind, seed, draws) for seed in SEEDS]
    wanted = [h for h in KINDS[kind].missing if all(h.name in s.evidence.names for s in searches)]
    on = [reference(kind, seed, s.evidence) for seed, s in zip(SEEDS, searches, strict=True)]
    rows = side_by_side(_row, (on, searches, wanted), len(wanted), 2, lambda words: None, "effects")
    return {h.name: row for h, row in zip(wanted, rows, strict=True) if row}


def _search(kind: str, seed: int, draws: int) -> Search:
    case = case_of("reference", kind, measured(KINDS[kind], seed, NOTHING))
    evidence = scored(case, candidates(case), calibrated_case(case))
    null = null_of(evidence, draws)
    return Search(evidence, null.kappa, null.threshold() + POWER, small=0.0)


def _row(given: tuple[list[Reference], list[Search], list[Hidden]], i: int) -> dict:
    on, searches, wanted = given
    hidden, at = wanted[i], [s.evidence.names.index(wanted[i].name) for s in searches]
    own = searches[0].evidence.parameters[at[0]]
    size = float(np.median([smallest(s, k) for s, k in zip(searches, at, strict=True)]))
    if not np.isfinite(size):
        return {}
    shown = float(np.median([_shown(r, k, hidden, 2.0 * size) for r, k in zip(on, at, strict=True)]))

    def behind(read: Callable[[Reference, Change], Sequence[Test]]) -> dict[str, dict[str, float]]:
        return {f"{m:g}": medians([gaps(s.evidence, k, m * size, read(r, hidden.make(m * size / shown)),
                                        float(s.kappa[k]))
                                   for r, s, k in zip(on, searches, at, strict=True)])
                for m in MULTIPLES if m * size <= own.high}  # fmt: skip

    row = {"size": size, "unit": own.unit, "high": own.high, "shown": shown, "gaps": behind(Reference.foretold)}
    paired = any(hidden.name in pair for pair in KINDS[on[0].kind].twins)
    return row | {"logged": behind(Reference.recorded)} if paired else row


def medians(tables: Sequence[dict[str, float]]) -> dict[str, float]:
    """Name by name the median of several tables, infinite where a table lacks the name; the infinite are left out."""
    names = dict.fromkeys(name for table in tables for name in table)
    found = {name: float(np.median([table.get(name, np.inf) for table in tables])) for name in names}
    return {name: gap for name, gap in found.items() if np.isfinite(gap)}


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
