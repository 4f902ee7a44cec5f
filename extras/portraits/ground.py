"""A soft shadow on the ground: the machine seen from above, blurred."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter, maximum_filter

from extras.portraits.shape import Shape
from thermoscope import plugin as th

PIXELS = 256  # along the longer side of the shadow
DARK = 0.55  # of the middle of the shadow
MARGIN = 0.25  # of the machine's size, around the shadow
SAMPLES = 200_000  # points on the machine that throw it
SOFT = 0.035  # share of the machine's size over which the shadow fades
FADE = 0.04  # share of its size beyond which nothing of the shadow of what stands there is seen


def shadow(shapes: Sequence[Shape], theme: th.Theme) -> Any:
    """A flat actor under a machine's lowest point; y is up."""
    import pyvista

    points = _scattered(shapes)
    low, high = points.min(axis=0), points.max(axis=0)
    span = float(max(high[0] - low[0], high[2] - low[2]))
    margin, y = MARGIN * span, low[1] - 0.001 * span
    start, end = low[[0, 2]] - margin, high[[0, 2]] + margin
    # (rows along z, columns along x) 0 to 1: what stands above, the nearer the ground the darker and sharper
    cell = float((end - start).max()) / PIXELS
    columns, rows = np.ceil((end - start) / cell).astype(int)
    place = ((points[:, [0, 2]] - start) / cell).astype(int)
    height = (points[:, 1] - points[:, 1].min()) / span
    share = np.zeros((rows, columns))
    for above, dark, blur in ((0.03, 1.0, 0.25), (0.2, 0.6, 0.8), (np.inf, 0.45, 1.4)):
        there = np.zeros((rows, columns))
        column, row = place[height < above].T
        there[np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)] = dark
        share = np.maximum(share, gaussian_filter(maximum_filter(there, 5), blur * SOFT * span / cell))
    corners = [[start[0], y, start[1]], [end[0], y, start[1]], [end[0], y, end[1]], [start[0], y, end[1]]]
    plane = pyvista.PolyData(np.array(corners), faces=[4, 0, 1, 2, 3])
    plane.active_texture_coordinates = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    rgba = np.zeros((*share.shape, 4), np.uint8)
    rgba[..., 3] = (255 * DARK * share).astype(np.uint8)
    actor = pyvista.Actor(mapper=pyvista.DataSetMapper(plane))
    actor.texture = pyvista.Texture(np.ascontiguousarray(rgba[::-1]))
    actor.texture.InterpolateOn()
    actor.prop.lighting = False
    actor.ForceTranslucentOn()
    return actor


def shaded(points: th.Array, low_m: float) -> th.Array:
    """(4, 3) m corners on the ground, at the height low_m, of what the shadow of some points darkens."""
    low, high = points.min(axis=0), points.max(axis=0)
    fade = FADE * float(max(high[0] - low[0], high[2] - low[2]))
    return np.array([[x, low_m, z] for x in (low[0] - fade, high[0] + fade) for z in (low[2] - fade, high[2] + fade)])


def _scattered(shapes: Sequence[Shape]) -> th.Array:
    """(SAMPLES, 3) m, about evenly over all surfaces."""
    corners = np.concatenate([s.points[s.triangles] for s in shapes])
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    rng = np.random.default_rng(0)
    triangles = corners[rng.choice(len(corners), SAMPLES, p=area / area.sum())]
    u, v = np.sqrt(rng.random(SAMPLES)), rng.random(SAMPLES)
    share = np.stack([1 - u, u * (1 - v), u * v], axis=1)
    return np.asarray((share[:, :, None] * triangles).sum(axis=1))
