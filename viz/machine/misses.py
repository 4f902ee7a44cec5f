"""What the model misses, painted on the machine: told by the sensors, hatched where it is a guess."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.arrays import Array, Mask
from viz.colours import LIGHT, Theme, missing
from viz.data import Sensor
from viz.machine.field import cut_open, paint_cut, room_for
from viz.machine.thermocouples import LABELS, label_texts
from viz.rendering import scene
from viz.rendering.cut import QUARTER, Surface, Wedge
from viz.rendering.nodes import SplitMesh, on_nodes
from viz.rendering.scene import View

if TYPE_CHECKING:
    import pyvista

GUESS = 0.5  # share of the variance below which the readings tell less than half
PERIOD = 14.0  # pixels from stripe to stripe
NEARER = 5e-4  # of the way to the eye, so that stripes lie on the surface and not in it
CAPTION = "hatched: the sensors tell less than half of the model's own uncertainty there"


def misses(
    nodes: SplitMesh,
    error: Array,
    explained: Array,
    *,
    sensors: Sequence[Sensor] = (),
    title: str = "",
    wedge: Wedge | None = QUARTER,
    view: View | None = None,
    theme: Theme = LIGHT,
    png: str | Path | None = None,
) -> "pyvista.Plotter":
    """Measured minus model (K): vermilion where the machine is hotter than the model, blue where it is colder.

    error : (n_nodes,) K;  explained : (n_nodes,) share of the variance that readings explain, see
        validation.comparison.interpolation;  sensors : where it was measured
    """
    view, room = view or View(), room_for(label_texts(sensors), title, note=True)
    p, surface, marks = cut_open(nodes, sensors, LABELS, room, wedge, view, theme)
    K = on_nodes(nodes, error)
    most = float(np.abs(K).max())
    paint_cut(p, surface, marks.cut, K, (-most, most), theme, missing())
    scene.colour_bar(p, "K", theme)
    guess: Mask = np.asarray(marks.cut.solid.values(on_nodes(nodes, explained)) < GUESS)
    _hatch(p, marks.cut.solid, guess, theme)
    renderer: Any = p.renderer
    renderer.ResetCameraClippingRange()
    scene.headline(p, title, theme)
    marks.draw(p, surface, view, theme, CAPTION)
    return scene.save(p, png)


def _hatch(p: "pyvista.Plotter", surface: Surface, guess: Mask, theme: Theme) -> None:
    """Stripes, evenly spaced on the screen, over the triangles whose corners are all a guess."""
    import pyvista

    inside: Mask = np.all(guess[surface.triangles], axis=1)  # type: ignore[assignment]
    hatched = surface.only(inside).compact()
    if not len(hatched.triangles):
        return
    data = scene.polydata(hatched)
    data.points = hatched.points + NEARER * (np.array(p.camera.position) - hatched.points)
    x, y = pixels(p, hatched.points).T
    data.active_texture_coordinates = np.stack([(x + y) / PERIOD, np.zeros_like(x)], axis=1)
    actor = pyvista.Actor(mapper=pyvista.DataSetMapper(data))
    actor.texture = _stripes(theme)
    actor.prop.lighting = False
    actor.prop.culling = "back"
    actor.ForceTranslucentOn()
    p.add_actor(actor, reset_camera=False, pickable=False, name="hatched")


def _stripes(theme: Theme) -> "pyvista.Texture":
    """One stripe of ink between two of nothing."""
    import pyvista

    ink = pyvista.Color(theme.ink).int_rgb
    rgba = np.zeros((1, 32, 4), np.uint8)
    rgba[..., :3] = ink
    rgba[:, 12:19, 3] = 150
    texture = pyvista.Texture(rgba)
    texture.repeat = True
    return texture


def pixels(p: "pyvista.Plotter", points: Array) -> Array:
    """(n, 2) where points (m) are on the screen; the camera must stand."""
    renderer: Any = p.renderer
    wide, high = renderer.GetSize()
    matrix = renderer.GetActiveCamera().GetCompositeProjectionTransformMatrix(wide / high, -1, 1)
    m = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
    q = np.column_stack([points, np.ones(len(points))]) @ m.T
    return (q[:, :2] / q[:, 3:] + 1) / 2 * [wide, high]
