"""The machine of one tab: cut open, coloured by temperature, its thermocouples by what the model misses."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from viz.colours import DARK, LIGHT, VERDICT, Theme
from viz.data import Sensor
from viz.machine.field import UNIT, paint
from viz.rendering import scene
from viz.rendering.callouts import HOLLOW, on_top
from viz.rendering.cut import Surface
from viz.rendering.scene import Room, View
from viz.rendering.visibility import covered, obstacle

if TYPE_CHECKING:
    import pyvista

SIZE = (860, 560)  # pixels, until the page says its own
NEAR = 22.0  # pixels from a sensor within which a click means it
STILL = 5.0  # pixels the mouse may move in a click


class Stage:
    """A plotter that is changed, never rebuilt; `on_pick` is called with the name of a sensor that was clicked."""

    def __init__(self, surface: Surface, limits: tuple[float, float], on_pick: Callable[[str], None]) -> None:
        self._surface, self._on_pick = surface, on_pick
        self._sensors: tuple[Sensor, ...] = ()
        self._pressed, self._obstacle, self._chosen = np.zeros(2), obstacle(surface), ""
        self.plotter: pyvista.Plotter = scene.plotter(LIGHT, SIZE)
        self._data = paint(self.plotter, surface, np.zeros(surface.nodes.size), limits, LIGHT)
        scene.colour_bar(self.plotter, UNIT, LIGHT)
        self.reset()
        interactor: Any = self.window.GetInteractor()
        interactor.AddObserver("LeftButtonPressEvent", self._press)
        interactor.GetInteractorStyle().AddObserver("EndInteractionEvent", self._release)  # it keeps releases to itself

    @property
    def window(self) -> Any:
        return self.plotter.render_window

    def temperatures(self, T: NDArray[np.float32]) -> None:
        """(n_points,) degC on the surface."""
        self._data.point_data["T"] = T

    def markers(self, sensors: Sequence[Sensor], chosen: str) -> None:
        """Dots at the sensors, coloured by verdict; the chosen one is larger, those inside or behind are hollow."""
        self._sensors, self._chosen = tuple(sensors), chosen
        for name, group, size, order in self._groups():
            inside = np.array([np.multiply(_rgb(VERDICT[s.verdict]), 255) for s in group], np.uint8)
            self._dots(f"{name} halo", group, np.full_like(inside, 255), size + 10, order)
            self._dots(f"{name} dot", group, inside, size, order + 1)
        self._hollow()

    def _groups(self) -> Iterator[tuple[str, list[Sensor], int, int]]:
        """Name, sensors, size in pixels and order of drawing of both sizes of dots."""
        yield "others", [s for s in self._sensors if s.name != self._chosen], 24, 2
        yield "chosen", [s for s in self._sensors if s.name == self._chosen], 38, 5

    def _hollow(self) -> None:
        """White inside the dots that something covers, as the camera stands."""
        eye = np.array(self.plotter.camera.position)
        for name, group, size, order in self._groups():
            hidden = covered(self._obstacle, np.array([s.xyz for s in group]).reshape(-1, 3), eye)
            concealed = [s for s, h in zip(group, hidden, strict=True) if h]
            white = np.full((len(concealed), 3), 255, np.uint8)
            self._dots(f"{name} core", concealed, white, HOLLOW * size, order + 2)

    def _dots(self, name: str, sensors: Sequence[Sensor], rgb: NDArray[np.uint8], width: float, order: int) -> None:
        """One cloud of dots: few actors draw fast."""
        self.plotter.remove_actor(name, reset_camera=False, render=False)  # type: ignore[arg-type]
        if sensors:
            actor = self.plotter.add_points(
                np.array([s.xyz for s in sensors]), scalars=rgb, rgb=True, point_size=width, lighting=False,
                render_points_as_spheres=True, name=name, reset_camera=False, render=False,
            )  # fmt: skip
            on_top(actor, order)

    def reset(self) -> None:
        """The first view."""
        scene.look(self.plotter, self._surface.points, View(), Room(right=0.12))
        self._hollow()

    def turn(self, azimuth: float, elevation: float, zoom: float) -> None:
        """Move the camera around the machine (degrees) and towards it (factor)."""
        camera: Any = self.plotter.camera
        camera.Azimuth(azimuth)
        camera.Elevation(elevation)
        camera.OrthogonalizeViewUp()
        camera.Zoom(zoom)
        self.plotter.renderer.ResetCameraClippingRange()
        self._hollow()

    def paper(self, dark: bool) -> None:
        """Light or dark ground."""
        theme: Theme = DARK if dark else LIGHT
        self.plotter.set_background(theme.paper)  # type: ignore[arg-type]
        for bar in self.plotter.scalar_bars.values():
            for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
                text.SetColor(*_rgb(theme.ink))

    def on_screen(self) -> Mapping[str, tuple[float, float]]:
        """Sensor -> pixels from the lower left corner of the view."""
        out = {}
        for sensor in self._sensors:
            renderer: Any = self.plotter.renderer
            renderer.SetWorldPoint(*sensor.xyz, 1.0)
            renderer.WorldToDisplay()
            x, y, _ = renderer.GetDisplayPoint()
            out[sensor.name] = (x, y)
        return out

    def at(self, x: float, y: float) -> str | None:
        """The sensor whose dot lies there (pixels)."""
        far = {name: float(np.hypot(u - x, v - y)) for name, (u, v) in self.on_screen().items()}
        best = min(far, key=lambda name: far[name], default=None)
        return best if best is not None and far[best] <= NEAR else None

    def _press(self, interactor: Any, _event: str) -> None:
        self._pressed = np.array(interactor.GetEventPosition(), float)

    def _release(self, style: Any, _event: str) -> None:
        self._hollow()
        now = np.array(style.GetInteractor().GetEventPosition(), float)
        sensor = self.at(*now) if np.linalg.norm(now - self._pressed) <= STILL else None
        if sensor is not None:
            self._on_pick(sensor)

    def close(self) -> None:
        self.plotter.close()


def _rgb(colour: str) -> tuple[float, ...]:
    return tuple(int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
