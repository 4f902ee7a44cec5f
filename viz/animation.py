"""The machine warming up, as a moving picture."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from viz import field, scene
from viz.colours import LIGHT, Theme
from viz.cut import QUARTER, Wedge, cut_away
from viz.nodes import SplitMesh, on_nodes
from viz.scene import Room, View

Array = NDArray[np.float64]


def animate(
    nodes: SplitMesh,
    times: Sequence[float],
    fields: Array,
    path: str | Path,
    *,
    wedge: Wedge | None = QUARTER,
    view: View | None = None,
    theme: Theme = LIGHT,
    frames_per_second: float = 12.0,
) -> Path:
    """Write a .gif of fields (n_times, n_nodes) degC on one colour scale, the minute of the test in the corner."""
    path, T = Path(path), on_nodes(nodes, fields)
    if path.suffix != ".gif":
        raise InputError(f"cannot write '{path.suffix}'", str(path), "a file name that ends in .gif")
    if len(T) != len(times) or not len(T):
        raise InputError(f"{len(times)} times but {len(T)} fields", "animation", "one field per time")
    p, view = scene.plotter(theme, (960, 600)), view or View()
    surface = cut_away(nodes, wedge)
    data = field.paint(p, surface, T[0], (float(T.min()), float(T.max())), theme)
    scene.colour_bar(p, field.UNIT, theme)
    scene.look(p, surface.points, view, Room(right=0.12, top=scene.TITLE))
    pictures = []
    for time, values in zip(times, T, strict=True):
        data.point_data["T"] = surface.values(values)
        scene.headline(p, f"{time / 60:.0f} min", theme)
        pictures.append(np.asarray(p.screenshot(return_img=True)))
    p.close()
    return _write(path, pictures, frames_per_second)


def _write(path: Path, pictures: list[NDArray[np.uint8]], frames_per_second: float) -> Path:
    """A looping GIF with one palette, taken from the last and most colourful picture."""
    from PIL import Image

    path.parent.mkdir(parents=True, exist_ok=True)
    palette = Image.fromarray(pictures[-1]).quantize(255)
    frames = [Image.fromarray(one).quantize(palette=palette, dither=Image.Dither.NONE) for one in pictures]
    pause = round(1000 / frames_per_second)
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=pause, loop=0, optimize=False)
    return path
