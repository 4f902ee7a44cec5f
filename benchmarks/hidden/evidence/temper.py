"""What the temper would have been, and what it would have brought, on machine kinds that it was not set on.

A temper T divides all log evidence: P ~ prior * evidence^(1 / T), with T = base + slope * (the largest log evidence
over nothing). Answers keep evidence and probability of every hypothesis, so that another temper needs no case to be
asked again.
"""

from collections.abc import Mapping, Sequence
from itertools import product
from math import exp
from typing import Any

import numpy as np

from hidden.odds import brier, calibration_error, in_set, nats, surely_another
from measured.doubt import TEMPER
from scripts.published import table

SHARPNESS = TEMPER["sharpness"].share
SHARPER: Sequence[float] = (0.8, 1.0, 1.1, 1.25, 1.4, 1.6, 2.0)
Pair = tuple[Mapping[str, Any], Mapping[str, Any]]
Temper = tuple[float, float]
TRIED: Sequence[Temper] = tuple(product((1.0, 1.25, 1.5, 2.0, 2.5, 3.0), (0.0, 0.003, 0.01, 0.02, 0.04)))
USED: Temper = (TEMPER["temper"].share, TEMPER["temper per nat"].share)
NONE: Temper = (1.0, 0.0)
LEAST = 1e-4  # of odds that an answer lists


def divisor(temper: Temper, most: float) -> float:
    return temper[0] + temper[1] * max(most, 0.0)


def tempered(answer: Mapping[str, Any], temper: Temper, asked: Temper = USED) -> dict[str, Any]:
    """The answer with its odds under another temper than the one it was asked with; "others" go with the median."""
    known = [o["log_evidence"] for o in answer["odds"] if o.get("log_evidence") is not None]
    middle, most = (float(np.median(known)), max(known)) if known else (0.0, 0.0)
    turn = SHARPNESS * (1.0 / divisor(temper, most) - 1.0 / divisor(asked, most))
    evidence = [middle if (b := o.get("log_evidence")) is None else b for o in answer["odds"]]
    top = max(turn * x for x in evidence) if evidence else 0.0
    rows = [
        {**o, "probability": o["probability"] * exp(turn * x - top)}
        for o, x in zip(answer["odds"], evidence, strict=True)
    ]
    whole = sum(o["probability"] for o in rows)
    rows = [{**o, "probability": o["probability"] / whole} for o in rows]
    return {**answer, "odds": rows, "p_nothing": sum(o["probability"] for o in rows if o["hypothesis"] == "nothing")}


def sharpened(answer: Mapping[str, Any], power: float, asked: float = SHARPNESS) -> dict[str, Any]:
    """The answer with another power of its odds than the one it was asked with; "others" are as many as are just too
    improbable to be listed."""
    rows = [o for o in answer["odds"] if o["probability"] > 0.0]
    least = 0.5 * LEAST
    many = [o["probability"] / least if o["hypothesis"] == "others" else 1.0 for o in rows]
    each = [least if o["hypothesis"] == "others" else o["probability"] for o in rows]
    whole = sum(n * p ** (power / asked) for n, p in zip(many, each, strict=True))
    rows = [{**o, "probability": n * p ** (power / asked) / whole} for o, n, p in zip(rows, many, each, strict=True)]
    return {**answer, "odds": rows, "p_nothing": sum(o["probability"] for o in rows if o["hypothesis"] == "nothing")}


def sharpness_folds(cases: Sequence[Pair]) -> str:
    """One line per kind: the power that all others ask for, and the scores of this kind at one and at that power."""
    rows = []

    def score(own: Sequence[Pair], power: float) -> float:
        return float(np.mean([nats(label, sharpened(answer, power)) for label, answer in own]))

    every: dict[bool, list[Pair]] = {True: [], False: []}
    for kind in sorted({label["machine"] for label, _ in cases}):
        own, others = ([c for c in cases if (c[0]["machine"] == kind) is mine] for mine in (True, False))
        power = max(SHARPER, key=lambda x: score(others, x)) if others else 1.0
        plain, then = ([(label, sharpened(answer, x)) for label, answer in own] for x in (1.0, power))
        every[False] += plain
        every[True] += then
        rows.append(_row(kind, f"{power:g}", plain, then))
    both = ("log score at 1", "at that power", "calibration error at 1", "at that power")
    every_row = _row("all", "", every[False], every[True])
    return table(["kind left out", "cases", "power of the others", *both], [*rows, every_row])


def _row(kind: str, power: str, plain: Sequence[Pair], then: Sequence[Pair]) -> list[str]:
    logs = [f"{np.mean([nats(*c) for c in cases]):.2f}" for cases in (plain, then)]
    errors = [f"{calibration_error(cases):.2f}" for cases in (plain, then)]
    return [kind, str(len(plain)), power, *logs, *errors]


def log_score(cases: Sequence[Pair], temper: Temper) -> float:
    """Mean log probability of the truth."""
    return float(np.mean([nats(label, tempered(answer, temper)) for label, answer in cases]))


def best(cases: Sequence[Pair]) -> Temper:
    """The temper of the largest log score."""
    return max(TRIED, key=lambda t: log_score(cases, t))


def folds(cases: Sequence[Pair]) -> list[dict[str, Any]]:
    """One row per kind: the temper that all others ask for, and the scores of this kind under it and under none."""
    out = []
    for kind in sorted({label["machine"] for label, _ in cases}):
        own = [c for c in cases if c[0]["machine"] == kind]
        others = [c for c in cases if c[0]["machine"] != kind]
        temper = best(others) if others else NONE
        then = [(label, tempered(answer, temper)) for label, answer in own]
        out.append(
            {
                "kind": kind,
                "n": len(own),
                "temper": temper,
                "untempered": log_score(own, NONE),
                "log_score": log_score(own, temper),
                "brier": float(np.mean([brier(*c) for c in then])),
                "in_set": float(np.mean([in_set(*c) for c in then])),
                "sure_and_wrong": float(np.mean([surely_another(*c) for c in then])),
            }
        )
    return out


def markdown(rows: Sequence[Mapping[str, Any]]) -> str:
    """The folds as a table."""
    cells = []
    for r in rows:
        scores = f"{r['untempered']:.2f}", f"{r['log_score']:.2f}", f"{r['brier']:.3f}"
        shares = (f"{100 * r[key]:.0f} %" for key in ("in_set", "sure_and_wrong"))
        cells.append([r["kind"], r["n"], "{:g} + {:g}".format(*r["temper"]), *scores, *shares])
    scores = ("log score at 1", "at that temper", "Brier", "truth in the 90 % set", "sure and wrong")
    return table(["kind left out", "cases", "temper of the others, and per nat", *scores], cells)
