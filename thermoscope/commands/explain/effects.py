"""thermoscope explain effects [CASE]"""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from geom.table import Table
from thermoscope.console.options import Json
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give, progress

if TYPE_CHECKING:
    from validation.effects.base import Effect, Scene

PLACES = 4  # named in a row of the table; all in --json


def effects(
    case: Annotated[str | None, typer.Argument(metavar="[CASE]", help="Say where each could sit in this case.")] = None,
    target: Json = None,
) -> int:
    """All effects the diagnosis knows: what each needs, where it could sit in a case, what the others lack."""
    from thermoscope.commands.open_case import open_case
    from validation.effects.registry import kinds
    from validation.parameters.unknowns import scene_of

    scene = None
    if case is not None:
        with progress() as tell:
            scene = scene_of(open_case(case, tell).case)
    document = {"case": case, "effects": [_described(kind, scene) for kind in kinds().values()]}
    give(document, target, lambda: effects_summary(document))
    return 0


def _described(kind: "type[Effect]", scene: "Scene | None") -> dict[str, Any]:
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
    return {**about, "places": list(kind.places(scene)), "missing": kind.lacking(scene)}


def effects_summary(document: Mapping[str, Any]) -> Summary:
    """Those that can sit in the case first, then what the others lack."""
    rows, case = document["effects"], document["case"]
    if case is None:
        sentence = f"{len(rows)} effects are known; with a CASE this says where each could sit in it."
        table = Table.of("", rows, "effect | what=title | sits at=sits | needs")
        return Summary(sentence, [table], "docs/reference/quantities.md")
    able, unable = ([e for e in rows if bool(e["places"]) == sits] for sits in (True, False))
    sentence = (
        f"{len(able)} of {len(rows)} effects can sit in {Path(case).name}, at "
        f"{sum(len(e['places']) for e in able)} places; {len(unable)} lack an input or a role."
    )
    lacking = Table.of(
        "Cannot sit here", unable, "effect | *missing | what=title", missing=lambda e: "; ".join(e["missing"])
    )
    sitting = Table.of("Can sit here", able, "effect | *places | what=title", places=lambda e: named(e["places"]))
    return Summary(sentence, [sitting, lacking], "--json FILE with tests that isolate them")


def named(places: list[str]) -> str:
    """The first few places, and how many more there are."""
    more = len(places) - PLACES
    return ", ".join(places[:PLACES]) + (f" and {more} more" if more > 0 else "")
