"""What the machine is made of: its parts in their own colours, whole, cut open, or pulled apart."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.arrays import Array
from geom.description.roles import Identity, Role
from viz.colours import LIGHT, Theme, heat, part_colours, rgb, rounded
from viz.rendering import scene
from viz.rendering.callouts import Label, callouts, label_room, text
from viz.rendering.cut import QUARTER, Surface, Wedge, cut_away, exposed
from viz.rendering.ghost import anchors
from viz.rendering.nodes import SplitMesh, on_nodes
from viz.rendering.scene import TITLE, Room, View

if TYPE_CHECKING:
    import pyvista

LETTERS = 13  # size of the names
GAP = 0.25  # between assemblies pulled apart, share of the machine's length
LONG = 1.5  # of the machine's length: with a longer base the machine would be small
ASIDE = View(direction=(-1.0, 0.3, 0.22))


def regions(
    nodes: SplitMesh,
    *,
    wedge: Wedge | None = QUARTER,
    view: View | None = None,
    mesh: bool = False,
    theme: Theme = LIGHT,
    title: str = "",
    png: str | Path | None = None,
) -> "pyvista.Plotter":
    """The parts, each in its colour and with its name.

    mesh : draw the edges of the mesh too; where it is cut, those of the cut tetrahedra
    """
    p, view = scene.plotter(theme), view or View()
    surface = cut_away(nodes, wedge)
    _paint(p, surface, None, theme, mesh=mesh)
    scene.headline(p, title, theme)
    wide = label_room(nodes.parts, LETTERS, 0.2)
    room = Room(wide, wide, TITLE if title else 0.0)
    scene.look(p, surface.framed, view, room)
    anchor_points = anchors(surface, view, room, surface.framed)
    labels = [Label(tuple(xyz), nodes.parts[i], LIGHT.ink) for i, xyz in anchor_points.items()]  # type: ignore[arg-type]
    callouts(p, labels, surface.framed, view, theme, size=LETTERS)
    return scene.save(p, png)


def exploded(
    nodes: SplitMesh,
    T: Array | None = None,
    *,
    groups: Sequence[Sequence[str]] | None = None,
    view: View | None = None,
    theme: Theme = LIGHT,
    title: str = "",
    limits: tuple[float, float] | None = None,
    png: str | Path | None = None,
) -> "pyvista.Plotter":
    """The machine pulled apart along its axis, each group under its names; coloured by temperature (degC) if given.

    limits : of the colours (degC), those of T if not given
    groups : parts that stay together, from left to right; by what they are if not given
    """
    p = scene.plotter(theme)
    view, groups = view or ASIDE, groups or assemblies(nodes)
    shift = shifts(nodes, groups)
    surface = exposed(nodes, contacts=True)
    members = [part for group in groups for part in group]
    surface = surface.only(np.isin(surface.part, [nodes.parts.index(part) for part in members])).compact()
    field = None if T is None else on_nodes(nodes, T)
    _paint(p, surface, field, theme, shift, limits=limits)
    if T is not None:
        scene.colour_bar(p, "°C", theme)
    points = nodes.points + shift[nodes.owner]
    without = [part for part in nodes.parts if part not in members]
    if without:
        scene.footnote(p, f"without {', '.join(without)}: longer than the machine", theme)
    for group in groups:
        _title(p, points[np.concatenate([nodes.of(part) for part in group])], group)
    scene.headline(p, title, theme)
    corners = points[np.concatenate([nodes.of(part) for part in members])]
    scene.look(p, corners, view, Room(right=0.1 if T is not None else 0.0, top=0.25))
    return scene.save(p, png)


def _title(p: "pyvista.Plotter", points: Array, group: Sequence[str]) -> None:
    """The names of a group above its middle."""
    low, high = points.min(axis=0), points.max(axis=0)
    at = np.array([(low[0] + high[0]) / 2, high[1] + 0.1 * (high[1] - low[1]), (low[2] + high[2]) / 2])
    names = text(" \n ".join(group), at, LIGHT.ink, 0, 12)
    names.GetTextProperty().SetVerticalJustificationToBottom()
    p.add_actor(names, reset_camera=False, pickable=False)


def assemblies(nodes: SplitMesh) -> list[list[str]]:
    """Left end, housing, stator, rotor, right end, from what the parts are; without empty groups and long bases."""
    groups: list[list[str]] = [[] for _ in range(5)]
    for part in nodes.parts:
        if part not in nodes.bases or np.ptp(nodes.points[nodes.of(part), 2]) < LONG * nodes.length:
            groups[_assembly(nodes, part)].append(part)
    return [group for group in groups if group]


def _assembly(nodes: SplitMesh, part: str) -> int:
    identity = nodes.identities.get(part, Identity())
    if identity.role in (Role.END_SHIELD, Role.BEARING):
        z = nodes.points[:, 2]
        return 0 if z[nodes.of(part)].mean() < (z.min() + z.max()) / 2 else 4
    if identity.role in (Role.HOUSING, Role.FOOT, Role.BASE):
        return 1
    return 3 if identity.turns else 2


def shifts(nodes: SplitMesh, groups: Sequence[Sequence[str]]) -> Array:
    """(n_parts, 3) m: how far each part moves along the axis so that the groups stand one after the other."""
    shift = np.zeros((len(nodes.parts), 3))
    gap, end = GAP * nodes.length, None
    for group in groups:
        z = np.concatenate([nodes.points[nodes.of(part), 2] for part in group])
        move = 0.0 if end is None else end + gap - z.min()
        shift[[nodes.parts.index(part) for part in group], 2] = move
        end = z.max() + move
    return shift


def _paint(
    p: "pyvista.Plotter",
    surface: Surface,
    T: Array | None,
    theme: Theme,
    shift: Array | None = None,
    mesh: bool = False,
    limits: tuple[float, float] | None = None,
) -> None:
    data = scene.polydata(surface, shift)
    scene.outline(p, data, theme)
    light: dict[str, Any] = {"ambient": 0.55, "diffuse": 0.5, "specular": 0.0, "culling": "back"}
    light |= {"show_edges": mesh, "edge_color": theme.ink, "edge_opacity": 0.45, "line_width": 1.0}
    if T is None:
        colours = np.array(
            [rgb(colour) for colour in part_colours(surface.nodes.parts, surface.nodes.identities).values()], np.uint8
        )
        data.cell_data["colour"] = colours[surface.part]
        p.add_mesh(data, scalars="colour", rgb=True, **light)
    else:
        data.point_data["T"] = surface.values(T)
        ends = rounded(*(limits or (float(T.min()), float(T.max()))))
        p.add_mesh(data, scalars="T", cmap=heat(), clim=ends, show_scalar_bar=False, **light)
