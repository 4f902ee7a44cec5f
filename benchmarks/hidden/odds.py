"""The odds of an answer held against its label: proper scores, which no threshold can flatter.

The rule of twins: a hypothesis is right when each of its effects is what is hidden or one of its
twins (`cases.twins`); a fault is right when its channel, input or test is; unknown heat for what no
catalogue has, and since the tool has conditions that held for a while also the one at that place.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations
from math import log
from typing import Any

import numpy as np

Answer = Mapping[str, Any]
FLOOR, CREDIBLE, SURE, CLAIMED = 1e-4, 0.9, 0.9, 0.9
NOTHING, UNKNOWN, HEAT = "nothing", ("heat@", "unknown heat", "outside"), "heat@"
WHILE = {"splash": "convection.constant", "heater": "loss.constant"}  # of the generator's foreign effects
QUIET = ("nothing", "tense", "absorbed")  # classes in which no effect is missing and no reading false
DATA = ("sensor.", "time.", "ambient.", "input.", "frozen", "clipped", "clock")
EDGES = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)


def unordered(x: Any) -> Any:
    """A document in which the places of an effect between two are in the order of the alphabet: they have none."""
    if isinstance(x, str):
        return " + ".join(_unordered(name) for name in x.split(" + ")) if "@" in x and "|" in x else x
    if isinstance(x, Mapping):
        return {unordered(key): unordered(value) for key, value in x.items()}
    return [unordered(one) for one in x] if isinstance(x, list | tuple) else x


def _unordered(name: str) -> str:
    kind, _, rest = name.partition("@")
    places, within, gate = rest.partition(" in ")
    return f"{kind}@{'|'.join(sorted(places.split('|')))}{within}{gate}"


@dataclass(frozen=True)
class Said:
    """A hypothesis and its probability. effects : kind@place;  tests, span : where it holds, if not everywhere"""

    hypothesis: str
    effects: tuple[str, ...]
    p: float
    tests: tuple[str, ...] = ()
    span: tuple[float, ...] = ()


def said(answer: Answer) -> list[Said]:
    """Most probable first; from an answer without odds, what its verdict amounts to."""
    rows = [_read(o) for o in answer.get("odds") or []] or _from_verdict(answer)
    return sorted(rows, key=lambda s: -s.p)


def _read(row: Answer) -> Said:
    name = str(row["hypothesis"])
    effects = tuple(e.split(" in ")[0] for e in row.get("effects") or () if e != NOTHING)
    effects = effects or ((name,) if name.startswith(HEAT) else ())
    tests = tuple(row.get("tests") or [e.split(" in ")[1] for e in row.get("effects") or () if " in " in e])
    span = tuple(row[k] for k in ("begin_s", "end_s") if row.get(k) is not None)
    return Said(name, effects, float(row["probability"]), tests, span)


def _from_verdict(answer: Answer) -> list[Said]:
    """0.9 for what is claimed, evenly over its group (pairs: one of each group); the rest evenly over nothing and all
    other candidates."""
    groups = [tuple(g) for g in answer["groups"]]
    claims = {"adequate": [()], "absorbed": [()], "outside": [("unknown heat",)]}.get(answer["verdict"])
    if claims is None and answer["verdict"] == "several" and len(groups) > 1:
        claims = [(a, b) for a in groups[0] for b in groups[1]]
    claims = claims or [(a,) for a in (groups[0] if groups else ["unknown heat"])]
    others = [e for e in [(), *((c,) for c in answer["candidates"])] if e not in claims]
    share, rest = CLAIMED / len(claims), (1.0 - CLAIMED) / max(len(others), 1)
    return [Said(" + ".join(e) or NOTHING, e, p) for es, p in ((claims, share), (others, rest)) for e in es]


def is_right(label: Answer, one: Said) -> bool:
    """Is this hypothesis what is hidden, by the rule of twins?"""
    if label["group"] in QUIET or one.hypothesis == NOTHING:
        return label["group"] in QUIET and one.hypothesis == NOTHING
    if label["group"] == "foreign":
        return one.hypothesis.startswith(UNKNOWN) or for_a_while(label, one)
    if label["group"] == "fault":
        return bool(one.effects) and all(fault_of(label["truth"][0], effect) for effect in one.effects)
    allowed = [{*own, *near} for own, near in zip(label["right"], label["twins"], strict=True)]
    return len(one.effects) == len(allowed) and any(
        all(e in names for e, names in zip(order, allowed, strict=True)) for order in permutations(one.effects)
    )


def for_a_while(label: Answer, one: Said) -> bool:
    """What no lasting effect is may be told as heat or cooling of the same place for a while."""
    kind = WHILE.get(label["truth"][0].split()[0])
    return bool(one.tests) and kind is not None and one.effects == (f"{kind}@{label['place']}",)


def fault_of(truth: str, effect: str) -> bool:
    """Does an effect accuse the channel, input or test that is at fault?"""
    place, accused = truth.split("@")[-1].split("|"), re.split(r"[|:]", effect.split("@")[-1])
    return effect.startswith(DATA) and set(place) <= set(accused)


def of_truth(label: Answer, answer: Answer) -> float:
    """Probability that the answer gives to what is hidden."""
    return sum(s.p for s in said(answer) if is_right(label, s))


def nats(label: Answer, answer: Answer) -> float:
    return log(max(of_truth(label, answer), FLOOR))


def brier(label: Answer, answer: Answer) -> float:
    """Squared error of the probability that something is missing or false."""
    p = answer.get("p_nothing")
    quiet = sum(s.p for s in said(answer) if s.hypothesis == NOTHING) if p is None else p
    return float((1.0 - quiet - (label["group"] not in QUIET)) ** 2)


def first_right(label: Answer, answer: Answer) -> bool:
    return is_right(label, said(answer)[0])


def credible(answer: Answer) -> list[Said]:
    """The most probable hypotheses that make up 90 %."""
    rows = said(answer)
    n = int(np.searchsorted(np.cumsum([s.p for s in rows]), CREDIBLE - 1e-9)) + 1
    return rows[:n]


def in_set(label: Answer, answer: Answer) -> bool:
    return any(is_right(label, s) for s in credible(answer))


def surely_another(label: Answer, answer: Answer) -> bool:
    """90 % or more for a name that is wrong; twins of one truth count together."""
    best = said(answer)[0]
    return best.hypothesis != NOTHING and best.p >= SURE and not is_right(label, best)


def surely_nothing(label: Answer, answer: Answer) -> bool | None:
    """90 % or more for nothing, although something is hidden."""
    best = said(answer)[0]
    return None if label["group"] in QUIET else best.hypothesis == NOTHING and best.p >= SURE


def when_right(label: Answer, answer: Answer) -> bool | None:
    """A condition, rightly named first: is its test right, and of one for a while begin and end within two samples?

    None where the label does not say in which test it held; a label without begin and end means the whole test.
    """
    best = said(answer)[0]
    if label["group"] != "condition" or not label["test"] or not is_right(label, best):
        return None
    right_test = best.tests == (label["test"],)
    if not label["span"] or label["span"][0] == 0.0 or not right_test:
        return right_test
    most = 2.0 * label.get("step_s", 60.0)
    return len(best.span) == 2 and max(abs(a - b) for a, b in zip(best.span, label["span"], strict=True)) <= most + 1e-6


def statements(pairs: Sequence[tuple[Answer, Answer]], least: float = 0.05) -> list[tuple[float, bool]]:
    """All that was said with at least some probability, and whether it was right; what is right counts as one."""
    out = []
    for label, answer in pairs:
        out += [(s.p, False) for s in said(answer) if s.p >= least and not is_right(label, s)]
        out += [(p, True) for p in [min(of_truth(label, answer), 1.0)] if p >= least]
    return out


def reliability(pairs: Sequence[tuple[Answer, Answer]]) -> list[tuple[float, float, int, float, float]]:
    """(from, to, statements, mean probability, share right) per bin of probability."""
    p, hit = (np.array(x, float) for x in zip(*statements(pairs), strict=True))
    bins = np.clip(np.searchsorted(EDGES, p, side="right") - 1, 0, len(EDGES) - 2)
    return [
        (EDGES[k], EDGES[k + 1], int(own.sum()), float(p[own].mean()), float(hit[own].mean()))
        for k in range(len(EDGES) - 1)
        if (own := bins == k).any()
    ]


def calibration_error(pairs: Sequence[tuple[Answer, Answer]]) -> float:
    """Expected calibration error: how far shares right lie from mean probabilities, weighted by their number."""
    table = reliability(pairs)
    return sum(n * abs(p - right) for _, _, n, p, right in table) / sum(n for _, _, n, _, _ in table)
