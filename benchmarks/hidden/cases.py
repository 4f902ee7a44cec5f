"""The list of cases: which machine, which class, what is hidden in it and how large. Truth stays in the label."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

from hidden.kinds import KINDS
from hidden.sizes import MULTIPLES, PART, ROLES, sizes
from hidden.truth.archetype import Archetype, Edit, Hidden, Record, measured
from hidden.truth.change import NOTHING, Change, for_a_while, only_in
from hidden.truth.oracle import DEVIATION
from hidden.user import area_of

DECISIVE, ALIKE = 20.0, 5.0  # squared deviation by which an explanation must be worse; at which it is as good
SHARES = {
    "nothing": 300,
    "one": 300,
    "two": 100,
    "pair": 100,
    "condition": 100,
    "foreign": 60,
    "absorbed": 40,
    "fault": 60,
    "tense": 60,
}
FIRST_SEED = {"dev": 0, "test": 500000}


@dataclass(frozen=True)
class Label:
    """What is true of a case; written to its own file, never shown to the diagnosis.

    truth : what is hidden, in the generator's words;  right : for each, its names in the catalogue
    twins : for each, the names of what an observer who knows the machine could not tell from it at this size
    size : in units of size, 0 where it has none;  amplitude : in the catalogue's units, as it shows, but films in W/K
    area : of the place (m2) where the catalogue counts the first of these per area, 1 where it does not
    place : node where a foreign effect acts;  test, span : where a condition holds, from and to (s) of it
    step_s : of the record (s)
    """

    case: str
    machine: str
    group: str
    seed: int
    truth: tuple[str, ...] = ()
    right: tuple[tuple[str, ...], ...] = ()
    twins: tuple[tuple[str, ...], ...] = ()
    size: float = 0.0
    amplitude: tuple[float, ...] = ()
    area: float = 1.0
    place: str = ""
    test: str = ""
    span: tuple[float, ...] = ()
    step_s: float = 60.0

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
    bare = Label(f"{kind.name}-{group}-{seed}", kind.name, group, seed, step_s=kind.logger.step)
    return DRAWN[group](kind, bare, turn, np.random.default_rng([seed, 7]))


def twins(kind: Archetype, name: str, size: float, within: float = DECISIVE) -> tuple[str, ...]:
    """Explanations that come within some squared deviation of an effect of this size."""
    row, most = sizes()[kind.name][name], (size * DEVIATION) ** 2
    return tuple(n for n, share in row["unlike"].items() if share * most < within)


def _room(kind: Archetype, hidden: Hidden, key: str) -> float:
    """The largest size that nature allows."""
    row = sizes()[kind.name][key]
    return hidden.largest * row["shown"] / row["size"]


def _possible(kind: Archetype, size: float) -> list[Hidden]:
    """What can be hidden at this size; what the user forgot to declare is as large as it is, one unit at least."""
    return [h for h in kind.missing if _room(kind, h, h.name) >= (1.0 if h.declared else size)]


def _hide(kind: Archetype, bare: Label, chosen: Sequence[Hidden], size: float) -> Label:
    own = [_room(kind, h, h.name) if h.declared else size for h in chosen]
    table = sizes()[kind.name]
    return replace(
        bare,
        truth=tuple(h.name for h in chosen),
        right=tuple(kind.right(h.name) for h in chosen),
        twins=tuple(twins(kind, h.name, s) for h, s in zip(chosen, own, strict=True)),
        size=0.0 if any(h.declared for h in chosen) else size,
        amplitude=tuple(s * table[h.name]["size"] for h, s in zip(chosen, own, strict=True)),
        area=area_of(kind.name, kind.right(chosen[0].name)[0]),
    )


def _one(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    """One effect at 1, 2 or 4 units of size, whichever its nature allows."""
    size = MULTIPLES[(turn + turn // len(MULTIPLES)) % len(MULTIPLES)]
    fit = _possible(kind, size)
    return _hide(kind, bare, [fit[int(rng.integers(len(fit)))]], size)


def _two(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    """Two effects at 4 units, neither a twin of the other."""
    fit = _possible(kind, 4.0)
    a = fit[int(rng.integers(len(fit)))]
    near = {*twins(kind, a.name, 4.0), *kind.right(a.name)}
    others = [h for h in fit if not near & {*twins(kind, h.name, 4.0), *kind.right(h.name)}]
    return _hide(kind, bare, [a, others[int(rng.integers(len(others)))]], 4.0)


def _pair(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    """An effect with a twin that is as good at a size that would be plain otherwise."""
    usable = [
        (h, s) for s in MULTIPLES[1:] for h in _possible(kind, s) if not h.declared and twins(kind, h.name, s, ALIKE)
    ]
    usable = usable or [(h, 1.0) for h in _possible(kind, 1.0) if twins(kind, h.name, 1.0, ALIKE)]
    chosen, size = usable[int(rng.integers(len(usable)))]
    return _hide(kind, bare, [chosen], size)


def _condition(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    """Something that holds in one test, or for part of it, at 2 or 4 units."""
    size, tests = MULTIPLES[1 + turn % 2], [p for p in kind.plans if p.role in ROLES]
    keys = [(h, p, f"{h.name} in {part}{p.name}") for h in kind.passing for p in tests for part in ("", "part of ")]
    fit = [(h, p, key) for h, p, key in keys if key in sizes()[kind.name] and _room(kind, h, key) >= size]
    h, p, key = fit[int(rng.integers(len(fit)))]
    share = PART if "in part of" in key else (0.0, 1.0)
    whole = f"{h.name} in {p.name}"
    return replace(
        bare,
        truth=(h.name,),
        right=(kind.right(h.name),),
        twins=(twins(kind, whole, size),),
        size=size,
        test=p.name,
        amplitude=(size * sizes()[kind.name][key]["size"],),
        span=tuple(60.0 * p.minutes * s for s in share),
    )


def _fault(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    return _named(bare, list(kind.faults)[turn % len(kind.faults)])


def _foreign(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    name = list(kind.foreign)[turn % len(kind.foreign)]
    return replace(_named(bare, name), place=name.split(" at ")[1])


def _absorbed(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    return _named(bare, list(kind.absorbed)[turn % len(kind.absorbed)])


def _named(bare: Label, name: str) -> Label:
    return replace(bare, truth=(name,), right=((name,),), twins=((),))


def _bare(kind: Archetype, bare: Label, turn: int, rng: np.random.Generator) -> Label:
    return bare


DRAWN = {
    "nothing": _bare,
    "one": _one,
    "two": _two,
    "pair": _pair,
    "condition": _condition,
    "foreign": _foreign,
    "absorbed": _absorbed,
    "fault": _fault,
    "tense": _bare,
}


def hidden_in(kind: Archetype, label: Label) -> Change:
    """The change of the true machine that a label speaks of."""
    if label.group in ("one", "two", "pair"):
        table, shown = {h.name: h for h in kind.missing}, sizes()[kind.name]
        found = [(table[n], a / shown[n]["shown"]) for n, a in zip(label.truth, label.amplitude, strict=True)]
        return sum((NOTHING if h.declared else h.make(a) for h, a in found), NOTHING)
    if label.group == "condition":
        return _passing(kind, label)
    if label.group == "tense":
        # Three drawn parameters two deviations from what the user believes.
        rng, sd = np.random.default_rng([label.seed, 8]), kind.spreads() | kind.doubted
        keys = rng.choice(kind.tense, min(3, len(kind.tense)), replace=False)
        return Change({str(k): float(np.exp(2.0 * sd[str(k)] * rng.choice([-1, 1]))) for k in keys})
    source = {"fault": kind.faults, "foreign": kind.foreign, "absorbed": kind.absorbed}.get(label.group)
    return source[label.truth[0]](label.seed) if source else NOTHING


def _passing(kind: Archetype, label: Label) -> Change:
    (name,), (amplitude,) = label.truth, label.amplitude
    hidden = next(h for h in kind.passing if h.name == name)
    if label.span[0] > 0.0:
        return for_a_while(label.test, hidden.make(amplitude), *label.span)
    return only_in(label.test, hidden.make(amplitude / sizes()[kind.name][f"{name} in {label.test}"]["shown"]))


def edits_of(label: Label) -> tuple[Edit, ...]:
    """What the user's network says instead, where he forgot something."""
    table = {h.name: h for h in KINDS[label.machine].missing}
    return tuple(e for name in label.truth if name in table for e in table[name].declared)


def records_of(label: Label) -> tuple[Record, ...]:
    kind = KINDS[label.machine]
    return measured(kind, label.seed, hidden_in(kind, label))
