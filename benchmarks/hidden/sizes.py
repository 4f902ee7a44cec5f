"""The unit of size of everything that can be hidden, and what it could be taken for.

From an observer who knows the machine (truth/oracle.py), so that neither depends on what is judged. Made once on
machines of their own by `hidden_effects.py --sizes` and kept in sizes.json: a case stays the same case.
"""

import json
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hidden.kinds import KINDS
from hidden.truth.archetype import Archetype, Hidden
from hidden.truth.change import Change, for_a_while
from hidden.truth.oracle import DEVIATION, Seen, seen, unlike
from hidden.truth.textbook import bridges, hypotheses

Array = NDArray[np.float64]
FILE = Path(__file__).parent / "sizes.json"
SEEDS = (900001, 900002, 900003)  # of the machines that all is measured on
MULTIPLES = (1.0, 2.0, 4.0)
ROLES = ("calibrate", "validate")
NEAR = 0.25  # of the squared deviation left: nothing further off can be a twin even at the unit of size
PART = (0.35, 0.65)  # of a test: how long a condition lasts that does not last all of it


@cache
def sizes() -> dict[str, dict[str, dict]]:
    return json.loads(FILE.read_text()) if FILE.exists() else {}


def part_of(hidden: Hidden, test: str, seconds: float) -> Change:
    """An effect at one unit that lasts part of a test."""
    return for_a_while(test, hidden.make(1.0), PART[0] * seconds, PART[1] * seconds)


def measure(kind: Archetype) -> dict[str, dict]:
    """Medians of several machines. Per effect, and per effect in one test or part of one ("NAME in TEST", "NAME in part
    of TEST"): size, the amplitude of deviation ten; shown, the catalogue's amplitude over the true law's; unlike, the
    share of the squared deviation that other explanations leave."""
    tests = {p.name: 60.0 * p.minutes for p in kind.plans if p.role in ROLES}
    inside = {
        (f"{h.name} in part of {t}",): part_of(h, t, s)
        for h in kind.passing
        for t, s in tests.items()
        if h.make(1.0).lasts
    }
    changes = {(f"true {h.name}",): h.make(1.0) for h in (*kind.missing, *kind.passing)}
    changes |= hypotheses(kind) | bridges(kind) | inside
    found = [_table(kind, seen(kind, seed, changes, ROLES), tests) for seed in SEEDS]
    medians = {name: _median([f[name] for f in found]) for name in found[0]}
    return {name: row for name, row in medians.items() if np.isfinite(row["size"])}


def _table(kind: Archetype, answers: Seen, tests: Sequence[str]) -> dict[str, dict]:
    V, index = answers.left(), {n: i for i, names in enumerate(answers.names) for n in names}
    out = {h.name: _row(kind, answers, V, h, index) for h in kind.missing}
    for test in tests:
        own = answers.left(test)
        out |= {f"{h.name} in {test}": _row(kind, answers, own, h, index) for h in kind.passing}
        out |= {
            name: {"size": max(_unit(V, index[name]), h.least), "shown": 1.0, "unlike": {}}
            for h in kind.passing
            if (name := f"{h.name} in part of {test}") in index
        }
    return out


def _unit(V: Array, i: int) -> float:
    return DEVIATION / float(np.sqrt(V[i, i])) if V[i, i] > 0.0 else float("inf")


def _row(kind: Archetype, answers: Seen, V: Array, hidden: Hidden, index: dict[str, int]) -> dict:
    """Of what is hidden against everything that a textbook would suspect."""
    i = index[f"true {hidden.name}"]
    names = kind.right(hidden.name)
    same = next((index[n] for n in names if n in index), None)
    shown = max(float(V[i, same] / V[same, same]), 0.05) if same is not None and V[same, same] > 0.0 else 1.0
    others = {
        n: unlike(V, i, j) for n, j in index.items() if n not in names and not n.startswith("true ") and " in " not in n
    }
    size = max(shown * _unit(V, i), hidden.least)
    return {"size": size, "shown": shown, "unlike": {n: u for n, u in others.items() if u < NEAR}}


def _median(rows: Sequence[dict]) -> dict:
    """Name by name; an explanation that some machines do not have counts as unlike there."""
    names = dict.fromkeys(n for r in rows for n in r["unlike"])
    near = {n: round(float(np.median([r["unlike"].get(n, 1.0) for r in rows])), 4) for n in names}
    size, shown = (float(np.median([r[k] for r in rows])) for k in ("size", "shown"))
    return {"size": round(size, 5), "shown": round(shown, 4), "unlike": {n: u for n, u in near.items() if u < NEAR}}


def write(kinds: Sequence[str]) -> None:
    """Measure some kinds anew and leave the others as they are."""
    for name in kinds:
        table = {**(json.loads(FILE.read_text()) if FILE.exists() else {}), name: measure(KINDS[name])}
        FILE.write_text(as_text(table))


def as_text(table: Mapping[str, Mapping[str, dict]]) -> str:
    """JSON with a line for each thing that can be hidden."""
    kinds = []
    for kind, rows in sorted(table.items()):
        lines = (f"  {json.dumps(name)}: {json.dumps(row, sort_keys=True)}" for name, row in sorted(rows.items()))
        kinds.append(f" {json.dumps(kind)}: {{\n" + ",\n".join(lines) + "\n }")
    return "{\n" + ",\n".join(kinds) + "\n}\n"
