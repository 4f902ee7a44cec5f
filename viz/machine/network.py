"""The thermal network drawn into the machine it stands for."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.arrays import Array
from geom.meshing.mesh import NamedMesh
from viz.colours import LIGHT, Theme, heat, power, rounded
from viz.figures.flows import Heat
from viz.rendering import scene
from viz.rendering.callouts import Label, callouts, draw_on_top, label_room, pixel, text
from viz.rendering.cut import HALF, cut_away
from viz.rendering.nodes import SplitMesh, split
from viz.rendering.scene import Room, View

if TYPE_CHECKING:
    import pyvista
    from matplotlib.colors import Colormap

SIDE = View(direction=(-1.0, 0.0, 0.0), angle=4.0)
CLOSEST = 0.075  # distance of two nodes, share of the machine's length
LETTERS = 13  # size of the names
SMALL = 0.01  # of the largest flow: thinner lines are left out
LABELLED = 10  # flows whose watts are written
LABEL = 12, 32  # half height and width of such a label, pixels
NODE = 25  # radius of a node, pixels
ASIDE = 20  # pixels from a line to the middle of a label beside it
SHARES = (0.5, 0.42, 0.58, 0.34, 0.66, 0.26, 0.74)  # of a line: where its label may stand, the middle first
BELOW: dict[str, Any] = {"vertical": False, "position_x": 0.28, "position_y": 0.05, "width": 0.36, "height": 0.022}


def network_in_machine(
    mesh: NamedMesh,
    temperatures: Mapping[str, float],
    flow: Heat,
    *,
    title: str = "",
    limits: tuple[float, float] | None = None,
    theme: Theme = LIGHT,
    png: str | Path | None = None,
) -> "pyvista.Plotter":
    """The upper half of the section: nodes where their parts are, coloured by temperature; a line per flow, as wide as
    its conductance and coloured by its heat.

    Nodes off the axis (feet, base) and flows below 1 % of the largest are left out.

    temperatures : node -> degC;  flow : from viz.figures.flows.heat_flows, made with the states `z`
    limits : of the nodes' colours (degC), those of the nodes if not given
    """
    p, nodes = scene.plotter(theme), split(mesh)
    surface = cut_away(nodes, HALF).clipped(np.array([0.0, 1.0, 0.0]))
    data = scene.polydata(surface)
    p.add_mesh(data, color="#E4E8EC" if theme == LIGHT else "#2A323B", ambient=0.9, diffuse=0.1)
    scene.outline(p, data, theme, opacity=0.35)
    at = places(mesh, nodes)
    front = np.array([surface.points[:, 0].min() - 0.02, 0.0, 0.0])
    at = {name: xyz + front for name, xyz in at.items() if xyz[1] > 0 and name in temperatures}
    low, high = surface.framed.min(axis=0), surface.framed.max(axis=0)
    words = {name: f"{name}  {temperatures[name]:.0f} °C" for name in at}
    wide = label_room(list(words.values()), LETTERS, 0.17)
    room = Room(wide, wide + scene.BAR, scene.TITLE)
    scene.look(p, front + np.array([[0, low[1], low[2]], [0, high[1], high[2]]]), SIDE, room)
    at = spread_out(at, max(CLOSEST * nodes.length, 2 * NODE * pixel(p)))
    z = [xyz[2] for xyz in at.values()]  # pushed apart, some stand beside the machine
    reach = LABEL[1] * pixel(p)
    ends = min([low[2], *(v - reach for v in z)]), max([high[2], *(v + reach for v in z)])
    frame = front + np.array([[0, -0.2 * high[1], ends[0]], [0, high[1], ends[1]]])
    scene.look(p, frame, SIDE, room)
    widest = _lines(p, at, flow, power() if theme == LIGHT else power().reversed(), pixel(p))
    _nodes(p, at, temperatures, limits)
    names = [Label(tuple(xyz), words[name], LIGHT.ink) for name, xyz in at.items()]  # type: ignore[arg-type]
    scene.colour_bar(p, "°C", theme, mapper=p.actors["nodes"].mapper)
    if "link 0" in p.actors:
        scene.colour_bar(p, "", theme, mapper=p.actors["link 0"].mapper, unit="W", **BELOW)
    scene.headline(p, f"{title} widest line {float(f'{widest:.2g}'):g} W/K".strip(), theme)
    callouts(p, names, frame, SIDE, theme, size=LETTERS, dots=False)
    renderer: Any = p.renderer
    renderer.ResetCameraClippingRange()  # the camera stood before lines and nodes were there
    return scene.save(p, png)


def places(mesh: NamedMesh, nodes: SplitMesh) -> dict[str, Array]:
    """Name of part or fluid -> (0, y, z) m: mean radius in the upper half, or its own middle if off the axis."""
    corners = nodes.points[nodes.tets]
    edges = corners[:, 1:] - corners[:, :1]
    volume = np.abs(np.einsum("ij,ij->i", np.cross(edges[:, 0], edges[:, 1]), edges[:, 2])) / 6
    middle = nodes.points[nodes.tets].mean(axis=1)
    at = {}
    for i, part in enumerate(nodes.parts):
        mine = nodes.region == i
        at[part] = _in_plane(middle[mine], volume[mine])
    fluids = sorted({patch.fluid for patch in mesh.patches.values()} - {"ambient"})
    for fluid in fluids:
        faces = np.concatenate([p.facets for p in mesh.patches.values() if p.fluid == fluid])
        a, b, c = mesh.points[faces].transpose(1, 0, 2)
        at[fluid] = _in_plane((a + b + c) / 3, np.linalg.norm(np.cross(b - a, c - a), axis=1))
    return at


def _in_plane(points: Array, weight: Array) -> Array:
    """Mean of points folded into the upper half of the section."""
    mean = np.average(points, axis=0, weights=weight)
    radius = np.average(np.hypot(points[:, 0], points[:, 1]), weights=weight)
    off_axis = np.hypot(mean[0], mean[1]) > 0.5 * radius
    return np.array([0.0, mean[1] if off_axis else radius, mean[2]])


def spread_out(at: Mapping[str, Array], least: float) -> dict[str, Array]:
    """Points that lie closer than `least` (m) pushed apart along the axis, so that lines between them can be seen."""
    names, xyz = list(at), np.array(list(at.values()))
    for _ in range(100):
        step = xyz[:, None] - xyz[None]
        near = np.triu(np.linalg.norm(step, axis=2) < least, 1)
        if not near.any():
            break
        for i, j in np.argwhere(near):
            push = least / 8 * (1 if step[i, j, 2] > 0 else -1)
            xyz[i, 2] += push
            xyz[j, 2] -= push
    return dict(zip(names, xyz, strict=True))


def _lines(p: "pyvista.Plotter", at: Mapping[str, Array], flow: Heat, colours: "Colormap", pixel_m: float) -> float:
    """A line per flow; the largest carry their watts where there is room. The widest line's W/K."""
    import pyvista

    inner = [replace(f, watts=abs(f.watts)) for f in flow.flows if f.start in at and f.end in at]
    most = max((f.watts for f in inner), default=1.0)
    strongest = sorted((f for f in inner if f.conductance > 0 and f.watts >= SMALL * most), key=lambda f: -f.watts)
    widest = max((f.conductance for f in strongest), default=0.0)
    labels: list[Array] = []
    for i, f in enumerate(strongest):
        a, b = at[f.start], at[f.end]
        line = pyvista.Line(a, b)
        line.point_data["W"] = np.full(line.n_points, f.watts)
        style: dict[str, Any] = {"lighting": False, "show_scalar_bar": False, "name": f"link {i}"}
        style |= {"line_width": max(2.0, 24 * np.sqrt(f.conductance / widest))}
        draw_on_top(p.add_mesh(line, scalars="W", cmap=colours, clim=rounded(0.0, most), **style), 1)
        place = clear_place(a, b, list(at.values()), labels, pixel_m) if len(labels) < LABELLED else None
        if place is not None:
            p.add_actor(text(f"{f.watts:.0f} W", place, "#6B2A12", 0, 11), reset_camera=False)
            labels.append(place)
    return widest


