"""What the camera sees: a small picture of part numbers, read back."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from geom.arrays import Array, Ints, Mask
from viz.rendering import scene
from viz.rendering.cut import Surface
from viz.rendering.scene import Room, View

SIZE = (640, 400)  # pixels, a quarter of those of a picture
SLACK = 0.006  # m: a thermocouple this deep still counts as lying on the surface
SMALLEST = 1.5  # pixels from the middle of a patch to its border below which a part counts as hidden


def anchors(surface: Surface, view: View, room: Room, points: Array | None = None) -> dict[int, Array]:
    """Part -> the visible point (m) that lies deepest inside what is seen of it; hidden parts are left out.

    points : (n, 3) m that the picture holds, if not the whole surface
    """
    import pyvista

    p = pyvista.Plotter(off_screen=True, window_size=list(SIZE), lighting="none")
    p.set_background("black")  # type: ignore[arg-type]
    data = scene.polydata(surface)
    data.cell_data["number"] = _as_colour(surface.part + 1)
    p.add_mesh(data, scalars="number", rgb=True, lighting=False)
    scene.look(p, surface.points if points is None else points, view, room)
    coarse = np.round(np.asarray(p.screenshot(return_img=True))[..., :2] / 16.0).astype(np.int64)
    part_numbers = (coarse[..., 0] + 16 * coarse[..., 1]) - 1
    depth = np.abs(p.get_image_depth())
    eye = np.array(p.camera.position)
    p.close()
    across = np.arange(SIZE[0]) / SIZE[0]
    free, places = (across >= room.left) & (across <= 1 - room.right), {}
    for part in np.unique(part_numbers[part_numbers >= 0]):
        inside = distance_transform_edt(np.pad(part_numbers == part, 1))[1:-1, 1:-1] * free
        row, column = np.unravel_index(np.argmax(inside), inside.shape)
        if inside[row, column] >= SMALLEST and np.isfinite(depth[row, column]):
            # From the eye through the middle of a pixel, of length 1 along the line of sight
            towards, right, up = view.axes()
            tan = np.tan(np.deg2rad(view.angle) / 2)
            x = ((int(column) + 0.5) / SIZE[0] * 2 - 1) * tan * SIZE[0] / SIZE[1]
            y = (1 - (int(row) + 0.5) / SIZE[1] * 2) * tan
            places[int(part)] = eye + depth[row, column] * np.asarray(-towards + x * right + y * up)
    return places


def obstacle(surface: Surface) -> Any:
    """The surface, sorted so that rays through it are fast."""
    from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

    locator = vtkStaticCellLocator()
    locator.SetDataSet(scene.polydata(surface))
    locator.BuildLocator()
    return locator


def covered(obstacle: Any, points: Array, eye: Array) -> Mask:
    """(n,) does something lie between each of the points (n, 3) m and the eye?"""
    from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints

    away = eye - points
    start = points + SLACK * away / np.linalg.norm(away, axis=1, keepdims=True)
    return np.array([obstacle.IntersectWithLine(a, eye, 0.0, vtkPoints(), vtkIdList()) > 0 for a in start], bool)


def distance(obstacle: Any, points: Array) -> Array:
    """(n,) from each of the points (n, 3) m to the nearest of the surface (m)."""
    from vtkmodules.vtkCommonCore import mutable

    def nearest(at: Array) -> float:
        point, cell, sub = [0.0] * 3, mutable(0), mutable(0)
        squared: Any = mutable(0.0)
        obstacle.FindClosestPoint(at, point, cell, sub, squared)
        return float(np.sqrt(float(squared)))

    return np.array([nearest(at) for at in points], float)


def _as_colour(number: Ints) -> NDArray[np.uint8]:
    return np.stack([number % 16 * 16, number // 16 * 16, np.zeros_like(number)], axis=1).astype(np.uint8)
