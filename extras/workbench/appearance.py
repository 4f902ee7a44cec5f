"""One model of a case as a tab sees it: its errors and curves, and the steps that led to it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from thermoscope import plugin as th


@dataclass(frozen=True)
class Appearance:
    """errors : a `compare` document;  curves : test -> readings and model"""

    errors: Mapping[str, Any]
    curves: Mapping[str, th.Comparison]

    @property
    def limits(self) -> dict[str, dict[str, float]]:
        """Test -> channel -> the largest error that counts as agreement (K)."""
        return {name: dict(comparison.limits) for name, comparison in self.curves.items()}

    def test(self, name: str) -> Mapping[str, Any]:
        """The errors of one test."""
        return next(t for t in self.errors["tests"] if t["name"] == name)


def appearance_of(folder: th.Folder) -> Appearance:
    """Run the model on every test, beside the plain models."""
    compared = folder.compared  # first: what it finds serves the curves
    plain = th.yardstick_document(folder.yardstick, compared, folder.case)
    errors = {**compared.document(), **plain, "strained": th.strain_words(folder.case)}
    return Appearance(errors, {test.name: th.comparison_of(folder, test) for test in folder.case.tests})


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