def clear_place(a: Array, b: Array, nodes: Sequence[Array], labels: Sequence[Array], pixel_m: float) -> Array | None:
    """Where a label on the line from a to b (m), or beside it, covers no node and no other label, near the line's
    middle; None: nowhere.

    pixel_m : what a pixel of the picture is wide (m)
    """
    half, dot = pixel_m * np.array(LABEL), pixel_m * NODE

    def clear(at: Array) -> bool:
        near = [np.abs(at - other)[1:] < half + dot for other in nodes] + [
            np.abs(at - o)[1:] < 2 * half for o in labels
        ]
        return not any(one.all() for one in near)

    along = (b - a) / max(float(np.linalg.norm(b - a)), 1e-12)
    aside = pixel_m * ASIDE * np.array([0.0, -along[2], along[1]])
    return next((at for k in (0, 1, -1) for share in SHARES if clear(at := a + share * (b - a) + k * aside)), None)


def _nodes(
    p: "pyvista.Plotter", at: Mapping[str, Array], T: Mapping[str, float], limits: tuple[float, float] | None
) -> None:
    import pyvista

    cloud = pyvista.PolyData(np.array(list(at.values())))
    cloud.point_data["T"] = [T[name] for name in at]
    style: dict[str, Any] = {"render_points_as_spheres": True, "lighting": False, "show_scalar_bar": False}
    halo = p.add_mesh(cloud.copy(), color="white", point_size=50, **style)
    ends = rounded(*(limits or (min(T[name] for name in at), max(T[name] for name in at))))
    dots = p.add_mesh(cloud, scalars="T", cmap=heat(), clim=ends, point_size=42, name="nodes", **style)
    draw_on_top(halo, 4)
    draw_on_top(dots, 5)
