"""The model's history as one tab sees it: the steps that still count."""

from __future__ import annotations

from dataclasses import replace

from thermoscope.plugin import Folder, History, at_revision
from thermoscope.plugin import StoredRevision as Revision


def at(folder: Folder, history: History) -> Folder:
    """The case with the model that `history` ends with."""
    return replace(folder, case=at_revision(folder, history.last), history=history)


def same(a: Revision, b: Revision) -> bool:
    """The same model, however it came about."""
    return a.effects == b.effects and dict(a.values) == dict(b.values)


def effective(history: History) -> list[Revision]:
    """The steps that led to the model, without those taken back; the declared model first."""
    out = [Revision(0, "calibrate")]
    for revision in history.revisions:
        back = next((i for i, r in enumerate(out) if same(r, revision)), None)
        if revision.action == "step back" and back is not None:
            out = out[: back + 1]
        else:
            out.append(revision)
    return out


def undone(history: History) -> History | None:
    """One revision more, equal to the model before the last step that still counts; None at the declared model."""
    steps = effective(history)
    return history.back_to(steps[-2].number) if len(steps) > 1 else None
