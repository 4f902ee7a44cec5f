"""The temperature field of a machine, cut open.

field.cutaway(split(mesh), T, sensors=sensors, png="field.png")
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from viz import scene
from viz.callouts import Label, callouts
from viz.colours import LIGHT, VERDICT, Theme, heat
from viz.cut import QUARTER, Surface, Wedge, cut_away
from viz.data import Sensor, short
from viz.nodes import SplitMesh, on_nodes
from viz.scene import TITLE, Room, View
from viz.sight import covered, obstacle

if TYPE_CHECKING:
    import pyvista

Array = NDArray[np.float64]
UNIT = "°C"


def cutaway(
    nodes: SplitMesh,
    T: Array,
    *,
    wedge: Wedge | None = QUARTER,
    sensors: Sequence[Sensor] = (),
    title: str = "",
    limits: tuple[float, float] | None = None,
    view: View | None = None,
    theme: Theme = LIGHT,
    png: str | Path | None = None,
) -> pyvista.Plotter:
    """The machine with a wedge taken out, coloured by temperature (degC), 1280 x 800.

    T : (n_nodes,) per node of every part, or one per point of the conformal mesh
    limits : colour scale (degC), from the field itself if not given
    """
    p, view = scene.plotter(theme), view or View()
    surface = cut_away(nodes, wedge)
    paint(p, surface, on_nodes(nodes, T), limits, theme)
    scene.colour_bar(p, UNIT, theme)
    scene.headline(p, title, theme)
    scene.look(p, surface.points, view, _room(bool(sensors), title))
    _mark(p, surface, sensors, view, theme)
    scene.save(p, png)
    return p


def pair(
    nodes: SplitMesh,
    before: Array,
    after: Array,
    *,
    titles: tuple[str, str] = ("before", "after"),
    wedge: Wedge | None = QUARTER,
    view: View | None = None,
    theme: Theme = LIGHT,
    png: str | Path | None = None,
) -> pyvista.Plotter:
    """Two fields side by side on one colour scale."""
    fields = [on_nodes(nodes, before), on_nodes(nodes, after)]
    limits = min(f.min() for f in fields), max(f.max() for f in fields)
    p, view = scene.plotter(theme, (1280, 600), (1, 2)), view or View()
    surface = cut_away(nodes, wedge)
    for i, field in enumerate(fields):
        p.subplot(0, i)
        paint(p, surface, field, limits, theme)
        scene.headline(p, titles[i], theme)
        scene.look(p, surface.points, view, Room(0.0, 0.16))
    scene.colour_bar(p, UNIT, theme, position_x=0.84, width=0.09)
    scene.save(p, png)
    return p


def paint(
    p: pyvista.Plotter, surface: Surface, T: Array, limits: tuple[float, float] | None, theme: Theme
) -> pyvista.PolyData:
    """Add the surface coloured by nodal temperatures; its point data "T" may be changed afterwards."""
    data = scene.polydata(surface)
    data.point_data["T"] = surface.values(T)
    scene.outline(p, data, theme)
    p.add_mesh(
        data, scalars="T", cmap=heat(), clim=limits or (float(T.min()), float(T.max())), show_scalar_bar=False,
        ambient=0.8, diffuse=0.28, specular=0.0, interpolate_before_map=True, culling="back",
    )  # fmt: skip
    return data


def _room(labels: bool, title: str) -> Room:
    top = TITLE if title else 0.0
    return Room(0.16, 0.24, top) if labels else Room(0.0, 0.1, top)


def _mark(p: pyvista.Plotter, surface: Surface, sensors: Sequence[Sensor], view: View, theme: Theme) -> None:
    """Dots with labels; what lies behind or inside something is a hollow dot, and the picture says so."""
    if not sensors:
        return
    hidden = covered(obstacle(surface), np.array([s.xyz for s in sensors]), np.array(p.camera.position))
    labels = [_label(s, bool(h)) for s, h in zip(sensors, hidden, strict=True)]
    callouts(p, labels, surface.points, view, theme)
    if hidden.any():
        scene.footnote(p, "hollow dots lie inside or behind", theme)


def _label(sensor: Sensor, hidden: bool) -> Label:
    value = "" if sensor.residual_K is None else f"  {round(sensor.residual_K, 1) + 0.0:+.1f} K"
    return Label(sensor.xyz, f"{short(sensor.name)}{value}", VERDICT[sensor.verdict], hidden)
