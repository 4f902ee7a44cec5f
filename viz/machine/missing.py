"""Where heat is missing, on the machine: what the latent scan of a diagnosis would put into each part."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.errors import InputError
from validation.inference.missing_heat import is_located
from viz.colours import BLUE, LIGHT, VERMILION, Theme, missing, rounded
from viz.labels import signed
from viz.rendering import scene
from viz.rendering.callouts import Label, callouts, width
from viz.rendering.cut import QUARTER, Wedge, cut_away
from viz.rendering.ghost import anchors
from viz.rendering.nodes import SplitMesh
from viz.rendering.scene import NOTE, TITLE, Room, View

if TYPE_CHECKING:
    import pyvista

UNLIKELY = 10.0  # nats behind the likeliest place from which a place stays grey
SMALL = 13  # size of the labels
FAINT = 0.02  # of the largest heat: less is not labelled


def mean_heat(where: Sequence[Mapping[str, Any]], test: str) -> dict[str, float]:
    """Place -> mean missing heat (W) over a test, for the places within 10 nats of the likeliest."""
    if not where or test not in where[0]["heat"]:
        right = f"known: {', '.join(where[0]['heat'])}" if where else "a diagnosis made with `plan`"
        raise InputError(f"no missing heat for test '{test}'", "diagnosis", right)
    best = max(w["evidence_nats"] for w in where)
    near = [w for w in where if w["evidence_nats"] > best - UNLIKELY]
    return {w["place"]: float(np.mean(w["heat"][test]["heat_W"])) for w in near}


def placed(diagnosis: Mapping[str, Any]) -> bool:
    """Does the scan of a `diagnose` document put the missing heat somewhere, or could it be anywhere?"""
    best = max((w["evidence_nats"] for w in diagnosis.get("where", [])), default=0.0)
    return is_located(best)


def missing_in_machine(
    nodes: SplitMesh,
    where: Sequence[Mapping[str, Any]],
    test: str,
    *,
    wedge: Wedge | None = QUARTER,
    view: View | None = None,
    theme: Theme = LIGHT,
    png: str | Path | None = None,
) -> "pyvista.Plotter":
    """Parts coloured by the heat (W) that would have to enter them, below zero leave them; unlikely places are grey.

    Each place by itself, not together; its label says how much speaks for it (nats). The headline says when that is too
    little to locate the heat.

    where : as in a `diagnose` document;  test : whose mean is drawn
    """
    p, view, heat = scene.plotter(theme), view or View(), mean_heat(where, test)
    surface = cut_away(nodes, wedge)
    data, top = scene.polydata(surface), max(map(abs, heat.values()))
    watts = np.array([heat.get(part, np.nan) for part in nodes.parts])
    data.cell_data["W"] = watts[surface.part]
    scene.outline(p, data, theme)
    p.add_mesh(data, scalars="W", cmap=missing(), clim=rounded(-top, top), nan_color="#E4E8EC", **scene.FLAT)
    scene.colour_bar(p, "W", theme)
    unsure = "" if placed({"where": where}) else " (too little evidence to locate it)"
    scene.headline(p, f"Heat that the model misses, mean over {test}{unsure}", theme)
    scene.footnote(p, "at each place by itself, with its log odds (3 is twenty to one)", theme)
    nats = {w["place"]: w["evidence_nats"] for w in where}
    words = {n: f"{n}  {signed(q, 0)} W, {nats[n]:.0f}" for n, q in heat.items() if abs(q) > FAINT * top}
    wide = width(max(words.values(), key=len), SMALL)
    room = Room(0.02 + wide, 0.12 + wide, TITLE, NOTE)
    scene.look(p, surface.framed, view, room)
    anchor_points = {nodes.parts[i]: xyz for i, xyz in anchors(surface, view, room, surface.framed).items()}
    labels = [
        Label(tuple(anchor_points[n]), text, VERMILION if heat[n] > 0 else BLUE)  # type: ignore[arg-type]
        for n, text in words.items()
        if n in anchor_points
    ]
    callouts(p, labels, surface.framed, view, theme, size=SMALL)
    return scene.save(p, png)
