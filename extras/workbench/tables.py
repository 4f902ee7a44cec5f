"""What the page lists, as plain values: errors per test and sensor, steps, candidates."""

from collections.abc import Collection, Mapping
from typing import Any

from extras.workbench.appearance import Appearance
from thermoscope import plugin as th

Row = dict[str, Any]
MOST_ROWS = 12  # candidates of a tab


def tests(look: Appearance, scale: float, before: Mapping[str, float]) -> list[Row]:
    """A bar per test: error (K), its length as a share of `scale`, and the error before the last step."""
    return [
        {
            "name": t["name"],
            "role": t["role"],
            "rmse": f"{t['rmse_K']:.2f}",
            "width": percent(t["rmse_K"], scale),
            "was": percent(before.get(t["name"], t["rmse_K"]), scale),
            "before": f"{before[t['name']]:.2f}" if t["name"] in before else "",
        }
        for t in look.errors["tests"]
    ]


def channels(look: Appearance, test: str, scale: float) -> list[Row]:
    """A row per sensor of a test: what it misses (K), and whether that is more than its uncertainty."""
    comparison = look.curves[test]
    tone = {c.name: comparison.sensor(c).verdict for c in comparison.channels}
    return [
        {
            "name": c["channel"],
            "label": th.short(c["channel"]),
            "place": c["place"],
            "rmse": f"{c['rmse_K']:.2f}",
            "width": percent(c["rmse_K"], scale),
            "sigma": f"{c['sigma_K']:.2g}",
            "verdict": c["verdict"],
            "tone": tone.get(c["channel"], "unknown"),
        }
        for c in look.test(test)["channels"]
    ]


def worst(look: Appearance) -> tuple[str, str]:
    """(test, channel) with the largest error against its limit, never-used tests first."""
    errors = [
        (t["role"] == "hold-out", c["rmse_K"] / c["limit_K"], t["name"], c["channel"])
        for t in look.errors["tests"]
        for c in t["channels"]
    ]
    return max(errors)[2:]


def largest(look: Appearance) -> tuple[float, float]:
    """The largest error of a test and of a sensor (K): what the bars' lengths refer to."""
    rows = look.errors["tests"]
    return max(t["rmse_K"] for t in rows), max(c["rmse_K"] for t in rows for c in t["channels"])


def steps(history: th.History, case: th.MeasuredCase) -> list[Row]:
    """The revisions, the last first."""
    words = [
        {"number": r.number, "text": th.step_words(case, r), "code": r.effect, "why": r.why.replace("->", "→")}
        for r in history.revisions
    ]
    return [*reversed(words), {"number": 0, "text": "as declared", "code": "", "why": ""}]


def candidates(diagnosis: Mapping[str, Any], effects: Collection[str]) -> list[Row]:
    """The table of a diagnosis, best first."""
    words = {c["effect"]: c.get("words") or c["effect"] for c in diagnosis["candidates"]}
    return [
        {
            "effect": c["effect"],
            "words": words[c["effect"]],
            "score": th.percent(c["probability"]),
            "width": percent(c["probability"], 1.0),
            "amplitude": th.amplitude(c),
            "alike": ", ".join(words.get(name) or th.value_words(name) for name in c["confused_with"][:3]),
            "decision": c["decision"],
            "test": c.get("isolating_test", ""),
            "inside": c["effect"] in effects,
        }
        for c in diagnosis["candidates"][:MOST_ROWS]
    ]


def conclusion(diagnosis: Mapping[str, Any]) -> Row:
    """What is missing, as the command says it, and what the tests cannot see."""
    tone, _ = th.verdict(diagnosis, None)
    hidden, (words,) = [h["words"] for h in diagnosis["cannot_see"]], th.sentences([diagnosis["words"]])
    further_tests = [
        f"{o['kind']} {o['what']}" + (f" ({o['how']})" if o["how"] else "") + f": separates {', '.join(o['separates'])}"
        for o in th.offers(diagnosis)[:3]
    ]
    hidden_words = f"{th.counted(len(hidden), 'effect')} could be there unseen, e.g. {', '.join(hidden[:4])}."
    return {"tone": tone, "words": words, "unseen": hidden_words * bool(hidden), "ahead": further_tests}


def percent(value: float, whole: float) -> float:
    return round(100.0 * min(value / whole, 1.0), 2) if whole > 0 else 0.0
