"""The thermal network drawn into the machine it stands for."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from geom.mesh import NamedMesh
from viz import scene
from viz.callouts import Label, callouts, on_top, text
from viz.colours import LIGHT, VERMILION, Theme, heat
from viz.cut import HALF, cut_away
from viz.flows import Flow, Heat
from viz.nodes import SplitMesh, split
from viz.scene import Room, View

if TYPE_CHECKING:
    import pyvista

Array = NDArray[np.float64]
SIDE = View(direction=(-1.0, 0.0, 0.0), angle=4.0)
CLOSEST = 0.075  # distance of two nodes, share of the machine's length
SMALL = 0.01  # of the largest flow: thinner lines are left out
LABELLED = 10  # flows whose watts are written


def network_in_machine(
    mesh: NamedMesh,
    temperatures: Mapping[str, float],
    flow: Heat,
    *,
    title: str = "",
    theme: Theme = LIGHT,
    png: str | Path | None = None,
) -> pyvista.Plotter:
    """The upper half of the section: nodes where their parts are, coloured by temperature, lines as wide as the heat.

    Nodes off the axis (feet, base) and flows below 1 % of the largest are left out.

    temperatures : node -> degC;  flow : from viz.flows.heat_flows
    """
    p, nodes = scene.plotter(theme), split(mesh)
    surface = cut_away(nodes, HALF)
    data = scene.polydata(surface)
    p.add_mesh(data, color="#E4E8EC", ambient=0.9, diffuse=0.1)
    scene.outline(p, data, theme, opacity=0.35)
    at = places(mesh, nodes)
    front = np.array([surface.points[:, 0].min() - 0.02, 0.0, 0.0])
    at = {name: xyz + front for name, xyz in at.items() if xyz[1] > 0 and name in temperatures}
    low, high = nodes.points.min(axis=0), nodes.points.max(axis=0)
    at = apart(at, CLOSEST * float(np.ptp(nodes.points[:, 2])))
    frame = front + np.array([[0, 0, low[2]], [0, high[1], high[2]]])
    _lines(p, at, flow)
    _nodes(p, at, temperatures)
    names = [Label(tuple(xyz), f"{name}  {temperatures[name]:.0f} °C", theme.ink) for name, xyz in at.items()]  # type: ignore[arg-type]
    scene.colour_bar(p, "°C", theme)
    scene.headline(p, title, theme)
    scene.look(p, frame, SIDE, Room(0.22, 0.3, scene.TITLE if title else 0.0))
    callouts(p, names, frame, SIDE, theme, size=13)
    scene.save(p, png)
    return p


def places(mesh: NamedMesh, nodes: SplitMesh) -> dict[str, Array]:
    """Name of part or fluid -> (0, y, z) m: mean radius in the upper half, or its own middle if off the axis."""
    volume = _volumes(nodes)
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


def apart(at: Mapping[str, Array], least: float) -> dict[str, Array]:
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


def _volumes(nodes: SplitMesh) -> Array:
    corners = nodes.points[nodes.tets]
    edges = corners[:, 1:] - corners[:, :1]
    return np.abs(np.einsum("ij,ij->i", np.cross(edges[:, 0], edges[:, 1]), edges[:, 2])) / 6


def _lines(p: pyvista.Plotter, at: Mapping[str, Array], flow: Heat) -> None:
    """A line per flow; the largest carry their watts where no larger one's stand already."""
    inner = [Flow(f.start, f.end, f.kind, abs(f.watts)) for f in flow.flows if f.start in at and f.end in at]
    inner.sort(key=lambda f: -f.watts)
    widest = inner[0].watts if inner else 1.0
    taken: list[Array] = []
    for f in inner:
        if f.watts < SMALL * widest:
            continue
        a, b = at[f.start], at[f.end]
        _line(p, a, b, float(np.clip(16 * np.sqrt(f.watts / widest), 1.0, 16.0)), VERMILION)
        middle = (a + b) / 2
        if len(taken) < LABELLED and all(np.linalg.norm((middle - other) * [0, 2, 1]) > 0.035 for other in taken):
            p.add_actor(text(f"{f.watts:.0f} W", middle, "#8A3A00", 0, 11), reset_camera=False)
            taken.append(middle)


def _line(p: pyvista.Plotter, a: Array, b: Array, width: float, colour: str) -> None:
    import pyvista

    actor = p.add_mesh(pyvista.Line(a, b), color=colour, line_width=width, opacity=0.75, lighting=False)
    on_top(actor, 1)


def _nodes(p: pyvista.Plotter, at: Mapping[str, Array], T: Mapping[str, float]) -> None:
    import pyvista

    cloud = pyvista.PolyData(np.array(list(at.values())))
    cloud.point_data["T"] = [T[name] for name in at]
    style: dict[str, Any] = {"render_points_as_spheres": True, "lighting": False, "show_scalar_bar": False}
    halo = p.add_mesh(cloud.copy(), color="white", point_size=50, **style)
    dots = p.add_mesh(cloud, scalars="T", cmap=heat(), point_size=42, **style)
    on_top(halo, 4)
    on_top(dots, 5)
