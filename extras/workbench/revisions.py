"""The model's history as one tab sees it: the steps that still count."""

from __future__ import annotations

from dataclasses import replace

from thermoscope import plugin as th


def at(folder: th.Folder, history: th.History) -> th.Folder:
    """The case with the model that `history` ends with."""
    return replace(folder, case=th.at_revision(folder, history.last), history=history)


def same(a: th.StoredRevision, b: th.StoredRevision) -> bool:
    """The same model, however it came about."""
    return a.effects == b.effects and dict(a.values) == dict(b.values)


def effective(history: th.History) -> list[th.StoredRevision]:
    """The steps that led to the model, without those taken back; the declared model first."""
    out = [th.StoredRevision(0, "calibrate")]
    for revision in history.revisions:
        back = next((i for i, r in enumerate(out) if same(r, revision)), None)
        if revision.action == "step back" and back is not None:
            out = out[: back + 1]
        else:
            out.append(revision)
    return out


def undone(history: th.History) -> th.History | None:
    """One revision more, equal to the model before the last step that still counts; None at the declared model."""
    steps = effective(history)
    return history.back_to(steps[-2].number) if len(steps) > 1 else None
