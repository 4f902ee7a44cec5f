"""thermoscope model add | remove CASE EFFECT@PLACE, thermoscope model undo CASE"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import isfinite
from shlex import quote
from typing import TYPE_CHECKING, Any

from geom.errors import InputError
from measured.sensors.faults import broken_channels
from thermoscope.case_folder.columns import checked_columns, write_columns
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.history import Revision, save_history
from thermoscope.case_folder.runs import at_revision, by_interest, ends, mean_rows
from thermoscope.commands.open_case import open_case_for_writing
from thermoscope.commands.stored_diagnosis import current_diagnosis
from thermoscope.console.answer import Answer, Grid, cell
from thermoscope.console.terminal import give, notes, progress
from validation.comparison.compare import errors
from validation.parameters.unknowns import strain_words

if TYPE_CHECKING:
    from validation.revision import revise

NO_EVENT = "thermoscope explain diagnose first: it found no event in these"
FEW = 4  # parameters named in a sentence
CHANGE_K = 1.0  # what a step has to move where no sensor is, to be told
LINE = 75  # letters, so that its unit still fits into 80


def add(case: str, effects: Sequence[str], anyway: bool, target: str | None) -> int:
    """Exit code 1, and nothing written, where what was left out is not predicted better.

    "event@N" is the likeliest explanation of the N-th event of the last diagnosis
    """
    from validation.revision.revise import add as added

    def step(folder: Folder, tell: Callable[[str], None]) -> revise.Revision:
        return added(folder.case, [meant(folder, effect) for effect in effects], tell)

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


def remove(case: str, effect: str, target: str | None) -> int:
    """Whatever the error does: taking a step back is the user's right."""
    from validation.revision.revise import remove as removed

    return revised(case, lambda folder, tell: removed(folder.case, effect, tell), True, target)


def undo(case: str, number: int | None, target: str | None) -> int:
    """One revision more, equal to the one before the last, or to `number`; nothing is forgotten."""
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
    give(document, target, lambda: Answer(sentence, [Grid("", ["test", "rms (K)"], rows)]))
    return 0


def revised(case: str, step: Callable[..., revise.Revision], anyway: bool, target: str | None) -> int:
    """Open, take the step, keep it if it is accepted, show it. `step` is given folder and progress."""
    with progress() as tell:
        folder = open_case_for_writing(case, tell)
        checked_columns(folder)
        notes(f"{f.words}; those readings are left out" for f in broken_channels(folder.case.tests))
        result = step(folder, tell)
    keep = result.worth_keeping or anyway
    if keep:
        longer = folder.history.and_then(recorded(result, evidence(folder, result)))
        save_history(folder.settings.model_file, longer, folder.history)
        write_columns(folder, longer.last.effects)
    places = unmeasured(folder, result)
    nuisance_words = strain_words(replace(folder.case, model=result.model))
    more = {"case": folder.case.name, "written": keep, "unmeasured": places, "strained": nuisance_words}
    document = {**result.document(), **more}
    give(document, target, lambda: answer(document, folder, case))
    return 0 if result.accepted or anyway else 1


def unmeasured(folder: Folder, result: revise.Revision) -> list[dict[str, Any]]:
    """Bodies without a sensor, the one that the step moved most first: at the end of the most telling test.

    Only those that losses heat; nobody limits the others.
    """
    test, network = by_interest(folder)[0], folder.case.model.network
    read = {c.place for t in folder.case.tests for c in t.channels}
    heated = set(network.heated)
    names = [n for n in mean_rows(network) if n in heated - read and network.places[n].kind in ("part", "node")]
    before, after = (ends(case, test, names) for case in (folder.case, replace(folder.case, model=result.model)))
    out = [
        {"place": n, "test": test.name, "before_C": a, "after_C": b}
        for n, a, b in zip(names, before, after, strict=True)
    ]
    return sorted(out, key=lambda p: -abs(p["after_C"] - p["before_C"]))


def recorded(result: revise.Revision, evidence: Mapping[str, float | str]) -> Revision:
    """A step as model.toml keeps it."""
    return Revision(
        0,
        result.action,
        tuple(e.name for e in result.model.effects),
        result.effect or "",
        dict(result.model.values),
        {p.name: p.ci95 for p in result.parameters},
        {t.name: (t.before, t.after) for t in result.tests if isfinite(t.before)},
        result.why,
        dict(evidence),
        reference=result.model.reference,
    )


