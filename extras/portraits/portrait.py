"""The machine as one would photograph it: rounded, lit, standing on its shadow; for the eye only, never the mesh."""

from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.ndimage import gaussian_filter, maximum_filter
from scipy.sparse import csr_matrix, vstack

from extras.portraits.cutting import cut_body
from extras.portraits.dressed import dressed
from extras.portraits.shape import Body, Finish, Shape
from thermoscope import plugin as th

if TYPE_CHECKING:
    import pyvista

NEAREST = 4  # nodes of the meshed part whose temperatures a point of the picture mixes
CAPTION = "details are for the eye only: the mesh has none of them"
VIEW = th.View(direction=(-1.0, 0.45, 0.85), angle=18.0, margin=1.1)


def portrait(
    machine: th.MachineDescription,
    *,
    nodes: th.SplitMesh | None = None,
    T: th.Array | None = None,
    limits: tuple[float, float] | None = None,
    wedge: th.Wedge | None = th.QUARTER,
    view: th.View = VIEW,
    theme: th.Theme = th.LIGHT,
    size: tuple[int, int] = th.scene.SIZE,
    title: str = "",
    caption: str = CAPTION,
    png: str | Path | None = None,
) -> "pyvista.Plotter":
    """A machine as it looks, cut open or (wedge None) whole; of its materials, or coloured by temperature.

    nodes, T : a mesh and temperatures (degC) per node; limits : of the colour scale (degC)
    caption : below the picture
    """
    warm = None if nodes is None or T is None else Warm(nodes, th.on_nodes(nodes, T), limits)
    room = th.Room(0.0, 0.1 if warm else 0.0, th.TITLE if title else 0.0, th.NOTE if caption else 0.0)
    p = staged(machine, warm, wedge, view, theme, size, room)[0]
    th.scene.headline(p, title, theme)
    th.scene.footnote(p, caption, theme)
    th.scene.save(p, png)
    return p


def staged(
    machine: th.MachineDescription,
    warm: "Warm | None",
    wedge: th.Wedge | None,
    view: th.View,
    theme: th.Theme,
    size: tuple[int, int],
    room: th.Room,
) -> "tuple[pyvista.Plotter, list[Painted]]":
    """The machine lit and standing, with room around it; and what of it is coloured by temperature."""
    p, bodies = _stage(theme, size), dressed(machine)
    painted = [_add(p, pieces, *kind, warm) for kind, pieces in _gathered(bodies, wedge).items()]
    points = framed(machine, bodies)
    points = np.concatenate([points, shaded(points, float(points[:, 1].min()))])
    p.add_actor(shadow([b.shape for b in bodies], theme), reset_camera=False, pickable=False)
    th.scene.look(p, points, view, room)
    if warm is not None:
        th.scene.colour_bar(p, "°C", theme)
    _shade(p, points)
    return p, [one for one in painted if one is not None]


def framed(machine: th.MachineDescription, bodies: Sequence[Body]) -> th.Array:
    """(n, 3) m that the picture must hold: all, of a long base only what is near the machine."""
    bases = {part.name for part in machine.parts if part.identity and part.identity.role is th.Role.BASE}
    inner, outer = ([b.shape.points for b in bodies if (b.part in bases) is base] for base in (False, True))
    return th.framed(np.concatenate(inner), np.concatenate([np.empty((0, 3)), *outer]))


class Warm:
    """Temperatures for points that are not nodes: of the nearest nodes of the part that a body stands for."""

    def __init__(self, nodes: th.SplitMesh, T: th.Array, limits: tuple[float, float] | None = None) -> None:
        self.nodes, self.T = nodes, T
        self.limits = th.rounded(*(limits or (float(T.min()), float(T.max()))))

    def weights(self, part: str, points: th.Array) -> csr_matrix:
        """(n, n_nodes) rows summing to 1, by the inverse of the distance."""
        from scipy.spatial import cKDTree

        mine = self.nodes.of(part)
        k, n = min(NEAREST, len(mine)), len(points)
        away, near = (np.reshape(x, (n, k)) for x in cKDTree(self.nodes.points[mine]).query(points, k=k))
        share = 1 / np.maximum(away, 1e-6)
        share /= share.sum(axis=1, keepdims=True)
        row = np.repeat(np.arange(n), k)
        return csr_matrix((share.ravel(), (row, mine[near].ravel())), shape=(n, self.nodes.size))


Pieces = list[tuple[str, "pyvista.PolyData"]]
Painted = tuple["pyvista.PolyData", csr_matrix]


def _gathered(bodies: Sequence[Body], wedge: th.Wedge | None) -> dict[tuple[Finish, bool], Pieces]:
    """By finish, surfaces and sections apart: few things to draw are drawn fast."""
    out: dict[tuple[Finish, bool], Pieces] = defaultdict(list)
    for body in bodies:
        pieces = cut_body(body, wedge)
        for piece, section in zip(pieces or (), (False, True), strict=False):
            if piece is not None and piece.n_cells:
                out[body.finish, section].append((body.part, piece))
    return out


def _add(p: "pyvista.Plotter", pieces: Pieces, finish: Finish, section: bool, warm: Warm | None) -> Painted | None:
    """One thing to draw; with the rows that give its temperatures, where it shows any."""
    shine, sharpness = finish.shine
    look: dict[str, Any] = {"ambient": 0.40, "diffuse": 0.75, "smooth_shading": False}
    look |= {"specular": 0.0 if section else shine, "specular_power": sharpness}
    first, *others = [piece for _, piece in pieces]
    data, rows = first.append_polydata(*others) if others else first, None
    if warm is not None:
        rows = vstack([warm.weights(part, np.asarray(piece.points)) for part, piece in pieces], format="csr")
        data.point_data["T"] = rows @ warm.T
        look |= {
            "scalars": "T",
            "cmap": th.heat_colours(),
            "clim": warm.limits,
            "show_scalar_bar": False,
            "ambient": 0.64,
        }
        look |= {"diffuse": 0.42, "specular": 0.05}
    actor = p.add_mesh(data, color=finish.section if section else finish.colour, **look)
    actor.prop.interpolation = "flat" if section else "phong"
    return None if rows is None else (data, rows)


def _stage(theme: th.Theme, size: tuple[int, int]) -> "pyvista.Plotter":
    """A lamp over the shoulder, a weak one from the other side, a weak one from behind."""
    import pyvista

    p = th.scene.plotter(theme, size)
    for renderer in p.renderers:
        renderer.RemoveAllLights()
    for place, strength in (((-0.6, 1.0, 1.0), 0.85), ((1.0, 0.3, 0.8), 0.35), ((0.2, 0.8, -1.0), 0.30)):
        p.add_light(pyvista.Light(position=place, light_type="cameralight", intensity=strength))
    return p


def _shade(p: "pyvista.Plotter", points: th.Array) -> None:
    """Corners that little light reaches are darker (screen-space ambient occlusion)."""
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    p.renderer.enable_ssao(radius=0.045 * size, bias=0.0015 * size, kernel_size=64, blur=True)


PIXELS = 256  # along the longer side of the shadow
DARK = 0.55  # of the middle of the shadow
MARGIN = 0.25  # of the machine's size, around the shadow
SAMPLES = 200_000  # points on the machine that throw it
SOFT = 0.035  # share of the machine's size over which the shadow fades
FADE = 0.04  # share of its size beyond which nothing of the shadow of what stands there is seen


def shadow(shapes: Sequence[Shape], theme: th.Theme) -> Any:
    """The soft shadow, the machine seen from above, blurred: a flat actor under its lowest point; y is up."""
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
