"""The table of promises over many cases."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from scipy.stats import binom

from hidden import judge, odds
from hidden.kinds import KINDS
from hidden.user import network_of

Pair = tuple[dict, dict]


def links_of(kind: str) -> dict[str, set[str]]:
    """Neighbours of every node of the user's network, through a node without mass as well."""
    network, out = network_of(kind), {}
    for link in network.links:
        a, b = (network.places[p].part if p in network.places else p for p in link.places)
        out.setdefault(a, set()).add(b)
        out.setdefault(b, set()).add(a)
    air = {p.name for p in network.places.values() if p.kind == "fluid"}
    return {a: set().union(near, *(out[f] for f in near & air)) for a, near in out.items()}


def promises(pairs: Iterable[Pair]) -> list[tuple[str, str, str, list[bool | None]]]:
    """(measure, target, classes, hits)."""
    pairs = list(pairs)
    near = {kind: links_of(kind) for kind in {label["machine"] for label, _ in pairs if label["machine"] in KINDS}}

    def over(test: Callable[..., bool | None], *extra: Any) -> list[bool | None]:
        return [test(label, answer, *extra) for label, answer in pairs]

    sizes = [(f"{s:g}x", s) for s in (1.0, 2.0, 4.0)]
    return [
        ("false alarm", "<= 0.05", "nothing missing", over(judge.false_alarm)),
        *((f"seen, {t}", "", "one effect", over(judge.seen, s)) for t, s in sizes),
        *(
            (
                f"right name, {t}",
                {2.0: ">= 0.90", 4.0: ">= 0.97"}.get(s, ""),
                "one effect without a twin",
                over(judge.right_name, s, True),
            )
            for t, s in sizes
        ),
        *((f"right name, {t}", "", "one effect", over(judge.right_name, s, False)) for t, s in sizes),
        *(
            (f"truth inside the group, {t}", ">= 0.97", "one effect, something reported", over(judge.truth_inside, s))
            for t, s in sizes
        ),
        *(
            (f"kind and place, {t}", {4.0: ">= 0.80"}.get(s, ""), "condition", over(judge.condition_seen, s))
            for t, s in sizes[1:]
        ),
        ("false event", "<= 0.05", "all that lasts", over(judge.false_event)),
        ("confidently wrong", "<= 0.01", "all classes", over(judge.confidently_wrong)),
        ("group with both", ">= 0.90", "confounded pair", over(judge.pair_as_group)),
        ("said so or abstained", ">= 0.85", "outside the catalogue", over(judge.foreign_said)),
        (
            "place within one link",
            ">= 0.70",
            "outside the catalogue, seen",
            [judge.foreign_found(a, b, near.get(a["machine"], {})) for a, b in pairs],
        ),
        ("both found, none false", ">= 0.85", "two effects", over(judge.both_found)),
        ("absorbed, parameter named", "", "absorbed by calibration", over(judge.absorbed_said)),
        ("fault found", "", "data faults", over(judge.fault_found)),
        ("no effect claimed", "", "wrong priors", over(judge.quiet)),
        ("next test resolves the group", ">= 0.80", "one effect or a pair, reported as a group", over(judge.resolved)),
        ("90 % interval covers", "0.85 to 0.95", "one effect, refitted", over(judge.covered)),
    ]


def contest(pairs: Iterable[Pair]) -> list[dict]:
    """Our first guess and every peer's, claimed or not; how often each claims something where nothing is missing."""
    pairs = [(label, answer) for label, answer in pairs if "peers" in answer]
    names, out = list(pairs[0][1]["peers"]) if pairs else [], []
    for name in names:
        for size in (1.0, 2.0, 4.0):
            ours = judge.rate([judge.leads(a, b["lead"], size) for a, b in pairs])
            their = judge.rate([judge.leads(a, b["peers"][name][0], size) for a, b in pairs])
            out.append(_against("one effect", f"first guess right, {size:g}x", name, ours, their))
        ours = judge.rate([judge.false_alarm(a, b) for a, b in pairs])
        their = judge.rate([b["peers"][name][1] if a["group"] == "nothing" else None for a, b in pairs])
        out.append(_against("nothing missing", "false alarm", name, ours, their))
    return [r for r in out if r["n"]]


def _against(group: str, measure: str, name: str, ours: tuple, their: tuple) -> dict:
    return _row(group, measure, *ours, peer=their[0], peer_name=name, peer_ci95=list(their[2]))


