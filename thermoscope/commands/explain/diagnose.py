"""thermoscope explain diagnose CASE"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from shlex import join, quote
from typing import TYPE_CHECKING, Any

from thermoscope.commands.explain.bases_table import hypotheses_table
from thermoscope.commands.explain.next_tests import next_tests
from thermoscope.commands.model.error_budget import budget, in_short, sampling
from thermoscope.commands.open_case import open_case
from thermoscope.commands.stored_diagnosis import checked_diagnosis, save_diagnosis
from thermoscope.commands.test.compare import contradiction
from thermoscope.console.answer import Answer, Grid, cell
from thermoscope.console.terminal import Progress, give, notes, progress, value_with_interval

if TYPE_CHECKING:
    from thermoscope.case_folder.folder import Folder
    from validation.inference.result import Diagnosis

RIVALS = 3  # named in a sentence
ODDS, ROWS = 5, 10  # shown of hypotheses and of candidates
LEAST_PROBABILITY = 0.005  # probabilities below half a per cent are in --json


def diagnose(case: str, target: str | None, older: bool = False) -> int:
    """Exit code 1 when no effect is named.  older : an option of older versions was given"""
    if older:
        notes(["--draws is no longer needed: nothing is drawn"])
    with progress() as tell:
        diagnosis, document = diagnosed(open_case(case, tell), tell)
    give(document, target, lambda: answer(document, case))
    return 0 if diagnosis.verdict in ("named", "group", "several") else 1


def diagnosed(folder: Folder, tell: Progress) -> tuple[Diagnosis, dict[str, Any]]:
    """What is missing in an open case, and the document of it, which is kept in the case's out/."""
    from lumped.condensation.error_budget import ErrorBudget
    from validation import diagnose as search
    from validation.comparison.error_budget import documents
    from validation.parameters.unknowns import strain_words

    checked_diagnosis(folder)
    budgets = folder.budgets
    diagnosis = search(folder.case, folder.settings.kinds, tell, budget=ErrorBudget.worst(budgets.values()).total_K)
    header = {"case": folder.case.name, "revision": folder.case.model.revision}
    document = {**header, **diagnosis.document(), "error_budget": documents(budgets), **sampling(folder)}
    document["strained"] = strain_words(folder.case)
    save_diagnosis(folder, document)
    return diagnosis, document


def _proposed(document: Mapping[str, Any], first: str) -> list[str]:
    """What to add: the effect that is named first, or the set that it is in where that is the likeliest of all."""
    likeliest = document["odds"][0]["effects"] if document.get("odds") else []
    return list(likeliest) if first in likeliest else [first]


def answer(document: Mapping[str, Any], called: str) -> Answer:
    """The verdict; of a wrong base only that, for it comes first.  called : what the user calls the case"""
    sentence, case = f"{document['verdict']}: {document['words']}", quote(called)
    sentence = " ".join(filter(None, [document.get("strained", ""), sentence]))
    bases, steps = document.get("bases", []), document.get("sampling", {})
    if any(h["declared"] and h["excluded"] for h in bases):
        return Answer(sentence, [hypotheses_table(bases)], f"--json FILE; thermoscope bench bases {case}")
    effects = document.get("named", [])
    step = f"explain effects {case}" if not effects else f"model add {case} {join(_proposed(document, effects[0]))}"
    hidden = [f"{h['effect']} below {cell(h['smallest_detectable'])} {h['unit']}" for h in document["cannot_see"]]
    hidden_words = f"{len(hidden)} effects could be there unseen: {', '.join(hidden[:2])}, ..." if hidden else ""
    remaining = " ".join(row["words"] for row in document.get("remainder", []))
    candidates = document["candidates"]
    parts = [
        _odds(document),
        _candidates(candidates),
        *_leader(candidates),
        *_lost(candidates, effects),
        remaining,
        *events(document),
        *contradiction(document.get("contradiction")),
        *next_tests(document),
        in_short(document.get("error_budget", {}), steps),
        hidden_words,
        question(document, case),
    ]
    rest = [*events(document, likely=False), *budget(document.get("error_budget", {}), steps), *hidden]
    return Answer(sentence, parts, f"Next: thermoscope {step}; --json FILE; thermoscope show report {case}", rest)


def question(document: Mapping[str, Any], case: str) -> str:
    """What to ask the user, if an answer would tell more than a guess."""
    best = document.get("question")
    if not best:
        return ""
    return f"One question: {best['words']} Then: thermoscope explain answer {case} yes|no"


