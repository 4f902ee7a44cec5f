"""thermoscope explain improve CASE"""

import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any

import typer

from geom.table import Table, percent, with_interval
from geom.text import counted, visible
from thermoscope.case_folder.columns import checked_columns, write_columns
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.history import History, save_history
from thermoscope.case_folder.runs import added_words, finding_words
from thermoscope.case_folder.stored_comparison import yardstick_document, yardstick_words
from thermoscope.commands.model.revise import recorded
from thermoscope.commands.open_case import open_case_for_writing, save_diagnosis
from thermoscope.console.options import Case, Json
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give, notes, progress
from validation.parameters.unknowns import strain_words
from validation.tables import next_tests, offers

if TYPE_CHECKING:
    from validation.inference.result import Candidate, Diagnosis
    from validation.revision.revise import Revision


def improve(
    case: Case,
    yes: Annotated[
        bool, typer.Option("--yes", help="Do not ask; add what is sure, and what a free network needs.")
    ] = False,
    most: Annotated[int, typer.Option(min=1, help="Effects to add at most.")] = 6,
    target: Json = None,
) -> int:
    """Diagnose, ask, add, again, until the model is adequate. Exit code 1 if it stops before."""
    from validation.revision.improvement import Supervisor, improve as climb, singletons

    with progress() as tell:
        folder = open_case_for_writing(case, tell)
        checked_columns(folder)
        ledger = Ledger(folder)
        supervisor = Supervisor(singletons if yes else user_choice, ledger.keep, suggest=yes)
        try:
            result = climb(folder.case, supervisor, most, tell, folder.settings.kinds)
        except KeyboardInterrupt:
            ledger.show(case)
            raise
    number = ledger.history.last.number
    last = {"case": folder.case.name, "revision": number, **result.diagnosis.document(), "ended": result.why}
    save_diagnosis(folder, json.loads(json.dumps(last, default=float)))
    errors = result.stairs[-1].comparison
    plain = yardstick_document(folder.yardstick, errors, result.case)
    document = {"case": folder.case.name, **plain, **result.document(), "written": ledger.written}
    document["strained"] = strain_words(result.case)
    if any(step["effect"] for step in document["stairs"]):
        document["found"] = finding_words(replace(folder, case=result.case, history=ledger.history), errors.document())
    give(document, target, lambda: improvement_summary(document, folder, case))
    return 0 if result.adequate else 1


class Ledger:
    """model.toml, one revision longer after every step; none of the earlier ones is touched."""

    def __init__(self, folder: Folder) -> None:
        self.folder, self.file, self.written = folder, folder.settings.model_file, 0
        self.history: History = folder.history

    def keep(self, step: "Revision", evidence: Mapping[str, float | str]) -> None:
        self.history = save_history(self.file, self.history.and_then(recorded(step, evidence)), self.history)
        self.written += 1
        write_columns(self.folder, self.history.last.effects)

    def show(self, called: str) -> None:
        """The steps of an improvement that the user stopped, and that they stay; no document, which is of a whole."""
        steps = self.history.revisions[len(self.folder.history.revisions) :]
        rows = [[r.number, r.effect or r.action, name, *pair] for r in steps for name, pair in r.rmse_K.items()]
        grid = Table("As far as it came (rms)", ["revision", "step", "test", "before (K)", "after (K)"], rows)
        more = f"thermoscope explain improve {quote(called)} goes on from there"
        sentence = f"Stopped after {counted(len(steps), 'step')}; what the next one would be is not known yet."
        give({}, None, lambda: Summary(sentence, [grid] if rows else [], more))
        notes([f"stopped: {counted(self.written, 'revision')} written to {self.file} and kept"])


def user_choice(diagnosis: "Diagnosis", choice: "Sequence[Candidate]") -> str | None:
    """The user's word, on stderr and stdin: a number of the list, or nothing to stop."""
    lines = [f"  {i + 1}  {offer(c)}" for i, c in enumerate(choice)]
    print("\n".join(map(visible, [diagnosis.words, *lines])), file=sys.stderr)
    for further in offers(diagnosis.document())[:3]:
        print(
            visible(f"  would decide: {further['kind']} {further['what']} ({further['hours']:.3g} h)"), file=sys.stderr
        )
    print("add which? (number, or Enter to stop) ", end="", file=sys.stderr, flush=True)
    word = sys.stdin.readline().strip()
    return choice[int(word) - 1].effect if word.isdecimal() and 1 <= int(word) <= len(choice) else None


def offer(c: "Candidate") -> str:
    """A candidate as the question shows it."""
    size = f"{with_interval(c.value, *c.ci95)} {c.unit}".removesuffix(" 1")
    return f"{c.words}, {size}, odds {percent(c.probability)}"


def improvement_summary(document: Mapping[str, Any], folder: Folder, called: str) -> Summary:
    """Why it ended, the error step by step, and what would decide if it stopped."""
    from validation.revision.revise import TOGETHER

    steps, tests = document["stairs"], document["stairs"][0]["tests"]
    names = [f"{t['name']} ({t['role']}, K)" for t in tests]
    errors = Table.of(
        "Error, step by step (rms)",
        [{**s, **dict(zip(names, (t["rmse_K"] for t in s["tests"]), strict=True))} for s in steps],
        " | ".join(["step=name", *(f"{'*' * (t['role'] == 'hold-out')}{n}" for n, t in zip(names, tests, strict=True))])
        + " | *all (K)=rmse_K | *sensors as fitted (K)=fitted_rmse_K | *probability",
        name=lambda s: added_words(folder.case, s["effect"].split(TOGETHER)) if s["effect"] else s["step"],
        probability=lambda s: s["evidence"].get("probability", ""),
    )
    number, file = document["written"], folder.settings.model_file
    outcome = f"{counted(number, 'revision')} written to {file}" if number else "nothing written"
    further = [] if document["adequate"] else next_tests(document["diagnosis"])
    more = f"thermoscope model undo {quote(called)} takes a step back; thermoscope show report {quote(called)}"
    added = [s["effect"] for s in steps if s["effect"]]
    if added:  # the user knows the machine: what he doubts is asked again without it
        more += (
            f"; not so? thermoscope explain diagnose {quote(called)} --without {quote(added[-1].partition(' + ')[0])}"
        )
    why = document["why"]
    clauses = [
        document.get("yardstick", {}).get("warning", ""),
        document.get("found", ""),
        f"{why[:1].upper()}{why[1:]}; {outcome}.",
        document["strained"],
    ]
    sentence = " ".join(filter(None, clauses))
    refusals = Table.of("Tried and refused", document["refused"], "*what | *reason=why")
    laws = [f"As fitted: {words} (95 %)." for words in steps[-1]["laws"].values()]
    return Summary(sentence, [errors, *laws, yardstick_words(document), refusals, *further], more)
