"""What the machine is made of: its parts in their own colours, whole, cut open, or pulled apart."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from viz import scene
from viz.callouts import Label, callouts
from viz.colours import LIGHT, Theme, heat, part_colours
from viz.cut import QUARTER, Surface, Wedge, cut_away, exposed
from viz.nodes import SplitMesh, on_nodes
from viz.scene import TITLE, Room, View
from viz.sight import anchors

if TYPE_CHECKING:
    import pyvista

Array = NDArray[np.float64]
GAP = 0.12  # between assemblies pulled apart, share of the machine's length


def regions(
    nodes: SplitMesh,
    *,
    wedge: Wedge | None = QUARTER,
    view: View | None = None,
    theme: Theme = LIGHT,
    title: str = "",
    png: str | Path | None = None,
) -> pyvista.Plotter:
    """The parts of the mesh, each in its colour and with its name."""
    p, view = scene.plotter(theme), view or View()
    surface = cut_away(nodes, wedge)
    _paint(p, surface, None, theme)
    scene.headline(p, title, theme)
    room = Room(0.2, 0.2, TITLE if title else 0.0)
    scene.look(p, surface.points, view, room)
    seen = anchors(surface, view, room)
    labels = [Label(tuple(xyz), nodes.parts[i], LIGHT.ink) for i, xyz in seen.items()]  # type: ignore[arg-type]
    callouts(p, labels, surface.points, view, theme, size=13)
    scene.save(p, png)
    return p


def exploded(
    nodes: SplitMesh,
    T: Array | None = None,
    *,
    groups: Sequence[Sequence[str]] | None = None,
    view: View | None = None,
    theme: Theme = LIGHT,
    png: str | Path | None = None,
) -> pyvista.Plotter:
    """The machine pulled apart along its axis; coloured by temperature (degC) if given, else by part.

    groups : parts that stay together, from left to right; by their names if not given
    """
    p = scene.plotter(theme)
    view = view or View(direction=(-1.0, 0.42, 0.42))
    shift = shifts(nodes, groups or assemblies(nodes.parts))
    surface = exposed(nodes, contacts=True)
    field = None if T is None else on_nodes(nodes, T)
    _paint(p, surface, field, theme, shift)
    if T is not None:
        scene.colour_bar(p, "°C", theme)
    scene.look(p, surface.points + shift[surface.owner], view, Room(right=0.1 if T is not None else 0.0))
    scene.save(p, png)
    return p


def assemblies(parts: Sequence[str]) -> list[list[str]]:
    """Left end, housing, stator, rotor, right end, from the names of the parts; empty groups are left out."""
    keys = ("flange.left bearing.left", "housing feet base", "", "rotor shaft commutator armature liner magnet",
            "flange.right bearing.right")  # fmt: skip
    groups: list[list[str]] = [[] for _ in keys]
    for part in parts:
        mine = next((i for i, words in enumerate(keys) if any(w in part for w in words.split())), 2)
        groups[mine].append(part)
    return [group for group in groups if group]


def shifts(nodes: SplitMesh, groups: Sequence[Sequence[str]]) -> Array:
    """(n_parts, 3) m: how far each part moves along the axis so that the groups stand one after the other."""
    shift = np.zeros((len(nodes.parts), 3))
    gap, end = GAP * np.ptp(nodes.points[:, 2]), None
    for group in groups:
        z = np.concatenate([nodes.points[nodes.of(part), 2] for part in group])
        move = 0.0 if end is None else end + gap - z.min()
        shift[[nodes.parts.index(part) for part in group], 2] = move
        end = z.max() + move
    return shift


def _paint(p: pyvista.Plotter, surface: Surface, T: Array | None, theme: Theme, shift: Array | None = None) -> None:
    data = scene.polydata(surface, shift)
    scene.outline(p, data, theme)
    light = {"ambient": 0.55, "diffuse": 0.5, "specular": 0.0, "culling": "back"}
    if T is None:
        rgb = np.array([_rgb(colour) for colour in part_colours(surface.nodes.parts).values()], np.uint8)
        data.cell_data["colour"] = rgb[surface.part]
        p.add_mesh(data, scalars="colour", rgb=True, **light)  # type: ignore[arg-type]
    else:
        data.point_data["T"] = surface.values(T)
        p.add_mesh(data, scalars="T", cmap=heat(), show_scalar_bar=False, **light)  # type: ignore[arg-type]


def _rgb(colour: str) -> tuple[int, ...]:
    return tuple(int(colour[i : i + 2], 16) for i in (1, 3, 5))
