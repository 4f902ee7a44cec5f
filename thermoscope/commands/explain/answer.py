"""thermoscope explain answer CASE yes|no"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated

import typer

from geom.errors import InputError
from measured.case import Test
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.history import save_history
from thermoscope.commands.open_case import open_case_for_writing
from thermoscope.commands.stored_diagnosis import last_diagnosis
from thermoscope.console.options import Case, Json
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give, progress
from validation.effects import kinds
from validation.effects.time_window import checked, event

WORDS = {"yes": True, "y": True, "no": False, "n": False}


def answer(
    case: Case,
    word: Annotated[str, typer.Argument(metavar="yes|no", help="To the question that `diagnose` ended with.")],
    about: Annotated[str | None, typer.Option(metavar="NAME", help="Test, event or fault; else what it asked.")] = None,
    target: Json = None,
) -> int:
    """Summary what `diagnose` asked; the next diagnosis takes it as evidence, `undo` takes it back."""
    if word.lower() not in WORDS:
        raise InputError(f"'{word}' is no answer", "thermoscope explain answer", "yes or no")
    with progress() as tell:
        folder = open_case_for_writing(case, tell)
    yes, subject = WORDS[word.lower()], checked_subject(folder, about or open_question(folder))
    why = f"{subject}: {'yes' if yes else 'no'}"
    step = replace(folder.history.last, action="answer", effect="", why=why, rmse_K={}, answers={subject: yes})
    history = folder.history.and_then(step)
    save_history(folder.settings.model_file, history, folder.history)
    document = {"case": folder.case.name, "revision": history.last.number, "answers": dict(history.last.answers)}
    sentence = f"Revision {history.last.number}: {why}. The next diagnosis takes it as evidence."
    give(document, target, lambda: Summary(sentence, more=f"Next: thermoscope explain diagnose {case}"))
    return 0


def open_question(folder: Folder) -> str:
    """What the last diagnosis asked about."""
    question = (last_diagnosis(folder) or {}).get("question")
    if not question:
        raise InputError(
            "the last diagnosis asked nothing",
            f"case '{folder.case.name}'",
            "thermoscope explain diagnose first, or --about a test, an event or a fault",
        )
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
        raise InputError(f"'{about}' is no test, event or fault", "--about", f"one of {', '.join(tests)}, or as asked")
    return about
