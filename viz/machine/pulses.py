"""Thermocouples in a moving picture: dots that pulse where the model misses what was measured."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from viz.colours import VERDICT, rgb
from viz.data import Sensor
from viz.rendering.callouts import HOLLOW, draw_on_top
from viz.rendering.cut import Surface
from viz.rendering.visibility import covered, obstacle

if TYPE_CHECKING:
    import pyvista

SIZE = 17.0  # pixels of a dot in a picture 960 wide
SWELL = 1.1  # of its own size that the ring around a dot grows by while it pulses
HERTZ = 1.2  # pulses in a second: slow enough not to flicker


class Pulses:
    """Dots on a plotter whose camera stands still; `show` moves them on."""

    def __init__(self, p: pyvista.Plotter, surface: Surface, sensors: Sequence[Sensor]) -> None:
        self._p, self._xyz = p, np.array([s.xyz for s in sensors]).reshape(-1, 3)
        self._hidden = covered(obstacle(surface), self._xyz, np.array(p.camera.position))

    def show(self, sensors: Sequence[Sensor], second: float) -> None:
        """The sensors as they are at this instant of the film (s); they stay in the order in which they came."""
        colours = np.array([rgb(VERDICT[s.verdict]) for s in sensors], np.uint8).reshape(-1, 3)
        wrong = np.array([s.verdict in ("hot", "cold") for s in sensors], bool)
        phase = second * HERTZ % 1.0
        self._dots("pulse", wrong, colours, SIZE * (1.4 + SWELL * np.sin(np.pi * phase)), 1)
        self._dots("halo", np.ones_like(wrong), np.full_like(colours, 255), 1.35 * SIZE, 2)
        self._dots("dot", np.ones_like(wrong), colours, SIZE, 3)
        self._dots("core", self._hidden, np.full_like(colours, 255), HOLLOW * SIZE, 4)

    def _dots(self, name: str, mask: NDArray[np.bool_], colours: NDArray[np.uint8], size: float, order: int) -> None:
        self._p.remove_actor(name, reset_camera=False, render=False)  # type: ignore[arg-type]
        if mask.any():
            actor = self._p.add_points(
                self._xyz[mask],
                scalars=colours[mask],
                rgb=True,
                point_size=size,
                lighting=False,
                render_points_as_spheres=True,
                name=name,
                reset_camera=False,
                render=False,
            )
            draw_on_top(actor, order)
