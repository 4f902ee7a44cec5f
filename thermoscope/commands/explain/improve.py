"""thermoscope explain improve CASE"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping, Sequence
from shlex import quote
from typing import TYPE_CHECKING, Any

from geom.text import visible
from thermoscope.case_folder.columns import checked_columns, write_columns
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.history import History, save_history
from thermoscope.case_folder.stored_yardstick import lacking_words, yardstick_document
from thermoscope.commands.explain.next_tests import next_tests
from thermoscope.commands.model.revise import recorded
from thermoscope.commands.open_case import open_case_for_writing
from thermoscope.commands.stored_diagnosis import save_diagnosis
from thermoscope.console.answer import Answer, Grid
from thermoscope.console.terminal import give, progress, value_with_interval
from viz.pages.next_tests import deciding

if TYPE_CHECKING:
    from validation.inference.result import Candidate, Diagnosis
    from validation.revision.revise import Revision


def improve(case: str, yes: bool, most: int, target: str | None) -> int:
    """Exit code 0 when the model ends adequate, 1 when it stops before. Every step is in model.toml at once."""
    from validation.revision.improvement import Supervisor, improve, singletons

    with progress() as tell:
        folder = open_case_for_writing(case, tell)
        checked_columns(folder)
        ledger = Ledger(folder)
        supervisor = Supervisor(singletons if yes else user_choice, ledger.keep)
        result = improve(folder.case, supervisor, most, tell, folder.settings.kinds)
    last = {"case": folder.case.name, "revision": ledger.history.last.number, **result.diagnosis.document()}
    save_diagnosis(folder, json.loads(json.dumps(last, default=float)))
    plain = yardstick_document(folder.yardstick, result.stairs[-1].comparison, result.case)
    document = {"case": folder.case.name, **result.document(), "written": ledger.written, **plain}
    give(document, target, lambda: answer(document, folder, case))
    return 0 if result.adequate else 1


class Ledger:
    """model.toml, one revision longer after every step; none of the earlier ones is touched."""

    def __init__(self, folder: Folder) -> None:
        self.folder, self.file, self.written = folder, folder.settings.model_file, 0
        self.history: History = folder.history

    def keep(self, step: Revision, evidence: Mapping[str, float | str]) -> None:
        self.history = save_history(self.file, self.history.and_then(recorded(step, evidence)), self.history)
        self.written += 1
        write_columns(self.folder, self.history.last.effects)


def user_choice(diagnosis: Diagnosis, choice: Sequence[Candidate]) -> str | None:
    """The user's word, on stderr and stdin: a number of the list, or nothing to stop."""
    lines = [f"  {i + 1}  {offer(c)}" for i, c in enumerate(choice)]
    print("\n".join(map(visible, [diagnosis.words, *lines])), file=sys.stderr)
    for further in deciding(diagnosis.document())[:3]:
        print(visible(f"  would decide: {further.kind} {further.what} ({further.hours:.3g} h)"), file=sys.stderr)
    print("add which? (number, or Enter to stop) ", end="", file=sys.stderr, flush=True)
    word = sys.stdin.readline().strip()
    return choice[int(word) - 1].effect if word.isdecimal() and 1 <= int(word) <= len(choice) else None


def offer(c: Candidate) -> str:
    """A candidate as the question shows it."""
    size = f"{value_with_interval(c.value, *c.ci95)} {c.unit}".removesuffix(" 1")
    fell = f", refitted {c.rmse_K[0]:.2f} -> {c.rmse_K[1]:.2f} K" if c.rmse_K else ""
    return f"{c.effect}: {c.title}, {size}, probability {100 * c.probability:.0f} %{fell}"


def answer(document: Mapping[str, Any], folder: Folder, called: str) -> Answer:
    """Why it ended, the error step by step, and what would decide if it stopped."""
    steps = document["stairs"]
    by_test = [f"{t['name']} ({t['role']}, K)" for t in steps[0]["tests"]]
    headers = ["step", *by_test, "all (K)", "sensors as fitted (K)", "probability"]
    rows = [
        [
            s["effect"] or s["step"],
            *(t["rmse_K"] for t in s["tests"]),
            s["rmse_K"],
            s["fitted_rmse_K"],
            s["evidence"].get("probability", ""),
        ]
        for s in steps
    ]
    errors = Grid("Error, step by step (rms)", headers, rows, keep=["all (K)", "sensors as fitted (K)", "probability"])
    destination = f"{document['written']} revisions written to {folder.settings.model_file}"
    outcome = destination if document["written"] else "nothing written"
    further = [] if document["adequate"] else next_tests(document["diagnosis"])
    more = f"thermoscope model undo {quote(called)} takes a step back; thermoscope show report {quote(called)}"
    plain = f"{document['yardstick']['sentence']} {lacking_words(document)}" if "yardstick" in document else ""
    return Answer(f"{document['verdict']}: {document['why']}; {outcome}.", [errors, plain, *further], more)
