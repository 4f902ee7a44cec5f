"""thermoscope add | remove CASE EFFECT@PLACE, thermoscope calibrate CASE"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from thermoscope.commands.opened import opened_to_write
from thermoscope.commands.saved import saved_diagnosis
from thermoscope.folder import Folder
from thermoscope.history import Revision, save_history
from thermoscope.terminal import give, progress, say, table

if TYPE_CHECKING:
    from validation import revise

ROWS = 12


def add(case: str, effect: str, anyway: bool, target: str | None) -> int:
    """Exit code 1, and nothing written, when the error on tests that were not fitted does not fall."""
    from validation.revise import add as added

    return _revised(case, lambda folder, tell: added(folder.case, effect, progress=tell), anyway, target)


def remove(case: str, effect: str, target: str | None) -> int:
    """Whatever the error does: taking a step back is the user's right."""
    from validation.revise import remove as removed

    return _revised(case, lambda folder, tell: removed(folder.case, effect, progress=tell), True, target)


def calibrate(case: str, anyway: bool, target: str | None) -> int:
    """Exit code 1, and nothing written, when the fit does not converge."""
    from validation.revise import calibrate as fitted

    return _revised(case, lambda folder, tell: fitted(folder.case, progress=tell), anyway, target)


def _revised(case: str, step: Callable[..., revise.Revision], anyway: bool, target: str | None) -> int:
    with progress() as tell:
        folder = opened_to_write(case, tell)
        result = step(folder, tell)
    keep = result.accepted or anyway
    if keep:
        save_history(folder.settings.model_file, folder.history.and_then(recorded(result, evidence(folder, result))))
    document = {**result.document(), "case": folder.case.name, "written": keep}
    give(document, target, lambda: show(document, folder))
    return 0 if keep else 1


def recorded(result: revise.Revision, evidence: Mapping[str, float | str]) -> Revision:
    """A step as model.toml keeps it."""
    return Revision(
        0, result.action, tuple(e.name for e in result.model.effects), result.effect or "",
        dict(result.model.values), {p.name: p.ci95 for p in result.parameters},
        {t.name: (t.before, t.after) for t in result.tests}, result.why, dict(evidence),
    )  # fmt: skip


def evidence(folder: Folder, result: revise.Revision) -> dict[str, float | str]:
    """What the last diagnosis of this very model said about the effect; empty when there was none."""
    found = saved_diagnosis(folder) if result.action == "add" else None
    rows = [c for c in (found or {}).get("candidates", []) if c["effect"] == result.effect]
    return {key: rows[0][key] for key in ("score", "threshold", "decision")} if rows else {}


def telling(p: Mapping[str, Any]) -> tuple[bool, float]:
    """Sorts the effects' own amplitudes first, then what lies farthest from the middle of its prior."""
    low, high = p["prior"][1:]
    return "@" not in p["name"], -abs(p["value"] - p["prior"][0]) / max(high - low, 1e-300)


def show(document: Mapping[str, Any], folder: Folder) -> None:
    """The error before and after, and the values that the data fixed."""
    rows = [[t["name"], t["role"], t["rmse_K"]["before"], t["rmse_K"]["after"]] for t in document["tests"]]
    name = f"{document['action']} {document['effect'] or ''}".strip()
    table(f"{name}: error per test", ["test", "role", "before (K)", "after (K)"], rows, marked=["hold-out"])
    seen = sorted((p for p in document["parameters"] if p["identified"] and " of " not in p["name"]), key=telling)
    blind = [p["name"] for p in document["parameters"] if not p["identified"] and " of " not in p["name"]]
    values = [[p["name"], p["value"], p["unit"], *p["ci95"], *p["prior"][1:]] for p in seen[:ROWS]]
    if values:
        table("What the data fixed", ["parameter", "value", "unit", "from", "to", "prior from", "prior to"], values)
    if blind:
        say(f"the data do not fix {len(blind)} parameters: {', '.join(blind[:6])}{', ...' if len(blind) > 6 else ''}")
    verdict = "accepted" if document["accepted"] else "not accepted"
    where = f"written to {folder.settings.model_file} as revision {document['revision']}"
    say(f"{verdict}: {document['why']}; {where if document['written'] else 'nothing written (--anyway writes it)'}")
