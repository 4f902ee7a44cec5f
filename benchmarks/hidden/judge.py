"""An answer held against its label: which promises it keeps. True, False, or None where one does not apply."""

from collections.abc import Mapping, Sequence
from typing import Any

from scipy.stats import binomtest

from hidden.odds import fault_of

CLAIMS = ("named", "group", "several", "outside")
Answer = Mapping[str, Any]


def wilson(k: int, n: int) -> tuple[float, float]:
    """95 % interval of a rate, Wilson 1927."""
    low, high = binomtest(k, n).proportion_ci(method="wilson") if n else (0.0, 1.0)
    return float(low), float(high)


def reported(answer: Answer) -> list[str]:
    """Every effect the answer speaks of."""
    return [e for g in answer["groups"] for e in g]


def false_alarm(label: Answer, answer: Answer) -> bool | None:
    """Nothing missing, and yet something is claimed; a fault of the measurement that is not there counts as well."""
    return answer["verdict"] in (*CLAIMS, "data") if label["group"] == "nothing" else None


def right_name(label: Answer, answer: Answer, size: float, alone: bool) -> bool | None:
    """One effect of this size; alone: only where it has no twin."""
    if label["group"] != "one" or label["size"] != size or (alone and label["twins"][0]):
        return None
    return answer["verdict"] == "named" and set(answer["groups"][0]) <= set(label["right"][0])


def truth_inside(label: Answer, answer: Answer, size: float) -> bool | None:
    """Where something is claimed or a fault reported: is the truth in what is reported?"""
    if label["group"] != "one" or label["size"] != size or not answer["groups"]:
        return None
    return meets(label["right"][0], answer["groups"][0])


def meets(names: Sequence[str], group: Sequence[str]) -> bool:
    return bool(set(names) & set(group))


def seen(label: Answer, answer: Answer, size: float) -> bool | None:
    """Anything but 'adequate'."""
    if label["group"] != "one" or label["size"] != size:
        return None
    return answer["verdict"] != "adequate"


def confidently_wrong(label: Answer, answer: Answer) -> bool | None:
    """One name alone, and it is none of what is hidden; a thermometer or input accused alone is a name as well."""
    alone = [g[0].split(" in ")[0] for g in answer["groups"][:1] if len(g) == 1]
    right = any(meets(names, alone) for names in label["right"])
    if answer["verdict"] == "data":
        return not (right or fault_found(label, answer)) and (bool(alone) or not answer["groups"])
    return answer["verdict"] == "named" and not right


def pair_as_group(label: Answer, answer: Answer) -> bool | None:
    """The truth and one of those that are as good, in one group."""
    if label["group"] != "pair":
        return None
    return any(meets(label["right"][0], g) and meets(label["twins"][0], g) for g in answer["groups"][:1])


def condition_seen(label: Answer, answer: Answer, size: float) -> bool | None:
    """Something that held for a while, of this size: what and where are in the first group."""
    if label["group"] != "condition" or label["size"] != size:
        return None
    names = [e.split(" in ")[0] for e in (answer["groups"][0] if answer["groups"] else [])]
    return meets([*label["right"][0], *label["twins"][0]], names)


def false_event(label: Answer, answer: Answer) -> bool | None:
    """Something is said to have held in one test or for a while, and nothing did."""
    if label["group"] in ("condition", "foreign"):
        return None
    return any(" in " in g[0] for g in answer["groups"] if g)


def foreign_said(label: Answer, answer: Answer) -> bool | None:
    """Outside the catalogue: said so, or nothing claimed."""
    return answer["verdict"] in ("outside", "absorbed", "adequate") if label["group"] == "foreign" else None


def foreign_found(label: Answer, answer: Answer, links: Mapping[str, set[str]]) -> bool | None:
    """Outside the catalogue and seen: the place with most evidence is the true one or a neighbour."""
    if label["group"] != "foreign" or answer["verdict"] == "adequate" or not answer["where"]:
        return None
    best = answer["where"][0][0]
    return best == label["place"] or best in links.get(label["place"], set())


def both_found(label: Answer, answer: Answer) -> bool | None:
    """Two effects: each leads or is in one of exactly two groups."""
    if label["group"] != "two":
        return None
    groups, true = answer["groups"], label["right"]
    crossed = len(groups) == 2 and any(meets(true[i], groups[0]) and meets(true[1 - i], groups[1]) for i in (0, 1))
    return answer["verdict"] == "several" and crossed


def absorbed_said(label: Answer, answer: Answer) -> bool | None:
    """A calibrated parameter far off: absorbed, and that parameter among those pointed at."""
    if label["group"] != "absorbed":
        return None
    return answer["verdict"] == "absorbed" and label["truth"][0] in [p[0] for p in answer["pulls"]]


def fault_found(label: Answer, answer: Answer) -> bool | None:
    """Verdict 'data', and the fault or its channel is what is pointed at."""
    if label["group"] != "fault":
        return None
    place = label["truth"][0].split("@")[1]
    kinds = {name.split("@")[0] for name in (label["truth"][0], *(n for names in label["right"] for n in names))}
    plain = bool(kinds & {"frozen", "clipped", "unit"})
    hit = (plain and place in answer["words"]) or any(
        fault_of(label["truth"][0], e.split(" in ")[0]) for e in reported(answer)[:3]
    )
    return answer["verdict"] == "data" and hit


def quiet(label: Answer, answer: Answer) -> bool | None:
    """Priors wrong by two deviations: no effect and no fault claimed."""
    return answer["verdict"] in ("adequate", "absorbed") if label["group"] == "tense" else None


def covered(label: Answer, answer: Answer) -> bool | None:
    """The true amplitude lies in the 90 % interval of the true effect, where it was refitted."""
    if label["group"] != "one" or not label["amplitude"] or answer["verdict"] not in ("named", "group"):
        return None
    row = next((answer["candidates"][n] for n in label["right"][0] if n in answer["candidates"]), None)
    if row is None or row["decision"] not in ("named", "group"):
        return None
    half = 0.5 * (row["ci95"][1] - row["ci95"][0]) * 1.645 / 1.96
    return abs(row["value"] - label["amplitude"][0] / label.get("area", 1.0)) <= half


def leads(label: Answer, name: str, size: float) -> bool | None:
    """Would `name`, claimed or not, be right? A node is right when the effect sits there."""
    if label["group"] != "one" or label["size"] != size:
        return None
    (names,) = label["right"]
    return name in names or ("@" not in name and any(name in n.split("@")[1].split("|") for n in names))


def share_of_fall(answer: Answer) -> float | None:
    """Fall of the held-out error with what was claimed, over the fall with the truth, where that is 5 % at least."""
    worth = answer.get("worth")
    if not worth or worth["best"] > 0.95 * worth["before"]:
        return None
    return (worth["before"] - worth["claimed"]) / (worth["before"] - worth["best"])


def resolved(label: Answer, answer: Answer) -> bool | None:
    """After the proposed test: the truth alone."""
    after = answer.get("followed")
    if not after or label["group"] not in ("one", "pair"):
        return None
    return after["verdict"] == "named" and set(after["groups"][0]) <= set(label["right"][0])


def rate(hits: Sequence[bool | None]) -> tuple[float, int, tuple[float, float]]:
    """Rate, number of cases it applies to, Wilson interval."""
    applies = [h for h in hits if h is not None]
    n, k = len(applies), sum(applies)
    return (k / n if n else float("nan")), n, wilson(k, n)
