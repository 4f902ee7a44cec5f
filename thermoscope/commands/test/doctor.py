"""thermoscope test doctor CASE, thermoscope test quantities"""

from collections.abc import Sequence
from pathlib import Path

from geom.errors import InputError
from geom.table import Table
from geom.text import counted
from measured.recordings.readings import read_test
from measured.recordings.units import MEMORY_UNIT, QUANTITIES
from thermoscope.case_folder.doctor import examined
from thermoscope.case_folder.folder import find_case, network_of, patient_of
from thermoscope.case_folder.history import load_history
from thermoscope.case_folder.recording_checks import Finding
from thermoscope.case_folder.settings import read_settings
from thermoscope.console.options import Case, Json
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import Progress, give, progress


def doctor(case: Case, target: Json = None) -> int:
    """What looks wrong in a case's files before anything is fitted, with the cure. Exit code 1 if something does."""
    with progress() as tell:
        path = find_case(case)
        wrong, doubts = looked(path, tell)
    rows = {name: [f.document() for f in some] for name, some in (("wrong", wrong), ("doubts", doubts))}
    document = {"case": path.resolve().name, **rows}
    give(document, target, lambda: doctor_summary(wrong, doubts, case))
    return 2 if wrong else 1 if any(not f.remark for f in doubts) else 0


def looked(path: Path, tell: Progress) -> tuple[list[Finding], tuple[Finding, ...]]:
    """What would be refused, test by test, and what is only doubtful."""
    settings = read_settings(path)
    load_history(settings.model_file)
    network, _ = network_of(settings, tell)
    wrong, good = [], []
    for entry in settings.tests:
        tell(f"looking at {entry.name}")
        try:
            one = patient_of(entry)
            read_test(entry.name, entry.role, one.samples, one.sheet, network, settings.sample_s)
            good.append(one)
        except InputError as fault:
            wrong.append(Finding(entry.name, fault.where.removeprefix(f"{settings.path}/"), fault.what, fault.right))
    return wrong, examined(good, network)


def doctor_summary(wrong: Sequence[Finding], doubts: Sequence[Finding], case: str) -> Summary:
    """What would be refused first; a line for each finding and its cure."""
    remarks = sum(f.remark for f in doubts)
    doubtful = len(doubts) - remarks
    things, look = ("thing", "looks") if doubtful == 1 and not wrong else ("things", "look")
    refused = f"{len(wrong)} would be refused, " if wrong else ""
    sentence = f"{refused}{doubtful} {things} {look} wrong" if wrong or doubtful else "Nothing looks wrong"
    sentence += f"; {counted(remarks, 'note')}, perhaps as you meant it." if remarks else "."
    lines = [
        f"{word}{', '.join(filter(None, (f.test, f.where))) or 'all'}: {f.what.removesuffix('?')}. Cure: {f.cure}"
        for word, rows in (("REFUSED ", wrong), ("", doubts))
        for f in rows
    ]
    return Summary(sentence, lines, f"--json FILE; next: thermoscope test compare {case}")


def quantities(target: Json = None) -> int:
    """What a column may measure, in which units, and what memory holds."""
    rows = [
        {"quantity": name, "units": list(q.units), "held_as": MEMORY_UNIT[name], "input": q.feeds}
        for name, q in QUANTITIES.items()
    ]
    table = Table.of("", rows, "quantity | units | held as=held_as | input it drives=input")
    sentence = f"A column measures one of {len(rows)} quantities; other units of the same dimension are read as well."
    give({"quantities": rows}, target, lambda: Summary(sentence, [table], "docs/reference/quantities.md"))
    return 0
