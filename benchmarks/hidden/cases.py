"""The list of cases: which machine, which class, what is hidden in it and how large. Truth stays in the label."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

from hidden.kinds import KINDS
from hidden.sizes import detectable
from hidden.truth.archetype import Archetype, Hidden, Record, measured
from hidden.truth.change import NOTHING, Change

SIZES = (1.0, 2.0, 4.0)
SHARES = {"nothing": 300, "one": 300, "two": 100, "pair": 100, "foreign": 60, "absorbed": 40, "fault": 60, "tense": 60}
FIRST_SEED = {"dev": 0, "test": 500000}


@dataclass(frozen=True)
class Label:
    """What is true of a case; written to its own file, never shown to the diagnosis.

    truth : names of what is hidden;  size : in smallest detectable ones;  amplitude : in the names' units
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
    return [h for h in kind.missing if h.name in table
            and size * table[h.name]["size"] <= min(h.largest, table[h.name]["high"])]  # fmt: skip


def _one(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    """One effect at 1, 2 or 4 times the smallest detectable size, whichever its nature allows."""
    table, size = detectable()[kind.name], SIZES[(turn + turn // len(SIZES)) % len(SIZES)]
    fit = _possible(kind, size)
    chosen = fit[int(rng.integers(len(fit)))]
    found = table[chosen.name]
    return replace(bare, truth=(chosen.name,), size=size, amplitude=(size * found["size"],),
                   rivals=tuple(n for n, c in found["alike"].items() if _near(size * found["z"], c)))  # fmt: skip


def _near(z: float, cosine: float) -> bool:
    """Expected deviance gap below 20: the rival would explain it almost as well. z : deviations of the true effect."""
    return z**2 * (1.0 - cosine**2) < 20.0 and cosine > 0.5


def _two(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    """Two effects at 4 times the smallest detectable size, neither a rival of the other."""
    table = detectable()[kind.name]
    fit = _possible(kind, 4.0)
    a = fit[int(rng.integers(len(fit)))]
    others = [h for h in fit if h is not a and table[a.name]["alike"].get(h.name, 0.0) < 0.7]
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
    """One of two effects that the tests cannot tell apart, at 4 times the smallest detectable size."""
    table, fit = detectable()[kind.name], {h.name for h in _possible(kind, 4.0)}
    usable = [t.names for t in kind.twins if fit & set(t.names)]
    names = usable[turn % len(usable)]
    here = [n for n in names if n in fit]
    true = here[int(rng.integers(len(here)))]
    (other,) = set(names) - {true}
    return replace(bare, truth=(true,), rivals=(other,), size=4.0, amplitude=(4.0 * table[true]["size"],))


def _bare(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    return bare


DRAWN = {"nothing": _bare, "one": _one, "two": _two, "pair": _pair, "foreign": _foreign, "absorbed": _absorbed,
         "fault": _fault, "tense": _bare}  # fmt: skip


def hidden_in(kind: Archetype, label: Label) -> Change:
    """The change of the true machine that a label speaks of."""
    if label.group in ("one", "two", "pair"):
        table = {h.name: h for h in kind.missing}
        changes = [table[n].make(a) for n, a in zip(label.truth, label.amplitude, strict=True)]
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
    shortened = [t.plans for t in kind.twins if label.group == "pair" and label.truth[0] in t.names and t.plans]
    return measured(kind, label.seed, hidden_in(kind, label), *shortened[:1])
