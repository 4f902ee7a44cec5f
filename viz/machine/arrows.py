"""Heat flux in the solid parts: arrows on the cut faces."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from geom.arrays import Array
from viz.colours import LIGHT, Theme
from viz.machine.field import UNIT, paint
from viz.rendering import scene
from viz.rendering.callouts import draw_on_top
from viz.rendering.cut import QUARTER, Wedge, cut_away
from viz.rendering.flux import HasTensor, heat_flux
from viz.rendering.nodes import SplitMesh, on_nodes
from viz.rendering.scene import TITLE, Room, View

if TYPE_CHECKING:
    import pyvista

SPACING = 0.045  # of the machine's length, between arrows
LONGEST = 0.075  # of the machine's length
SHORTEST = 0.02  # of the largest flux: smaller ones are left out


def flux_arrows(
    nodes: SplitMesh,
    T: Array,
    conductivity: Mapping[str, HasTensor],
    *,
    wedge: Wedge = QUARTER,
    title: str = "",
    limits: tuple[float, float] | None = None,
    view: View | None = None,
    theme: Theme = LIGHT,
    png: str | Path | None = None,
) -> "pyvista.Plotter":
    """The field cut open, with arrows along the heat flux in both cut faces; their length grows with its root.

    limits : of the colours (degC), those of T if not given
    """
    p, view, T = scene.plotter(theme), view or View(), on_nodes(nodes, T)
    surface = cut_away(nodes, wedge)
    paint(p, surface, T, limits, theme)
    at, flux = on_faces(nodes, heat_flux(nodes, T, conductivity), wedge)
    scene.colour_bar(p, UNIT, theme)  # of what was added last, so before the arrows
    _arrows(p, at, flux, nodes.length, theme)
    largest = float(np.linalg.norm(flux, axis=1).max(initial=0.0))
    scene.headline(p, f"{title} longest arrow {largest / 1000:.3g} kW/m²".strip(), theme)
    scene.look(p, surface.framed, view, Room(0.0, 0.1, TITLE))
    return scene.save(p, png)


def on_faces(nodes: SplitMesh, flux: Array, wedge: Wedge) -> tuple[Array, Array]:
    """Points (n, 3) m in both cut faces, one per cell of a grid, and the mean flux there (n, 3) W/m2, in the face."""
    step = SPACING * nodes.length
    points: list[Array] = []
    arrows: list[Array] = []
    middle = nodes.points[nodes.tets].mean(axis=1)
    for edge in wedge.edges():
        normal = np.cross(edge, [0.0, 0.0, 1.0])
        near = (np.abs(middle @ normal) < step / 2) & (middle @ edge > 0)
        cell = np.floor(np.stack([middle[near] @ edge, middle[near, 2]], 1) / step).astype(int)
        _, group = np.unique(np.column_stack([cell, nodes.region[near]]), axis=0, return_inverse=True)
        count = np.bincount(group.ravel())
        for values, out in ((middle[near], points), (flux[near], arrows)):
            mean = np.stack([np.bincount(group.ravel(), values[:, k]) / count for k in range(3)], axis=1)
            out.append(mean - (mean @ normal)[:, None] * normal)
    return np.concatenate(points), np.concatenate(arrows)


def _arrows(p: "pyvista.Plotter", at: Array, flux: Array, length: float, theme: Theme) -> None:
    import pyvista

    size = np.linalg.norm(flux, axis=1)
    long = size > SHORTEST * size.max(initial=0.0)
    cloud = pyvista.PolyData(at[long])
    cloud["flux"] = flux[long] / size[long][:, None]
    cloud["length"] = np.sqrt(size[long] / size.max(initial=1.0))
    arrow = pyvista.Arrow(shaft_radius=0.06, tip_radius=0.16, tip_length=0.35)
    shapes = cloud.glyph(orient="flux", scale="length", factor=LONGEST * length, geom=arrow)
    draw_on_top(p.add_mesh(shapes, color=theme.ink, lighting=False, show_scalar_bar=False), 1)
