"""thermoscope explain answer CASE yes|no"""

import re
from collections.abc import Mapping
from dataclasses import replace
from shlex import quote
from typing import Annotated

import typer

from geom.errors import InputError
from lumped.schemas.reader import suggestion
from measured.case import Test
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.history import save_history
from thermoscope.commands.open_case import last_diagnosis, open_case_for_writing
from thermoscope.console.options import Case, Json
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give, progress
from validation.effects import kinds
from validation.effects.time_window import checked, event

WORDS = {"yes": True, "y": True, "no": False, "n": False}


def answer(
    case: Case,
    word: Annotated[
        str, typer.Argument(metavar="yes|no|NAME", help="To what `diagnose` asked; or a boundary or sensor.")
    ],
    about: Annotated[str | None, typer.Option(metavar="NAME", help="Test, event or fault; else what it asked.")] = None,
    target: Json = None,
    size: Annotated[
        str | None, typer.Argument(metavar="[[REASON:] 0.3 K]", help="How well NAME is known, and why.")
    ] = None,
) -> int:
    """Answer what `diagnose` asked, or say how well a boundary or sensor is known; `undo` takes it back."""
    if size is not None:
        return narrow_doubt(case, word, size, target)
    if word.lower() not in WORDS:
        raise InputError(f"'{word}' is not an answer", "thermoscope explain answer", "yes or no")
    with progress() as tell:
        folder = open_case_for_writing(case, tell)
    yes, subject = WORDS[word.lower()], checked_subject(folder, about or open_question(folder))
    why = f"{subject}: {'yes' if yes else 'no'}"
    return _keep(folder, case, {subject: yes}, why, "The next diagnosis takes it as evidence", target)


def _keep(
    folder: Folder, case: str, answers: Mapping[str, bool | float], why: str, then: str, target: str | None
) -> int:
    step = replace(folder.history.last, action="answer", effect="", why=why, rmse_K={}, answers=answers)
    history = folder.history.and_then(step)
    save_history(folder.settings.model_file, history, folder.history)
    document = {"case": folder.case.name, "revision": history.last.number, "answers": dict(history.last.answers)}
    sentence = f"Revision {history.last.number}: {why}. {then}."
    give(document, target, lambda: Summary(sentence, more=f"Next: thermoscope explain diagnose {quote(case)}"))
    return 0


def narrow_doubt(case: str, name: str, size: str, target: str | None) -> int:
    """How well a boundary or a sensor is known, as a step of the history with its reason."""
    with progress() as tell:
        folder = open_case_for_writing(case, tell)
    reason, _, number = size.rpartition(":")
    tests = folder.case.tests
    sigma = {f"bias:{c.name}": c.sigma_K for t in tests for c in t.channels if c.name == name}
    usual = sigma or {f"boundary:{b}": folder.case.doubt["boundary"] for t in tests for b in t.boundaries if b == name}
    if not usual:
        names = sorted({b for t in tests for b in t.boundaries} | {c.name for t in tests for c in t.channels})
        what = f"'{name}' is neither a boundary nor a sensor"
        raise InputError(what, "thermoscope explain answer", suggestion(name, names))
    (subject, widest), where = next(iter(usual.items())), f"thermoscope explain answer {name} '{size}'"
    match = re.fullmatch(r"\s*([0-9.]+(?:e-?[0-9]+)?)\s*K?\s*", number)
    if not match:
        raise InputError(f"'{number.strip()}' is not a temperature difference", where, "for example 0.3 K")
    sd = float(match[1])
    if not 0.0 < sd <= widest:
        right = f"above 0 and up to {widest:g} K, which is usual; [doubt] and sigma_K in the files widen"
        raise InputError(f"{sd:g} K does not narrow the doubt of {name}", where, right)
    why = f"{name} is known to {sd:g} K" + f": {reason.strip()}" * bool(reason.strip())
    return _keep(folder, case, {subject: sd}, why, "The next calibration and diagnosis take it so", target)


def open_question(folder: Folder) -> str:
    """What the last diagnosis asked about."""
    question = (last_diagnosis(folder) or {}).get("question")
    if not question:
        right = "thermoscope explain diagnose first, or --about a test, an event or a fault"
        raise InputError("the last diagnosis asked nothing", f"case '{folder.case.name}'", right)
    return str(question["about"])


def _fault(about: str, tests: Mapping[str, Test]) -> bool:
    """Is it a fault of one of the sensors, or an effect, at a place?"""
    kind, at, place = about.partition("@")
    channels = {c.name for t in tests.values() for c in t.channels}
    return bool(at) and (place in channels or kind in kinds())


def checked_subject(folder: Folder, about: str) -> str:
    """A test, an event inside the tests, a fault, or an input."""
    tests, window = {t.name: t for t in folder.case.tests}, event(about)
    if window:
        for test in window.tests:
            if test not in tests:
                raise InputError(f"unknown test '{test}'", f"--about {about}", f"known: {', '.join(tests)}")
            checked(window, test, float(tests[test].time[0]), float(tests[test].time[-1]), f"--about {about}")
    elif about not in tests and not _fault(about, tests) and not any(about in t.inputs for t in tests.values()):
        right = f"one of {', '.join(tests)}, or as asked"
        raise InputError(f"'{about}' is not a test, event or fault", "--about", right)
    return about