def evidence(folder: Folder, result: revise.Revision) -> dict[str, float | str]:
    """What the last diagnosis of this very model said about the effect; empty when there was none."""
    diagnosis = current_diagnosis(folder) if result.action == "add" else None
    rows = [c for c in (diagnosis or {}).get("candidates", []) if c["effect"] == result.effect]
    return {key: rows[0][key] for key in ("probability", "score", "threshold", "decision")} if rows else {}


def telling(p: Mapping[str, Any]) -> tuple[bool, float]:
    """Sorts the effects' own amplitudes first, then what lies farthest from the middle of its prior."""
    low, high = p["prior"][1:]
    return "@" not in p["name"], -abs(p["value"] - p["prior"][0]) / max(high - low, 1e-300)


def named(p: Mapping[str, Any]) -> str:
    """A parameter the data cannot fix, with the one it trades with."""
    return f"{p['name']} (trades with {p['partner']})" if p["partner"] else str(p["name"])


def profiled(p: Mapping[str, Any]) -> str:
    """The profile's interval; an end in brackets is only the bound."""
    if p["profile"] is None:
        return ""
    ends = zip(p["profile"]["ci95"], p["profile"]["open"], strict=True)
    return " ... ".join(f"({cell(x)})" if is_open else cell(x) for x, is_open in ends)


def note(p: Mapping[str, Any]) -> str:
    return "at its bound" if p["at_bound"] else f"trades with {p['partner']}" if p["partner"] else ""


def answer(document: Mapping[str, Any], folder: Folder, called: str) -> Answer:
    """Whether it stands, the error before and after, and the values that the data fixed."""
    name = f"{document['action']} {document['effect'] or ''}".strip()
    verdict = "accepted" if document["accepted"] else "not accepted"
    where = f"written to {folder.settings.model_file} as revision {document['revision']}"
    outcome = where if document["written"] else "nothing written (--anyway writes it)"
    rows = [
        [t["name"], t["role"], t["rmse_K"]["before"], t["rmse_K"]["after"], t["fitted_rmse_K"]["after"]]
        for t in document["tests"]
    ]
    headers = ["test", "role", "error before (K)", "after (K)", "sensors as fitted (K)"]
    errors = Grid("", headers, rows, ["hold-out"], keep=headers[2:])
    failed = [f"FAILED  {c['check']}: {c['words']}" for c in document["checks"] if not c["passed"]]
    passed = [f"passed  {c['check']}: {c['words']}" for c in document["checks"] if c["passed"]]
    step = "explain diagnose" if document["action"] == "calibrate" else "test compare"
    parts: list[Grid | str] = [
        errors,
        *failed,
        _unmeasured_words(document["unmeasured"]),
        _hidden_starts(document["parameters"]),
        *passed,
        _fixed(document["parameters"]),
        _blind(document["parameters"]),
    ]
    return Answer(
        " ".join(filter(None, [document["strained"], f"{name}: {verdict}; {document['why']}; {outcome}."])),
        parts,
        f"Next: thermoscope {step} {quote(called)}; --json FILE",
    )


def _fixed(parameters: Sequence[Mapping[str, Any]]) -> Grid:
    identifiable = sorted((p for p in parameters if p["identified"] and not p["of_measurement"]), key=telling)
    rows = [[p["name"], p["value"], p["unit"], *p["ci95"], profiled(p), *p["prior"][1:], note(p)] for p in identifiable]
    headers = ["parameter", "value", "unit", "from", "to", "by profile", "prior from", "prior to", "note"]
    return Grid("What the data fixed (95 %)", headers, rows, keep=["value", "unit", "from", "to"])


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
    each = [f"{p['name'].removeprefix('start of ')} {p['value']:+.1f} K" for p in rows]
    more = f" and {len(each) - FEW} more" if len(each) > FEW else ""
    return f"Began off the mean of the first readings: {', '.join(each[:FEW])}{more}." if each else ""


def _blind(parameters: Sequence[Mapping[str, Any]]) -> str:
    blind = [named(p) for p in parameters if not p["identified"] and not p["of_measurement"]]
    few = f"{', '.join(blind[:FEW])}{', ...' if len(blind) > FEW else ''}"
    return f"The data do not fix {len(blind)} parameters: {few}" if blind else ""
