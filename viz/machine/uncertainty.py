"""How sure the model is, painted on the machine: the half width of its 95 % band."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from viz.colours import LIGHT, Theme, power
from viz.data import Sensor
from viz.machine.field import cut_open, paint_cut, room_for
from viz.machine.thermocouples import LABELS, label_texts
from viz.rendering import scene
from viz.rendering.cut import QUARTER, Wedge
from viz.rendering.nodes import SplitMesh, on_nodes
from viz.rendering.scene import View

if TYPE_CHECKING:
    import pyvista

Array = NDArray[np.float64]


def uncertainty(
    nodes: SplitMesh,
    half95: Array,
    *,
    sensors: Sequence[Sensor] = (),
    title: str = "",
    wedge: Wedge | None = QUARTER,
    view: View | None = None,
    theme: Theme = LIGHT,
    png: str | Path | None = None,
) -> pyvista.Plotter:
    """Half the width of the 95 % band (K), the darker the less sure; the scale begins at zero.

    half95 : (n_nodes,) K;  sensors : where it was measured
    """
    view, room = view or View(), room_for(label_texts(sensors), title)
    p, surface, seen = cut_open(nodes, sensors, LABELS, room, wedge, view, theme)
    K = on_nodes(nodes, half95)
    paint_cut(p, surface, seen.cut, K, (0.0, float(K.max())), theme, power())
    scene.colour_bar(p, "± K", theme)
    scene.headline(p, title, theme)
    seen.draw(p, surface, view, theme)
    scene.save(p, png)
    return p
