"""The temperature field of a machine, cut open.

field.cutaway(split(mesh), T, sensors=sensors, png="field.png")
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.arrays import Array
from viz.colours import LIGHT, Theme, heat, missing, power, rounded
from viz.data import LATE, Sensor
from viz.machine.thermocouples import LABELS, Marked, frame_points, label_texts, marked
from viz.rendering import scene
from viz.rendering.callouts import draw_on_top, label_room
from viz.rendering.cut import QUARTER, Surface, Wedge, cut_away
from viz.rendering.ghost import OPACITY, Ghosted
from viz.rendering.nodes import SplitMesh, on_nodes
from viz.rendering.scene import BAR, NOTE, TITLE, Room, View

if TYPE_CHECKING:
    import pyvista
    from matplotlib.colors import Colormap

UNIT = "°C"
PANELS = (1920, 560)  # pixels of three pictures side by side


def cutaway(
    nodes: SplitMesh,
    T: Array,
    *,
    wedge: Wedge | None = QUARTER,
    sensors: Sequence[Sensor] = (),
    labels: int = LABELS,
    title: str = "",
    limits: tuple[float, float] | None = None,
    colours: Colormap | None = None,
    unit: str = UNIT,
    note: str = "",
    view: View | None = None,
    theme: Theme = LIGHT,
    png: str | Path | None = None,
) -> pyvista.Plotter:
    """The machine with a wedge taken out, coloured by temperature (degC) or by another field in its unit, 1280 x 800.

    T : (n_nodes,) per node of every part, or one per point of the conformal mesh
    labels : of so many sensors, those furthest beyond their uncertainty first; the others are dots
    limits : colour scale (degC), from the field itself if not given; widened to round numbers
    note : what the sensors' labels say
    """
    view = view or View()
    room = room_for(label_texts(sensors, labels), title)
    p, surface, marks = cut_open(nodes, sensors, labels, room, wedge, view, theme)
    paint_cut(p, surface, marks.cut, on_nodes(nodes, T), limits, theme, colours)
    scene.colour_bar(p, unit, theme)
    scene.headline(p, title, theme)
    marks.draw(p, surface, view, theme, note if sensors else "")
    return scene.save(p, png)


def uncertainty(
    nodes: SplitMesh,
    half95: Array,
    *,
    sensors: Sequence[Sensor] = (),
    title: str = "",
    note: str = "",
    png: str | Path | None = None,
) -> pyvista.Plotter:
    """Half the width of the 95 % band (K), the darker the less sure; the scale begins at zero.

    half95 : (n_nodes,) K;  sensors : where it was measured
    """
    look: dict[str, Any] = {"limits": (0.0, float(np.max(half95))), "colours": power(), "unit": "± K"}
    return cutaway(nodes, half95, sensors=sensors, title=title, note=note, png=png, **look)


def cut_open(
    nodes: SplitMesh, sensors: Sequence[Sensor], labels: int, room: Room, wedge: Wedge | None, view: View, theme: Theme
) -> tuple[pyvista.Plotter, Surface, Marked]:
    """A scene that looks at the machine with a wedge taken out, what is left of it, its sensors as they are seen."""
    p, surface, by_weight = scene.plotter(theme), cut_away(nodes, wedge), sorted(sensors, key=lambda s: -s.weight)
    scene.look(p, frame_points(surface, sensors), view, room)
    return p, surface, marked(surface, by_weight, labels, np.array(p.camera.position))


def difference(
    nodes: SplitMesh,
    before: Array,
    after: Array,
    *,
    title: str = "",
    wedge: Wedge | None = QUARTER,
    view: View | None = None,
    theme: Theme = LIGHT,
    png: str | Path | None = None,
) -> pyvista.Plotter:
    """After minus before (K): vermilion where it became hotter, blue where colder."""
    change = on_nodes(nodes, after) - on_nodes(nodes, before)
    most = float(np.abs(change).max())
    look: dict[str, Any] = {"title": title, "wedge": wedge, "view": view, "theme": theme, "png": png}
    return cutaway(nodes, change, limits=(-most, most), colours=missing(), unit="K", **look)


def pair(
    nodes: SplitMesh,
    before: Array,
    after: Array,
    *,
    titles: tuple[str, str] = ("before", "after"),
    sensors: tuple[Sequence[Sensor], Sequence[Sensor]] = ((), ()),
    limits: tuple[float, float] | None = None,
    wedge: Wedge | None = QUARTER,
    view: View | None = None,
    theme: Theme = LIGHT,
    png: str | Path | None = None,
) -> pyvista.Plotter:
    """Two fields side by side on one colour scale, and after minus before (K) on its own.

    sensors : the same of either, with what the model misses, which stands beside the dots of the worst
    limits : of the scale (degC), those of both if not given
    """
    first, last = on_nodes(nodes, before), on_nodes(nodes, after)
    ends = limits or (min(first.min(), last.min()), max(first.max(), last.max()))
    most = float(np.abs(last - first).max())
    p, view, surface = scene.plotter(theme, PANELS, (1, 3)), view or View(), cut_away(nodes, wedge)
    room = Room(0.13, 0.26, TITLE, NOTE) if any(sensors) else Room(0.02, 0.16, TITLE)
    order = sorted(range(len(sensors[0])), key=lambda k: -max(row[k].weight for row in sensors))  # the same in both
    numbers = [[replace(row[k], name="") for k in order] for row in sensors]
    both = [(T, ends, heat(), row, words) for T, row, words in zip((first, last), numbers, titles, strict=True)]
    change = (last - first, (-most, most), missing(), (), "the change")
    for i, (field, T_limits, colours, row, words) in enumerate([*both, change]):
        p.subplot(0, i)
        scene.look(p, frame_points(surface, row), view, room)
        marks = marked(surface, row, LABELS, np.array(p.camera.position))
        paint_cut(p, surface, marks.cut, field, T_limits, theme, colours)
        if i:  # the first is on the scale of the second
            scene.colour_bar(p, UNIT if i == 1 else "K", theme, position_x=0.86, width=0.034)
        scene.headline(p, words, theme)
        marks.draw(p, surface, view, theme, LATE if row else "")
    return scene.save(p, png)


def machine_row(
    machines: Sequence[tuple[SplitMesh, Array, str]],
    *,
    wedge: Wedge | None = QUARTER,
    view: View | None = None,
    theme: Theme = LIGHT,
    png: str | Path | None = None,
) -> pyvista.Plotter:
    """Machines side by side, as large as each other and on one colour scale (degC).

    machines : each with a temperature per node of every part (n_nodes,), and a title
    """
    view, surfaces = view or View(), [cut_away(nodes, wedge) for nodes, _, _ in machines]
    fields = [on_nodes(nodes, T) for nodes, T, _ in machines]
    ends = min(T.min() for T in fields), max(T.max() for T in fields)
    width, height = PANELS[0] // 3 * len(machines), PANELS[1]
    middles = [0.5 * (s.framed.min(axis=0) + s.framed.max(axis=0)) for s in surfaces]
    reach = np.concatenate([s.framed - middle for s, middle in zip(surfaces, middles, strict=True)])
    p = scene.plotter(theme, (width, height), (1, len(machines)))
    for i, (surface, T, (_, _, words)) in enumerate(zip(surfaces, fields, machines, strict=True)):
        p.subplot(0, i)
        scene.look(p, middles[i] + reach, view, Room(0.02, 0.2, TITLE, NOTE))
        paint(p, surface, T, ends, theme)
        if i == len(machines) - 1:
            scene.colour_bar(p, UNIT, theme, position_x=0.86, width=0.034)
        scene.headline(p, words, theme, max(len(w) for _, _, w in machines))
    return scene.save(p, png)


def paint(
    p: pyvista.Plotter,
    surface: Surface,
    T: Array,
    limits: tuple[float, float] | None,
    theme: Theme,
    *,
    outlined: Surface | None = None,
    colours: Colormap | None = None,
) -> pyvista.PolyData:
    """Add the surface coloured by nodal values; its point data "T" may be changed afterwards.

    outlined : whose edges are drawn, if not the surface's own
    """
    data = scene.polydata(surface)
    data.point_data["T"] = surface.values(T)
    scene.outline(p, data if outlined is None else scene.polydata(outlined), theme)
    ends = rounded(*(limits or (float(T.min()), float(T.max()))))
    look: dict[str, Any] = {"specular": 0.0, "interpolate_before_map": True, **scene.FLAT}
    p.add_mesh(data, scalars="T", cmap=colours or heat(), clim=ends, **look)
    return data


def paint_cut(
    p: pyvista.Plotter,
    surface: Surface,
    cut: Ghosted,
    T: Array,
    limits: tuple[float, float] | None,
    theme: Theme,
    colours: Colormap | None = None,
) -> list[tuple[Surface, pyvista.PolyData]]:
    """Add a surface with its windows; what was painted, to be repainted."""
    import pyvista

    limits, out = limits or (float(T.min()), float(T.max())), []
    for one in cut.windows:
        rim = pyvista.lines_from_points(np.concatenate([one.rim, one.rim[:1]]))
        draw_on_top(p.add_mesh(rim, color=theme.ink, line_width=1.5, lighting=False), 1)
    if cut.ghost is not None:
        clear = scene.polydata(cut.ghost)
        clear.point_data["T"] = cut.ghost.values(T)
        look: dict[str, Any] = {"opacity": OPACITY, "lighting": False, "culling": "back", "show_scalar_bar": False}
        p.add_mesh(clear, scalars="T", cmap=colours or heat(), clim=rounded(*limits), **look)
        out.append((cut.ghost, clear))
    solid = paint(p, cut.solid, T, limits, theme, outlined=surface, colours=colours)  # last: a colour bar is of this
    out.append((cut.solid, solid))
    p.renderer.ResetCameraClippingRange()
    return out


def room_for(labels: Sequence[str], title: str, note: bool = False) -> Room:
    """Beside the machine for labels and a colour bar, above it for a title, below it for a footnote."""
    top, bottom = TITLE if title else 0.0, NOTE if labels or note else 0.0
    wide = label_room(labels, least=0.14) if labels else 0.0
    return Room(wide, wide + BAR, top, bottom)
