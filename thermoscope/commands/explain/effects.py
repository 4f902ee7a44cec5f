"""thermoscope explain effects [CASE], thermoscope test quantities"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lumped.model.quantities import INPUTS
from measured.recordings.units import MEMORY_UNIT, QUANTITIES
from thermoscope.console.answer import Answer, Grid
from thermoscope.console.terminal import give, progress

if TYPE_CHECKING:
    from validation.effects.base import Effect, Scene

PLACES = 4  # named in a row of the table; all in --json


def effects(case: str | None, target: str | None) -> int:
    """Every kind of effect: what it needs, and in a case where it could sit or what is missing."""
    from thermoscope.commands.open_case import open_case
    from validation.effects.registry import kinds
    from validation.parameters.unknowns import scene_of

    scene = None
    if case is not None:
        with progress() as tell:
            scene = scene_of(open_case(case, tell).case)
    document = {"case": case, "effects": [_described(kind, scene) for kind in kinds().values()]}
    give(document, target, lambda: answer(document))
    return 0


def _described(kind: type[Effect], scene: Scene | None) -> dict[str, Any]:
    about = {
        "effect": kind.kind,
        "title": kind.title,
        "sits": kind.sits,
        "needs": list(kind.needs),
        "unit": kind.unit,
        "typical": list(kind.typical),
        "fault": kind.fault,
        "isolating_test": kind.isolating_test,
        "source": kind.source,
    }
    if scene is None:
        return about
    inputs = [q for q in kind.needs if q not in scene.recorded]
    suited = list(kind.candidate_places(scene))
    missing = [*(f"a column of {q} (input {INPUTS.get(q, q)})" for q in inputs), *([] if suited else [kind.sits])]
    return {**about, "places": list(kind.places(scene)), "missing": missing}


def answer(document: Mapping[str, Any]) -> Answer:
    """Those that can sit in the case first, then what the others lack."""
    rows = document["effects"]
    if document["case"] is None:
        catalogue = [[e["effect"], e["title"], e["sits"], ", ".join(e["needs"])] for e in rows]
        sentence = f"{len(rows)} effects are known; with a CASE this says where each could sit in it."
        return Answer(
            sentence, [Grid("", ["effect", "what", "sits at", "needs"], catalogue)], "docs/reference/quantities.md"
        )
    able = [e for e in rows if e["places"]]
    unable = [e for e in rows if not e["places"]]
    places = sum(len(e["places"]) for e in able)
    sentence = (
        f"{len(able)} of {len(rows)} effects can sit in {Path(document['case']).name}, at {places} places; "
        f"{len(unable)} lack an input or a role."
    )
    lacking = [[e["effect"], "; ".join(e["missing"]), e["title"]] for e in unable]
    sitting = [[e["effect"], named(e["places"]), e["title"]] for e in able]
    parts = [
        Grid("Cannot sit here", ["effect", "missing", "what"], lacking, keep=["missing"]),
        Grid("Can sit here", ["effect", "places", "what"], sitting, keep=["places"]),
    ]
    return Answer(sentence, parts[::-1], "--json FILE with tests that isolate them")


def named(places: list[str]) -> str:
    """The first few places, and how many more there are."""
    more = len(places) - PLACES
    return ", ".join(places[:PLACES]) + (f" and {more} more" if more > 0 else "")


def quantities(target: str | None) -> int:
    """What a column may measure, its units, and what memory holds."""
    rows = [
        {"quantity": name, "units": list(q.units), "held_as": MEMORY_UNIT[name], "input": q.feeds}
        for name, q in QUANTITIES.items()
    ]
    document = {"quantities": rows}
    give(document, target, lambda: show_quantities(rows))
    return 0


def show_quantities(rows: list[dict[str, Any]]) -> Answer:
    """A row per quantity."""
    body = [[r["quantity"], ", ".join(r["units"]), r["held_as"], r["input"]] for r in rows]
    sentence = f"A column measures one of {len(rows)} quantities; other units of the same dimension are read as well."
    return Answer(
        sentence, [Grid("", ["quantity", "units", "held as", "input it drives"], body)], "docs/reference/quantities.md"
    )
