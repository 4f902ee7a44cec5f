"""What would tell a group of candidates apart, from a diagnosis's document: tests, sensors, or that no test would."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

Document = Mapping[str, Any]


class Offer(NamedTuple):
    """kind : "test" or "sensor";  separates : pairs of effects;  gain : predicted deviance, 20 decides

    how : a test's currents, a sensor's way in
    """

    kind: str
    what: str
    separates: list[str]
    gain: float
    hours: float | None
    how: str


def deciding(diagnosis: Document) -> list[Offer]:
    """Tests, then sensors, each best first, that are expected to tell at least one pair apart."""
    return [
        Offer(
            kind,
            o[name],
            o["separates"],
            o["predicted_gain"],
            o.get("hours"),
            o.get("why") or currents(o.get("currents", [])),
        )
        for kind, key, name in (("test", "next_tests", "test"), ("sensor", "next_sensors", "place"))
        for o in diagnosis.get(key, [])
        if o["separates"]
    ]


def currents(levels: Sequence[Document]) -> str:
    """The currents of a planned test, as its document lists them."""
    return "; ".join(f"{c['input']} at {c['level_A']:.4g} A, {c['share_of_rms']:.2f} of its rms" for c in levels)


def undecided(diagnosis: Document) -> str:
    """That no candidate test is expected to decide, and which comes nearest; empty where no test was looked at."""
    tests = diagnosis.get("next_tests", [])
    if not tests:
        return ""
    best = max(tests, key=lambda t: t["predicted_gain"])
    gain = f"with a predicted gain of {best['predicted_gain']:.2g} where 20 decides"
    return f"No candidate test would tell them apart: '{best['test']}' comes nearest, {gain}."
