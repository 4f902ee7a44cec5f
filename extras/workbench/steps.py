"""The long calculations, as a process of their own runs them: arguments in, results out, progress by `tell`."""

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from extras.workbench.appearance import Appearance, appearance_of, at
from extras.workbench.jobs import Job
from thermoscope import plugin as th

if TYPE_CHECKING:
    from extras.workbench.dropped import Dropped
    from thermoscope import Network


NICENESS = 15  # a process of ours gives way to the browser, which draws what it has: a twentieth of its share


def first_appearance(folder: th.Folder, tell: th.Progress) -> Appearance:
    """The model as it was opened; its machine, for which a page waits, goes first."""
    _give_way()
    return appearance(folder, tell)


def appearance(folder: th.Folder, tell: th.Progress) -> Appearance:
    """The model as it stands."""
    tell("running the model on every test")
    return appearance_of(folder)


def machine_documents(folder: th.Folder, tell: th.Progress) -> Iterator[dict[str, Any]]:
    """The machine for the browser to draw, in two parts; limits of its sensors are known where errors are."""
    parts = th.viewer_documents(folder, tell)
    yield next(parts)
    _give_way()
    yield from parts


def _give_way() -> None:
    if hasattr(os, "nice"):
        os.nice(NICENESS)


def comparing_job(folder: th.Folder) -> Job:
    """What compares a model with every test, in a process of its own."""
    return Job(first_appearance, folder)


def drawing_job(folder: th.Folder) -> Job:
    """What draws the machine of a model, in a process of its own."""
    return Job(machine_documents, folder)


def searched(folder: th.Folder, tell: th.Progress) -> Mapping[str, Any]:
    """A `diagnose` document."""
    diagnosis = th.diagnose(folder.case, folder.settings.kinds, tell)
    return {"case": folder.case.name, "revision": folder.case.model.revision, **diagnosis.document()}


def stepped(
    folder: th.Folder, action: str, effect: str, tell: th.Progress
) -> tuple[th.StoredRevision, Mapping[str, Any], Appearance]:
    """Add or remove an effect, or calibrate: the step as model.toml keeps it, its document, the model after it."""
    if action == "calibrate":
        result = th.revise.calibrate(folder.case, progress=tell)
    elif action == "add":
        before = None if folder.stored is None else folder.stored.comparison
        result = th.revise.add(folder.case, effect, tell, before)
    else:
        result = th.revise.remove(folder.case, effect, tell)
    revision = th.recorded(result, th.evidence(folder, result))
    after = at(folder, folder.history.and_then(revision))
    look = appearance(after, tell)
    words = th.finding_words(after, look.errors) if action == "add" else ""
    return revision, {**result.document(), "found": words}, look


def recordings(files: Sequence[Path], network: "Network", tell: th.Progress) -> "Dropped":
    """What the columns of dropped files are taken for."""
    from extras.workbench.dropped import read

    return read(files, network, tell)


def machine(file: Path, folder: Path, tell: th.Progress) -> dict[str, Any]:
    """A machine file of another program as one of ours in a folder: what the page says of it."""
    tell(f"reading {file.name}")
    draft = th.import_draft(file)
    summary = th.import_summary(draft, th.write_import(draft, draft.toml(), folder))
    table = draft.table()
    rows = [[th.cell(value) for value in row] for row in table.rows]
    return {"words": f"{summary.sentence} {summary.more}", "columns": [*table.columns], "rows": rows}


def new_case(
    dropped: "Dropped", settings: th.Settings, network: "Network", tell: th.Progress
) -> tuple[th.Folder, Appearance]:
    """A new case of dropped files, opened, and its first comparison."""
    from extras.workbench.dropped import write

    folder = th.load_case(write(dropped, settings, network, tell), tell)
    return folder, appearance(folder, tell)


def reported(folder: th.Folder, tell: th.Progress) -> Path:
    """Write out/report.html with the last diagnosis there was."""
    return th.write_page(folder, str(folder.settings.path), folder.settings.out, tell)
