"""What the camera sees, and ghosted material that hides a sensor: a window down to a section at its depth.

What is seen is read back from a small picture of part numbers.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.ndimage import distance_transform_edt

from geom.arrays import Array, Mask
from viz.rendering import scene
from viz.rendering.cut import Surface, joined, section
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
    high, low = np.divmod(surface.part + 1, 16)
    data.cell_data["number"] = np.stack([low * 16, high * 16, np.zeros_like(low)], axis=1).astype(np.uint8)
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


SIDES = 20  # of a window: round to the eye
OPACITY = 0.16  # of ghosted material: it is there, and what is behind it keeps its colour
SAME = 1e-6  # rad between lines of sight below which no picture tells them apart
RADIUS = 0.028  # of the machine's diagonal: three times a dot, so that what is around the sensor can be told


@dataclass(frozen=True)
class Window:
    """normals : (n, 3) into the window, of planes through the eye (m);  bottom : the sensor's place (m)

    towards : unit vector from there to the eye;  rim : (n, 3) m around the bottom
    """

    eye: Array
    normals: Array
    bottom: Array
    towards: Array
    rim: Array

    def split(self, pieces: list[Surface]) -> tuple[list[Surface], list[Surface]]:
        """What the window takes away of some surfaces, and what stays."""
        ghosts, stays = list[Surface](), list[Surface]()
        planes = [*((n, float(n @ self.eye)) for n in self.normals), (self.towards, float(self.towards @ self.bottom))]
        for piece in pieces:
            near = self._near(piece)
            stays.append(piece.only(~near))
            inside = piece.only(near).compact()  # small: each plane then costs little
            for normal, offset in planes if near.any() else ():
                stays.append(inside.clipped(-normal, -offset))
                inside = inside.clipped(normal, offset)
            ghosts.append(inside)
        return [t for t in ghosts if len(t.triangles)], [s for s in stays if len(s.triangles)]

    def cropped(self, surface: Surface) -> Surface:
        """What lies within the window's sides."""
        surface = surface.only(self._near(surface)).compact()
        for n in self.normals:
            surface = surface.clipped(n, float(n @ self.eye))
        return surface

    def _near(self, surface: Surface) -> Mask:
        """(n,) triangles with no side of the window between them and it."""
        outside = (surface.points - self.eye) @ self.normals.T < 0
        return ~np.any(np.all(outside[surface.triangles], axis=1), axis=1)


@dataclass(frozen=True)
class Ghosted:
    """A surface with windows in it.

    solid : what still hides;  ghost : what has become transparent, None without a window
    """

    solid: Surface
    ghost: Surface | None = None
    windows: tuple[Window, ...] = ()


def ghosted(surface: Surface, places: Array, mask: Mask, eye: Array) -> Ghosted:
    """The surface with a window to each chosen one of the places (n, 3) m, as seen from `eye` (m); the deepest last.

    Where two lines of sight are close, their windows meet midway: each must show its own part.
    """
    size = float(np.linalg.norm(np.ptp(surface.nodes.points, axis=0)))
    rows = np.flatnonzero(mask).tolist()
    windows = [window(places[i], eye, RADIUS * size, np.delete(places, i, axis=0)) for i in rows]
    windows.sort(key=lambda w: float(np.linalg.norm(w.bottom - eye)))
    if not windows:
        return Ghosted(surface)
    solid, floors, ghosts = [surface], list[Surface](), list[Surface]()
    for one in windows:
        faded, solid = one.split(solid)
        ghosts += faded
        floor = one.cropped(section(surface.nodes, one.towards, float(one.towards @ one.bottom)))
        floors = [*one.split(floors)[1], floor]
    return Ghosted(joined([*solid, *floors]), joined(ghosts) if ghosts else None, tuple(windows))


def window(at: Array, eye: Array, radius: float, others: Array) -> Window:
    """A window of `radius` (m) around a place, its bottom across the line of sight, up to midway to others (n, 3) m."""
    towards = (eye - at) / np.linalg.norm(eye - at)
    right = np.cross([0.0, 1.0, 0.0], towards)
    right /= np.linalg.norm(right)
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    spokes = radius * (np.cos(angle)[:, None] * right + np.sin(angle)[:, None] * np.cross(towards, right))
    normals = np.cross(at + spokes - eye, np.roll(at + spokes, -1, axis=0) - eye)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    normals *= np.sign(normals @ (at - eye))[:, None]
    # (n, 3) normals of the planes through the eye that part a line of sight from others; the same line has none
    away = (at - eye) / np.linalg.norm(at - eye) - (others - eye) / np.linalg.norm(others - eye, axis=1, keepdims=True)
    length = np.linalg.norm(away, axis=1)
    distinct = length > SAME
    midway = np.asarray(away[distinct] / length[distinct, None])
    reach = np.max(-(spokes @ midway.T) / (midway @ (at - eye)), axis=1, initial=1.0)  # how far a spoke oversteps
    return Window(eye, np.concatenate([normals, midway]), at, towards, at + spokes / reach[:, None])