def _row(group: str, measure: str, value: float, n: int, interval: Sequence[float], **more: Any) -> dict:
    """A rate or share of n cases with its interval."""
    return {"case": group, "measure": measure, "unit": "1", "ours": value, "n": n, "ci95": list(interval), **more}


def rows(pairs: Iterable[Pair]) -> list[dict]:
    """The table in the benchmark's format; promises that no case puts to the test are left out."""
    pairs, out = list(pairs), []
    for measure, target, group, hits in promises(pairs):
        value, n, interval = judge.rate(hits)
        if n:
            out.append(_row(group, measure, value, n, interval, target=target))
    cost = [b["cpu_s"] for _, b in pairs]
    time = {"case": "diagnose", "measure": "time, median", "unit": "s", "ours": float(np.median(cost or [np.nan]))}
    return [*out, *fall(pairs), *contest(pairs), *folds(pairs), time]


def folds(pairs: Sequence[Pair]) -> list[dict]:
    """Odds against truth, for every kind and for all."""
    kinds = sorted({label["machine"] for label, _ in pairs})
    groups = {**{kind: [(a, b) for a, b in pairs if a["machine"] == kind] for kind in kinds}, "all kinds": list(pairs)}
    return [row for name, own in groups.items() if own for row in fold(name, own)]


def fold(name: str, pairs: Sequence[Pair]) -> list[dict]:
    """Means over the cases of a kind, then rates by class."""
    means = [("log posterior of the truth", "nats", odds.nats), ("Brier score of something missing", "1", odds.brier)]
    out = [_plain(name, m, unit, float(np.mean([of(a, b) for a, b in pairs])), len(pairs)) for m, unit, of in means]
    out += [
        _plain(name, "expected calibration error", "1", odds.calibration_error(pairs), len(pairs)),
        _plain(
            name, "90 % set, median size", "1", float(np.median([len(odds.credible(b)) for _, b in pairs])), len(pairs)
        ),
    ]
    for measure, target, test in RATES:
        value, n, interval = judge.rate([test(a, b) for a, b in pairs])
        if n:
            out.append({**_plain(name, measure, "1", value, n), "ci95": list(interval), "fold_target": target})
    return out


def _plain(name: str, measure: str, unit: str, value: float, n: int) -> dict:
    return {"case": name, "measure": measure, "unit": unit, "ours": value, "n": n, "fold": True}


def _in(test: Callable[[dict, dict], bool | None], *classes: str, size: float = 0.0) -> Callable[..., bool | None]:
    """A test asked of some classes alone, and of one size."""
    return lambda a, b: test(a, b) if a["group"] in classes and size in (0.0, a["size"]) else None


RATES: tuple[tuple[str, str, Callable[..., bool | None]], ...] = (
    ("false alarm", "<= 0.05", judge.false_alarm),
    ("one: truth or twin first", "", _in(odds.first_right, "one")),
    ("one: in the 90 % set", "", _in(odds.in_set, "one")),
    ("one, 4x: in the 90 % set", ">= 0.95", _in(odds.in_set, "one", size=4.0)),
    ("two: both first", "", _in(odds.first_right, "two")),
    ("pair: in the 90 % set", "", _in(odds.in_set, "pair")),
    ("condition: kind and place first", "", _in(odds.first_right, "condition")),
    ("condition: when", "", odds.when_right),
    ("fault: first", "", _in(odds.first_right, "fault")),
    ("outside: unknown heat first", "", _in(odds.first_right, "foreign")),
    ("sure of another", "<= 0.02", odds.surely_another),
    ("sure of nothing", "", odds.surely_nothing),
)


def met(row: dict) -> bool | None:
    """Is what was wanted reached?  None where nothing was."""
    words = row.get("target", "").split()
    if not words:
        return None
    if words[0] in ("<=", ">="):
        return bool(row["ours"] <= float(words[1]) if words[0] == "<=" else row["ours"] >= float(words[1]))
    return bool(float(words[0]) <= row["ours"] <= float(words[2]))


def fall(pairs: Iterable[Pair]) -> list[dict]:
    """Median share of the possible fall of the held-out error, its interval by the order statistics."""
    share = sorted(s for _, b in pairs if (s := judge.share_of_fall(b)) is not None)
    if not share:
        return []
    low, high = (share[int(k)] for k in binom.ppf((0.025, 0.975), len(share), 0.5).clip(0, len(share) - 1))
    measure, value = "held-out error, share of possible fall", float(np.median(share))
    return [_row("one effect", measure, value, len(share), (low, high), target=">= 0.85")]