def _odds(document: Mapping[str, Any]) -> Grid:
    """Every hypothesis with its probability."""
    rows = [
        [o["hypothesis"], f"{100 * o['probability']:.1f}"]
        for o in document["odds"]
        if o["probability"] > LEAST_PROBABILITY
    ]
    return Grid("What the readings say", ["hypothesis", "probability (%)"], rows[:ODDS])


def _candidates(candidates: Sequence[Mapping[str, Any]]) -> Grid:
    """Size with interval and detection limit, and what it buys."""
    headers = ["effect", "%", "size (95 %)", "detectable", "unit", "refitted (K)", "held out (K)", "decision"]
    keep = ["size (95 %)", "%", "detectable", "unit", "refitted (K)"]
    rows = [_row(c) for c in candidates if c["probability"] > LEAST_PROBABILITY or c["decision"] != "no"] or [
        _row(c) for c in candidates[:1]
    ]
    return Grid("Candidates", headers, rows[:ROWS], ["named", "group"], keep)


def _leader(candidates: Sequence[Mapping[str, Any]]) -> list[str]:
    """From which size the leader shows, what it buys and looks like, and the experiment that proves it."""
    if not candidates or candidates[0]["probability"] <= LEAST_PROBABILITY:
        return []
    first = candidates[0]
    lines = [f"Detection limit: these tests show {first['effect']} from {limit(first)} on."]
    lines += [bought(first)] if first.get("tests") and first["decision"] != "no" else []
    lines += [f"Proof: {first['isolating_test']}."] if first["isolating_test"] else []
    if first["confused_with"]:
        lines.append(f"{first['effect']} looks like {', '.join(first['confused_with'])} to these tests and sensors.")
    return lines


def _lost(candidates: Sequence[Mapping[str, Any]], effects: Sequence[str]) -> list[str]:
    """Why the rivals lost: where a refit is worse, or how little evidence there is for the next ones alone."""
    if not effects:
        return []
    refitted = [
        f"Against {c['effect']}: it {c['note']} than {candidates[0]['effect']}."
        for c in candidates[1:ROWS]
        if c["note"] and c["probability"] > LEAST_PROBABILITY and c["effect"] not in effects
    ]
    rivals = sorted((c for c in candidates if c["effect"] not in effects and not c["note"]), key=lambda c: -c["score"])
    each = ", ".join(f"{c['effect']} {c['score']:.1f}" for c in rivals[:RIVALS])
    lead = next(c["score"] for c in candidates if c["effect"] == effects[0])
    return [*refitted, f"Rivals alone have less evidence: {each}; {effects[0]} {lead:.1f} nats."] if each else refitted


def limit(candidate: Mapping[str, Any]) -> str:
    """The smallest size that the tests would show, with its unit."""
    unit = candidate["amplitude"]["unit"]
    return f"{cell(candidate['smallest_detectable'])} {'' if unit == '1' else unit}".strip()


def bought(candidate: Mapping[str, Any]) -> str:
    """The error (K) in each test without and with the effect, all else fitted anew both times."""
    tests = candidate["tests"]
    each = [f"{t['test']}{'*' if t['held_out'] else ''} {t['before']:.2f} -> {t['after']:.2f}" for t in tests]
    star = " (* never used)" if any(t["held_out"] for t in tests) else ""
    return f"Refitted without -> with {candidate['effect']}, error (K): {', '.join(each)}{star}."


def events(document: Mapping[str, Any], likely: bool = True) -> list[Grid]:
    """When something may have been different, or the improbable stretches that were tried as well."""
    rows = [
        [
            f"event@{i}",
            e["words"],
            f"{100 * e['probability']:.1f}",
            e["effect"].split(" in ")[0],
            e["value"],
            "" if e["unit"] == "1" else e["unit"],
        ]
        for i, e in enumerate(document.get("events", []), 1)
        if likely == (e["probability"] > LEAST_PROBABILITY)
    ]
    headers = ["to add", "when", "%", "most likely", "size", "unit"]
    title = "What may have differed for a while" if likely else "Stretches in which hardly anything differed"
    return [Grid(title, headers, rows)] if rows else []


def _row(c: Mapping[str, Any]) -> list[Any]:
    size, share = c["amplitude"], f"{100 * c['probability']:.1f}"
    return [
        c["effect"],
        share,
        value_with_interval(size["value"], *size["ci95"]),
        cell(c["smallest_detectable"]),
        "" if size["unit"] == "1" else size["unit"],
        _arrow(c["rmse_K"]),
        _arrow(c["holdout_rmse_K"]),
        c["decision"],
    ]


def _arrow(pair: Mapping[str, float] | None) -> str:
    return f"{pair['before']:.2f} -> {pair['after']:.2f}" if pair else "-"
