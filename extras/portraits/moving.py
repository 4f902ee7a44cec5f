"""The machine as it looks, warming up: slower to draw than viz.machine.animation, for pictures that are kept."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from extras.portraits.portrait import CAPTION, VIEW, Warm, staged
from thermoscope import plugin as th

RENDER_SIZE = (1080, 720)  # pixels; the film is a smaller copy, which smooths its letters


def moving(
    machine: th.MachineDescription,
    nodes: th.SplitMesh,
    fields: th.Array,
    path: Path,
    *,
    titles: Sequence[str],
    sensors: Sequence[Sequence[th.Sensor]],
    limits: tuple[float, float],
    width: int,
    frames_per_second: float,
    tell: Callable[[int], None] = lambda number: None,
) -> Path:
    """Write a .gif or .mp4 of fields (n, n_nodes) degC, with a title and a row of sensors each.

    limits : of the colours (degC);  width : in pixels
    """
    from PIL import Image

    T = th.on_nodes(nodes, fields)
    warm = Warm(nodes, T[0], limits)
    p, painted = staged(machine, warm, th.QUARTER, VIEW, th.LIGHT, RENDER_SIZE, th.Room(0.0, 0.1, th.TITLE, th.NOTE))
    th.scene.footnote(p, CAPTION, th.LIGHT)
    pulses, pictures = th.Pulses(p, th.cut_away(nodes), sensors[0]), []
    for number, (words, values, row) in enumerate(zip(titles, T, sensors, strict=True), 1):
        tell(number)
        for data, rows in painted:
            data.point_data["T"] = rows @ values
        pulses.show(row, number / frames_per_second)
        th.scene.headline(p, words, th.LIGHT, max(map(len, titles)))
        picture = Image.fromarray(np.asarray(p.screenshot(return_img=True)))
        small = picture.resize((width, width * RENDER_SIZE[1] // RENDER_SIZE[0]), Image.Resampling.LANCZOS)
        pictures.append(np.asarray(small))
    p.close()
    return th.WRITERS[path.suffix](path, pictures, frames_per_second)
