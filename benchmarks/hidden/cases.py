"""The list of cases: which machine, which class, what is hidden in it and how large. Truth stays in the label."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from itertools import permutations

import numpy as np

from hidden.kinds import KINDS
from hidden.sizes import MULTIPLES, detectable
from hidden.truth.archetype import Archetype, Hidden, Record, measured
from hidden.truth.change import NOTHING, Change

DECISIVE, ALIKE = 20.0, 5.0
SHARES = {"nothing": 300, "one": 300, "two": 100, "pair": 100, "foreign": 60, "absorbed": 40, "fault": 60, "tense": 60}
FIRST_SEED = {"dev": 0, "test": 500000}


@dataclass(frozen=True)
class Label:
    """What is true of a case; written to its own file, never shown to the diagnosis.

    truth : names of what is hidden;  size : in smallest detectable ones;  amplitude : in the names' units, as it shows
    rivals : what could be taken for it;  place : node where a foreign effect acts
    """

    case: str
    machine: str
    group: str
    seed: int
    truth: tuple[str, ...] = ()
    size: float = 0.0
    amplitude: tuple[float, ...] = ()
    rivals: tuple[str, ...] = ()
    place: str = ""

    def document(self) -> dict:
        return asdict(self)


def plan(seeds: str, count: int, classes: Sequence[str], machines: Sequence[str]) -> list[Label]:
    """`count` cases, classes in the proportions of the full set and evenly mixed, machines in turn."""
    share = np.array([SHARES[c] for c in classes], float)
    done, out = np.zeros(len(classes)), []
    for i in range(count):
        k = int(np.argmax((i + 1) * share / share.sum() - done))
        label = _label(KINDS[machines[i % len(machines)]], classes[k], FIRST_SEED[seeds] + i, int(done[k]))
        done[k] += 1
        out.append(label)
    return out


def _label(kind: Archetype, group: str, seed: int, turn: int) -> Label:
    bare = Label(f"{kind.name}-{group}-{seed}", kind.name, group, seed)
    return DRAWN[group](kind, bare, turn, np.random.default_rng([seed, 7]))


def _possible(kind: Archetype, size: float) -> list[Hidden]:
    """What can be hidden at `size` smallest detectable ones: as large as nature and the machine allow."""
    table = detectable()[kind.name]
    most = {h.name: min(h.largest * table[h.name]["shown"], table[h.name]["high"])
            for h in kind.missing if h.name in table}  # fmt: skip
    return [h for h in kind.missing if h.name in most and size * table[h.name]["size"] <= most[h.name]]


def _one(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    """One effect at 1, 2 or 4 times the smallest detectable size, whichever its nature allows."""
    table, size = detectable()[kind.name], MULTIPLES[(turn + turn // len(MULTIPLES)) % len(MULTIPLES)]
    fit = _possible(kind, size)
    chosen = fit[int(rng.integers(len(fit)))]
    return replace(bare, truth=(chosen.name,), size=size, amplitude=(size * table[chosen.name]["size"],),
                   rivals=rivals(kind, chosen.name, size))  # fmt: skip


def rivals(kind: Archetype, name: str, size: float) -> tuple[str, ...]:
    """What would explain an effect of this size almost as well, on a machine with nothing else missing."""
    return tuple(n for n, gap in detectable()[kind.name][name]["gaps"][f"{size:g}"].items() if gap < DECISIVE)


def _two(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    """Two effects at 4 times the smallest detectable size, neither a rival of the other."""
    table = detectable()[kind.name]
    fit = _possible(kind, 4.0)
    a = fit[int(rng.integers(len(fit)))]
    others = [h for h in fit if h is not a and h.name not in rivals(kind, a.name, 4.0)
              and a.name not in rivals(kind, h.name, 4.0)]  # fmt: skip
    b = others[int(rng.integers(len(others)))]
    sizes = tuple(4.0 * table[h.name]["size"] for h in (a, b))
    return replace(bare, truth=(a.name, b.name), size=4.0, amplitude=sizes)


def _fault(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    return replace(bare, truth=(list(kind.faults)[turn % len(kind.faults)],))


def _foreign(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    name = list(kind.foreign)[turn % len(kind.foreign)]
    return replace(bare, truth=(name,), place=name.split(" at ")[1])


def _absorbed(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    return replace(bare, truth=(list(kind.absorbed)[turn % len(kind.absorbed)],))


def _pair(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    """One of two effects that the tests cannot tell apart, at the largest size at which that is so."""
    usable = [(true, other, size) for twins in kind.twins for true, other in permutations(twins)
              if (size := _confounded(kind, true, other)) > 0.0]  # fmt: skip
    true, other, size = usable[turn % len(usable)]
    amplitude = size * detectable()[kind.name][true]["size"]
    return replace(bare, truth=(true,), rivals=(other,), size=size, amplitude=(amplitude,))


def _confounded(kind: Archetype, true: str, other: str) -> float:
    """The largest multiple of the detectable size at which the other explains the true one as well, in what it does to
    the machine and in what is logged; 0 if none."""
    row = detectable()[kind.name].get(true, {})
    sizes = [s for s in MULTIPLES if true in {h.name for h in _possible(kind, s)}]
    gaps = {s: max(row[how][f"{s:g}"].get(other, np.inf) for how in ("gaps", "logged")) for s in sizes}
    return max((s for s, gap in gaps.items() if gap < ALIKE), default=0.0)


def _bare(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    return bare


DRAWN = {"nothing": _bare, "one": _one, "two": _two, "pair": _pair, "foreign": _foreign, "absorbed": _absorbed,
         "fault": _fault, "tense": _bare}  # fmt: skip


def hidden_in(kind: Archetype, label: Label) -> Change:
    """The change of the true machine that a label speaks of."""
    if label.group in ("one", "two", "pair"):
        table, shown = {h.name: h for h in kind.missing}, detectable()[kind.name]
        changes = [table[n].make(a / shown[n]["shown"]) for n, a in zip(label.truth, label.amplitude, strict=True)]
        return sum(changes[1:], changes[0])
    if label.group == "tense":
        return _wrong_priors(kind, label.seed)
    source = {"fault": kind.faults, "foreign": kind.foreign, "absorbed": kind.absorbed}.get(label.group)
    return source[label.truth[0]](label.seed) if source else NOTHING


def _wrong_priors(kind: Archetype, seed: int) -> Change:
    """Three drawn parameters two deviations from what the user believes."""
    rng = np.random.default_rng([seed, 8])
    keys = rng.choice(list(kind.tense), 3, replace=False)
    return Change({str(k): float(np.exp(2.0 * kind.tense[str(k)] * rng.choice([-1, 1]))) for k in keys})


def records_of(label: Label) -> tuple[Record, ...]:
    kind = KINDS[label.machine]
    return measured(kind, label.seed, hidden_in(kind, label))
