"""thermoscope explain diagnose CASE"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from math import inf, isfinite
from shlex import join, quote
from time import monotonic
from typing import TYPE_CHECKING, Any

from geom.errors import InputError, NoSolution
from geom.table import cell
from geom.text import counted
from thermoscope.commands.model.error_budget import budget, in_short, sampling
from thermoscope.commands.open_case import checked_diagnosis, open_case, save_diagnosis
from thermoscope.commands.test.compare import contradiction
from thermoscope.console.options import Case, Json, Only, Quick, Without
from thermoscope.console.summary import Summary, sentences
from thermoscope.console.terminal import Progress, give, notes, progress
from validation import tables
from validation.parameters.unknowns import strain_words, value_words

if TYPE_CHECKING:
    from thermoscope.case_folder.folder import Folder
    from validation.inference.result import Diagnosis

LONG_S = 120.0  # after which who waits is told what is known
RIVALS = 3  # named in a sentence
EXPLANATIONS, ROWS = 5, 10  # shown of them and of candidates


def diagnose(case: Case, target: Json = None, without: Without = None, only: Only = None, quick: Quick = False) -> int:
    """Which effect is missing, how sure, what it is confused with, which test would decide. Exit code 1 if none."""
    from validation.inference.decide import SURE

    with progress() as tell:
        folder, so_far = open_case(case, tell), SoFar(tell)
        try:
            diagnosis, document = diagnosed(folder, so_far.tell, without or (), only or (), quick, so_far.learn)
        except KeyboardInterrupt:
            _stopped(folder, so_far, case)
            raise
        if not quick and document["named"] and document["odds"][0]["probability"] < SURE:
            document["tried"] = _trial(folder, _proposed(document, document["named"][0]), tell)
    give(document, target, lambda: diagnosis_summary(document, case))
    return 0 if diagnosis.verdict in ("named", "group", "several") else 1


class SoFar:
    """What a diagnosis that goes on knows already: shown once it has taken LONG_S, and where the user stops it."""

    def __init__(self, progress: Progress) -> None:
        self.progress, self.begun, self.shown = progress, monotonic(), False
        self.result: Callable[[], Diagnosis] | None = None

    def learn(self, result: "Callable[[], Diagnosis]") -> None:
        """Told what works out the diagnosis as far as it is known."""
        self.result = result

    def tell(self, message: str) -> None:
        """Progress, and after LONG_S, once, what is known."""
        self.progress(message)
        if self.result and not self.shown and monotonic() - self.begun > LONG_S:
            self.shown = True
            notes([f"after {LONG_S / 60:.0f} min: {self.result().words}"])


def _stopped(folder: "Folder", so_far: SoFar, called: str) -> None:
    """What is known of a diagnosis that the user stopped: its first odds, or before there are any the comparison, where
    it is at hand or quick."""
    if so_far.result:
        document = so_far.result().document()
        give({}, None, lambda: diagnosis_summary(document, called))
    elif folder.built is None or folder.stored is not None:
        document = folder.compared.document()
        first, more = tables.comparison_tables(document)[0], f"thermoscope test compare {quote(called)}"
        give({}, None, lambda: Summary(document["words"], [first], more))
    what = "its odds are preliminary" if so_far.result else "a verdict weighs all hypotheses, so there is none yet"
    notes([f"stopped: {what}; a diagnosis of before stays in out/"])


def diagnosed(
    folder: "Folder",
    tell: Progress,
    without: Sequence[str] = (),
    only: Sequence[str] = (),
    quick: bool = False,
    report: "Callable[[Callable[[], Diagnosis]], None] | None" = None,
) -> "tuple[Diagnosis, dict[str, Any]]":
    """What is missing in an open case, and the document of it, which is kept in the case's out/ unless preliminary.

    without, only : what is left out of the question, see Scope;  quick, report : see `validation.diagnose`
    """
    from lumped.condensation.error_budget import ErrorBudget
    from validation import diagnose as search
    from validation.comparison.error_budget import documents
    from validation.diagnosis import untold
    from validation.inference.conditions import check_names
    from validation.scope import Scope

    checked_diagnosis(folder)
    scope = Scope(tuple(without), tuple(only))
    check_names(folder.case, [*without, *only], "the effects asked for or left out")
    budgets = folder.budgets
    worst = ErrorBudget.worst(budgets.values()).total_K
    diagnosis = search(
        folder.case, folder.settings.kinds, tell, budget=worst, scope=scope, quick=quick, report=report or untold
    )
    header = {"case": folder.case.name, "revision": folder.case.model.revision}
    budgets = {name: budget.with_condensation(diagnosis.small_network_K) for name, budget in budgets.items()}
    document = {**header, **diagnosis.document(), "error_budget": documents(budgets), **sampling(folder)}
    document["strained"] = strain_words(folder.case)
    if not quick:
        save_diagnosis(folder, document)
    return diagnosis, document


def _trial(folder: "Folder", effects: Sequence[str], tell: Progress) -> dict[str, Any]:
    """What `add` would say of effects that are not sure: nothing is proposed that it refuses."""
    from validation.revision.revise import add

    tell(f"predicting what was left out with {' and '.join(effects)}")
    try:
        step = add(folder.case, effects, tell)
    except (NoSolution, InputError) as fault:  # the model runs away with it, or has it already
        return {"effects": list(effects), "accepted": False, "why": str(fault)}
    return {"effects": list(effects), "accepted": step.accepted, "why": step.why}


def _proposed(document: Mapping[str, Any], first: str) -> list[str]:
    """What to add: the effect that is named first, or the set that it is in where that is the likeliest of all."""
    odds = document["odds"][0] if document.get("odds") else {"effects": []}
    likeliest = [name for name in odds["effects"] if name not in odds.get("faults", ())]
    return likeliest if first in likeliest else [first]


def diagnosis_summary(document: Mapping[str, Any], called: str) -> Summary:
    """The verdict; of a wrong base only that, for it comes first.  called : what the user calls the case"""
    plain = document["verdict"] == "adequate" and not document["revision"]  # never calibrated
    unfitted = "That is of the model calibrated to these tests, not as it stands" if plain else ""
    clauses = sentences([*filter(None, (document.get("strained"), document["words"], unfitted))])
    sentence, case = " ".join(clauses), quote(called)
    bases, steps, budgets = (document.get(key, []) for key in ("bases", "sampling", "error_budget"))
    if any(h["declared"] and h["excluded"] for h in bases):
        return Summary(sentence, [tables.bases_table(bases)], f"--json FILE; thermoscope bench bases {case}")
    effects, candidates = document.get("named", []), document["candidates"]
    step = f"model calibrate {case}" if plain else f"explain effects {case}"
    trial = document.get("tried", {"accepted": True})
    step = f"model add {case} {join(_proposed(document, effects[0]))}" if effects and trial["accepted"] else step
    refused = "" if trial["accepted"] else f"Not proposed, since model add would not accept it: {trial['why']}."
    hidden = [
        f"{h['words']} {f'below {limit(h)}' if isfinite(h['smallest_detectable'] or inf) else 'at any size'}"
        for h in document["cannot_see"]
    ]
    hidden_words = f"{counted(len(hidden), 'effect')} could be there unseen: {', '.join(hidden[:2])}"
    hidden_words = f"{hidden_words}{', ...' * (len(hidden) > 2)}" * bool(hidden)
    events, explained = document.get("events", []), document.get("explanations", [])
    explanations = tables.explanations_table(explained, partners=False)
    candidate_rows = tables.candidates_table(tables.weighty_candidates(candidates))
    parts = [
        replace(explanations, rows=explanations.rows[:EXPLANATIONS]),
        *(f"Beside it: {beside}." for x in explained[:1] if (beside := tables.partner_words(x))),
        replace(candidate_rows, rows=candidate_rows.rows[:ROWS]),
        refused,
        *_leader(candidates),
        *_lost(candidates, effects),
        " ".join(row["words"] for row in document.get("remainder", [])),
        tables.events_table(events),
        *contradiction(document.get("contradiction")),
        *tables.next_tests(document),
        in_short(budgets or {}, steps or {}),
        hidden_words,
        question(document, case),
    ]
    doubts = tables.doubts_table(document.get("doubts", []))
    rest = [tables.events_table(events, likely=False), doubts, *budget(budgets or {}, steps or {}), *hidden]
    return Summary(sentence, parts, f"next: thermoscope {step}; --json FILE; thermoscope show report {case}", rest)


def question(document: Mapping[str, Any], case: str) -> str:
    """What to ask the user, if an answer would tell more than a guess."""
    best = document.get("question")
    return f"One question: {best['words']} Then: thermoscope explain answer {case} yes|no" if best else ""


def _words(candidates: Iterable[Mapping[str, Any]]) -> dict[str, str]:
    """Candidate -> what it is in plain words."""
    return {c["effect"]: c.get("words") or c["effect"] for c in candidates}


def _leader(candidates: Sequence[Mapping[str, Any]]) -> list[str]:
    """From which size the leader shows, what it looks like, and the experiment that proves it."""
    if not candidates or candidates[0]["probability"] <= tables.LEAST_PROBABILITY:
        return []
    first, words = candidates[0], _words(candidates)
    lines = [f"Detection limit: these tests show it from {limit(first)} on."]
    lines += [f"Proof: {first['isolating_test']}."] if first["isolating_test"] else []
    if first["confused_with"]:
        alike = ", ".join(words.get(name) or value_words(name) for name in first["confused_with"])
        lines.append(f"These tests and sensors cannot tell it from: {alike}.")
    return lines


def _lost(candidates: Sequence[Mapping[str, Any]], effects: Sequence[str]) -> list[str]:
    """Why the rivals lost: where a refit is worse, or how little evidence there is for the next ones alone."""
    if not effects:
        return []
    words = _words(candidates)
    refitted = [
        f"Against '{words[c['effect']]}': it {c['note']}."
        for c in candidates[1:ROWS]
        if c["note"] and c["probability"] > tables.LEAST_PROBABILITY and c["effect"] not in effects
    ]
    rivals = sorted((c for c in candidates if c["effect"] not in effects and not c["note"]), key=lambda c: -c["score"])
    each = ", ".join(f"{words[c['effect']]} ({c['score']:.1f})" for c in rivals[:RIVALS])
    lead = next(c["score"] for c in candidates if c["effect"] == effects[0])
    evidence = f"Log odds {lead:.1f} (3 is twenty to one); of each rival alone: {each}."
    return [*refitted, evidence] if each else refitted


def limit(candidate: Mapping[str, Any]) -> str:
    """The smallest size that the tests would show, with its unit."""
    return f"{cell(candidate['smallest_detectable'])} {tables.unit_of(candidate.get('amplitude', candidate))}".strip()
