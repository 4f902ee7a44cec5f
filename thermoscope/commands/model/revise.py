"""thermoscope model add | remove CASE EFFECT@PLACE, thermoscope model undo CASE"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import isfinite
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any

import typer

from geom.errors import InputError
from geom.table import Table
from geom.text import counted
from measured.sensors.faults import broken_channels
from thermoscope.case_folder.columns import checked_columns, write_columns
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.history import Revision, save_history
from thermoscope.case_folder.runs import at_revision, by_interest, effects_first, ends, finding_words, mean_rows
from thermoscope.commands.open_case import current_diagnosis, open_case_for_writing
from thermoscope.console.options import Anyway, Case, Effect, Effects, Json
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give, notes, progress
from validation.comparison.compare import errors
from validation.parameters.unknowns import strain_words, value_words
from validation.tables import parameters_table, revision_tables
from validation.threads import side_by_side

if TYPE_CHECKING:
    from validation.revision import revise

NO_EVENT = "thermoscope explain diagnose first: it found no event in these"
FEW = 4  # parameters named in a sentence
CHANGE_K = 1.0  # what a step has to move where no sensor is, to be told
LINE = 75  # letters, so that its unit still fits into 80


def add(case: Case, effect: Effects, anyway: Anyway = False, target: Json = None) -> int:
    """Add an effect, or several that need each other; recalibrate, and show the error before and after on every test,
    held-out ones too. Accepted is what predicts tests left out of the fit better than before."""
    from validation.revision.revise import add as added

    def step(folder: Folder, tell: Callable[[str], None]) -> "revise.Revision":
        before = None if folder.stored is None else folder.stored.comparison
        return added(folder.case, [meant(folder, one) for one in effect], tell, before)

    return revised(case, step, anyway, target)


def meant(folder: Folder, effect: str) -> str:
    """The effect itself, or of "event@N" and "event@NAME" what the last diagnosis thinks it was."""
    kind, _, which = effect.partition("@")
    if kind != "event":
        return effect
    events = (current_diagnosis(folder) or {}).get("events", [])
    names = {name: e["effect"] for i, e in enumerate(events) for name in (str(i + 1), e["event"])}
    if which not in names:
        right = f"event@1 to event@{len(events)}" if events else NO_EVENT
        raise InputError(f"no event '{which}'", f"effect '{effect}'", right)
    return str(names[which])


def remove(case: Case, effect: Effect, target: Json = None) -> int:
    """Take an effect out again and recalibrate."""
    from validation.revision.revise import remove as removed

    return revised(case, lambda folder, tell: removed(folder.case, effect, tell), True, target)


def undo(
    case: Case,
    number: Annotated[
        int | None, typer.Option("--to", min=0, help="Revision; 0 is the model as declared. Else the last.")
    ] = None,
    target: Json = None,
) -> int:
    """Step back: one revision more, equal to an earlier one. The history stays whole."""
    with progress() as tell:
        folder = open_case_for_writing(case, tell)
        checked_columns(folder)
        last = folder.history.last.number
        if number is None and last == 0:
            raise InputError("there is no step to undo", str(folder.settings.model_file), "a case that was revised")
        history = folder.history.back_to(last - 1 if number is None else number)
        after = at_revision(folder, history.last)
        tell("running the model")
        rms = {t.name: t.rmse_K for t in errors(after).tests}
    save_history(folder.settings.model_file, history, folder.history)
    write_columns(folder, history.last.effects)
    model = {"case": folder.case.name, "revision": history.last.number, "why": history.last.why}
    document = {**model, "effects": list(history.last.effects), "rmse_K": rms}
    sentence, rows = f"Revision {history.last.number}: {history.last.why}.", list(rms.items())
    give(document, target, lambda: Summary(sentence, [Table("", ["test", "rms (K)"], rows)]))
    return 0


def revised(case: str, step: "Callable[..., revise.Revision]", anyway: bool, target: str | None) -> int:
    """Open, take the step, keep it if it is accepted, show it. `step` is given folder and progress."""
    with progress() as tell:
        folder = open_case_for_writing(case, tell)
        checked_columns(folder)
        notes(f"{f.words}; those readings are left out" for f in broken_channels(folder.case.tests))
        result = step(folder, tell)
    keep, finding = result.worth_keeping or anyway, ""
    if keep:
        longer = folder.history.and_then(recorded(result, evidence(folder, result)))
        longer = save_history(folder.settings.model_file, longer, folder.history)
        write_columns(folder, longer.last.effects)
        if result.action == "add":
            after = replace(folder, case=at_revision(folder, longer.last), history=longer)
            # of a machine the whole comparison is kept, and the next command asks for it
            finding = finding_words(after, (after.compared if after.built else result.after).document())
    places = unmeasured(folder, result)
    nuisance_words = strain_words(replace(folder.case, model=result.model))
    more = {"case": folder.case.name, "written": keep, "unmeasured": places, "strained": nuisance_words}
    more |= {"found": finding}
    document = {**result.document(), **more}
    give(document, target, lambda: revision_summary(document, folder, case))
    return 0 if result.accepted or anyway else 1


def unmeasured(folder: Folder, result: "revise.Revision") -> list[dict[str, Any]]:
    """Bodies without a sensor, the one that the step moved most first: at the end of the most telling test.

    Only those that losses heat; nobody limits the others.
    """
    test, network = by_interest(folder)[0], folder.case.model.network
    read = {c.place for t in folder.case.tests for c in t.channels}
    heated = set(network.heated)
    names = [n for n in mean_rows(network) if n in heated - read and network.places[n].kind in ("part", "node")]
    models = (folder.case, replace(folder.case, model=result.model))
    before, after = side_by_side(lambda case: ends(case, test, names), models)
    out = [
        {"place": n, "test": test.name, "before_C": a, "after_C": b}
        for n, a, b in zip(names, before, after, strict=True)
    ]
    return sorted(out, key=lambda p: -abs(p["after_C"] - p["before_C"]))


def recorded(result: "revise.Revision", evidence: Mapping[str, float | str]) -> Revision:
    """A step as model.toml keeps it."""
    effects, values = tuple(e.name for e in result.model.effects), dict(result.model.values)
    intervals = {p.name: p.ci95 for p in result.parameters}
    rmse = {t.name: (t.before, t.after) for t in result.tests if isfinite(t.before)}
    step = Revision(0, result.action, effects, result.effect or "", values, intervals, rmse, result.why, dict(evidence))
    return replace(step, reference=result.model.reference)


def evidence(folder: Folder, result: "revise.Revision") -> dict[str, float | str]:
    """What the last diagnosis of this very model said about the effect; empty when there was none."""
    diagnosis = current_diagnosis(folder) if result.action == "add" else None
    rows = [c for c in (diagnosis or {}).get("candidates", []) if c["effect"] == result.effect]
    return {key: rows[0][key] for key in ("probability", "score", "threshold", "decision")} if rows else {}


def in_words(p: Mapping[str, Any]) -> dict[str, Any]:
    """A parameter as an engineer says it, and the one that it trades with."""
    return {**p, "name": value_words(p["name"]), "partner": p["partner"] and value_words(p["partner"])}


def named(p: Mapping[str, Any]) -> str:
    """A parameter the data cannot fix, with the one it trades with."""
    return f"{p['name']} (trades with {p['partner']})" if p["partner"] else str(p["name"])


def revision_summary(document: Mapping[str, Any], folder: Folder, called: str) -> Summary:
    """Whether it stands, the error before and after, and the values that the data fixed."""
    where = f"Written to {folder.settings.model_file} as revision {document['revision']}."
    outcome = where if document["written"] else "Nothing written (--anyway writes it)."
    errors = revision_tables(document)[0]
    failed = [f"FAILED  {c['check']}: {c['words']}" for c in document["checks"] if not c["passed"]]
    passed = [f"passed  {c['check']}: {c['words']}" for c in document["checks"] if c["passed"]]
    step = "explain diagnose" if document["action"] == "calibrate" else "test compare"
    blind = [named(in_words(p)) for p in document["parameters"] if not p["identified"] and not p["of_measurement"]]
    few = f"{', '.join(blind[:FEW])}{', ...' if len(blind) > FEW else ''}"
    parts: list[Table | str] = [
        errors,
        *([f"Accepted: {document['why']}."] if document["accepted"] and document["found"] else []),
        *failed,
        _unmeasured_words(document["unmeasured"]),
        _hidden_starts(document["parameters"]),
        *passed,
        _fixed(document["parameters"]),
        f"The data do not fix {counted(len(blind), 'parameter')}: {few}" if blind else "",
    ]
    sentence = " ".join(filter(None, [*_outcome_words(document), outcome]))
    return Summary(sentence, parts, f"Next: thermoscope {step} {quote(called)}; --json FILE")


def _outcome_words(document: Mapping[str, Any]) -> list[str]:
    """What was found and what it leaves; of a step that was refused, or is not a finding, what became of it first."""
    if document["accepted"] and document["found"]:
        return [document["found"], document["strained"]]
    action, effect = document["action"], document["effect"]
    verb = {"calibrate": "Calibrated", "remove": f"{effect} taken out"}.get(action, f"{effect} added")
    if not document["accepted"] and not document["written"]:
        verb = f"Not accepted: {action} {effect or ''}".rstrip()
    return [f"{verb}: {document['why']}.", document["strained"]]


def _fixed(parameters: Sequence[Mapping[str, Any]]) -> Table:
    identifiable = sorted((p for p in parameters if p["identified"] and not p["of_measurement"]), key=effects_first)
    return parameters_table("What the data fixed (95 %)", map(in_words, identifiable))


def _unmeasured_words(places: Sequence[Mapping[str, Any]]) -> str:
    """Where no reading says whether the step is right: as many places as a line holds."""
    changes = [p for p in places if abs(p["after_C"] - p["before_C"]) >= CHANGE_K]
    text = ""
    for each in (f"{p['place']} {p['before_C']:.1f} -> {p['after_C']:.1f}" for p in changes):
        longer = f"{text}, {each}" if text else f"No sensor sees: {each}"
        if text and len(longer) > LINE:
            break
        text = longer
    return f"{text} degC" if text else ""


def _hidden_starts(parameters: Sequence[Mapping[str, Any]]) -> str:
    """Where what no sensor sees began, above the mean of what is read: as many as a sentence holds."""
    rows = [p for p in parameters if p["of_measurement"] and p["name"].startswith("start of ") and " in " in p["name"]]
    rows.sort(key=lambda p: -abs(p["value"]))
    each = [f"{p['name'].removeprefix('start of ')} {p['value']:+.1f} K" for p in rows]
    more = f" and {len(each) - FEW} more" if len(each) > FEW else ""
    where = "Initial temperatures by the fit, above the mean of the first readings"
    return f"{where}: {', '.join(each[:FEW])}{more}." if each else ""
