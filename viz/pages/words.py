"""The verdict in one sentence, from the result documents."""

from collections.abc import Mapping, Sequence
from typing import Any

from viz.figures.candidates import amplitude

Document = Mapping[str, Any]
TONE = {"adequate": "good", "outside": "warn"}  # a cause that is found is news, no warning


def verdict(diagnosis: Document | None, comparison: Document | None) -> tuple[str, str]:
    """(tone, sentence): what a manager should read first."""
    if diagnosis is None:
        return _agreement(comparison)
    code = diagnosis["verdict"]
    names = [c.get("words") or c["effect"] for c in diagnosis["candidates"] if c["decision"] in ("named", "group")]
    off = " ".join(r["words"] for r in diagnosis.get("remainder", [])[:1])
    if code == "adequate" and not off and (places := _off_places(comparison)):
        return "warn", f"Nothing is found missing from the model, yet it is off at {spoken(places)}."
    answer = f"{diagnosis.get('words', '')[:1].upper()}{diagnosis.get('words', '')[1:]}."
    contradicted = any(c.get("contradicts") for c in diagnosis.get("checks", []))
    sentences = {
        "adequate": f"Nothing with a name is missing from the model. {off}"
        if off
        else "The model agrees with the measurements; nothing is found missing.",
        "named": f"Missing from the model: {spoken(names[:1])}.",
        "group": f"Missing from the model: one of {spoken(names, 'or')}. These tests cannot tell them apart."
        if len(names) > 1
        else f"Perhaps missing from the model: {spoken(names)}. These tests cannot tell.",
        "several": f"Missing from the model: {spoken(names)}.",
        "outside": answer
        if contradicted
        else f"Heat is missing or in excess{_where(diagnosis)}; no known effect explains it.",
        "absorbed": "A calibrated value lies far from what is physically expected; it may hide a missing effect.",
        "data": _elsewhere(diagnosis) or "Check the sensors and inputs first; the error looks like theirs.",
    }
    return TONE.get(code, "info"), sentences[code]


def _elsewhere(diagnosis: Document) -> str:
    """Tests that stood on another base than their sheets say."""
    rows = diagnosis.get("bases", [])
    wrong = [h for h in rows if h["declared"] and h["excluded"]]
    parts = [
        f"{w['test']} did not stand on the base its sheet says ({w['base']}), but on "
        f"{spoken([h['base'] for h in rows if h['test'] == w['test'] and not h['excluded']], 'or')}"
        for w in wrong
    ]
    return f"{'; '.join(parts)}: look at the sheet before the model." if parts else ""


def detail(diagnosis: Document | None) -> str:
    """Amplitude and gain of the best named candidate; empty when nothing is named."""
    best = next((c for c in (diagnosis or {}).get("candidates", []) if c["decision"] == "named"), None)
    if best is None:
        return ""
    name = spoken([best.get("words") or best["effect"]])
    return f"{name[0].upper()}{name[1:]}: {amplitude(best)}."


def spoken(effects: Sequence[str], last: str = "and") -> str:
    """'convection@flange.right' -> 'convection at flange.right'; several joined by commas and `last`."""
    words = [e.replace("@", " at ").replace("_", " ") for e in effects] or ["nothing that can be named"]
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} {last} {words[-1]}"


def _agreement(comparison: Document | None) -> tuple[str, str]:
    if places := _off_places(comparison):
        return "warn", f"The model disagrees with the measurements at {spoken(places)}."
    return "good", "The model agrees with the measurements within the uncertainty of readings, inputs, arithmetic."


def _off_places(comparison: Document | None) -> list[str]:
    """Where a record is over what reading and model may be off by."""
    tests = comparison["tests"] if comparison else []
    return sorted({c["place"] for t in tests for c in t["channels"] if c["verdict"] == "over"})


def ending(diagnosis: Document | None) -> str:
    """Why an improvement ended, and how near it came to the best plain model; "" where there was none."""
    why = (diagnosis or {}).get("ended", "")
    return f"It ended here. {why[:1].upper()}{why[1:]}." if why else ""


def _where(diagnosis: Document) -> str:
    places = [w["place"] for w in diagnosis.get("where", [])[:2]]
    return f" near {spoken(places, 'or')}" if places else ""
