"""Pictures, recording and curves: how long one waits.

    python benchmarks/rendering.py [--size-mm 10] [--segments 200] [--json FILE]

The motor's mesh has about 150,000 nodes at the default size. Wall seconds of one process, and its CPU seconds beside
them, which say more on a shared computer; the load of the computer at the start is kept too. The first picture takes
all of it: loading VTK, looking for OpenGL, splitting and cutting the mesh. Targets: first picture below 5 s, next
frames below 0.3 s, an hour's recording of 60 frames below 10 s and 20 MB, click to curve below 0.3 s, to which the
browser adds its own share (`docs/images/workbench.py` times it there). The peer of the pictures is pyvista's own clip
of the same mesh, which cuts it anew for every frame.
"""

import json
import os
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

sys.path = [p for p in sys.path if Path(p).resolve() != Path(__file__).resolve().parent]  # else `viz` is this file
# ruff: noqa: E402

from geom import NamedMesh, build_mesh, load_machine
from lumped.model.network import Row
from measured.case import Channel, Test
from scripts.published import benchmark_parser, measured_row as row, print_rows, timed, write_rows
from viz import split, write_recording
from viz.colours import LIGHT
from viz.data import Comparison
from viz.live.curves import sensor
from viz.machine.field import paint
from viz.rendering import scene
from viz.rendering.cut import cut_away
from viz.rendering.nodes import SplitMesh
from viz.rendering.scene import View

FRAMES, SENSORS = 60, 17


def field(nodes: SplitMesh, share: float) -> np.ndarray:
    """A motor that warms up: hot in the middle, degC."""
    radius, z = np.hypot(*nodes.points[:, :2].T), nodes.points[:, 2]
    shape = np.exp(-((radius / 0.15) ** 2) - ((z - z.mean()) / np.ptp(z)) ** 2)
    return 20.0 + 100.0 * share * shape


def hour(points: np.ndarray) -> tuple[Comparison, dict[str, tuple[float, ...]]]:
    """An hour at 1 Hz with 17 sensors."""
    t, rng = np.arange(3601.0), np.random.default_rng(0)
    names = [f"T{i}" for i in range(SENSORS)]
    model = {n: 20.0 + (40.0 + i) * (1.0 - np.exp(-t / 900.0)) for i, n in enumerate(names)}
    row = Row(np.array([0]), np.array([1.0]))
    channels = tuple(Channel(n, n, row, model[n] + rng.normal(0.0, 0.3, t.size)) for n in names)
    test = Test("hour", "hold-out", t, {}, {"ambient": np.full(t.size, 20.0)}, channels)
    at = {n: tuple(points[i * len(points) // SENSORS].tolist()) for i, n in enumerate(names)}
    return Comparison(test, model, dict.fromkeys(names, 1.0)), at


def pictures(mesh: NamedMesh) -> tuple[SplitMesh, list[dict[str, Any]]]:
    """First picture of a mesh that has never been drawn, then frames of other fields on it."""

    def first() -> tuple[Any, Any, Any, SplitMesh]:
        nodes = split(mesh)
        p, surface = scene.plotter(), cut_away(nodes)
        data = paint(p, surface, field(nodes, 1.0), (20.0, 120.0), LIGHT)
        scene.look(p, surface.points, View())
        p.render()
        p.screenshot(return_img=True)
        return p, surface, data, nodes

    wall, cpu, (p, surface, data, nodes) = timed(first)

    def frame(share: float) -> None:
        data.point_data["T"] = surface.values(field(nodes, share))
        p.render()
        p.screenshot(return_img=True)

    walls, cpus, _ = zip(*(timed(lambda s=s: frame(s)) for s in np.linspace(0.2, 1.0, 7)), strict=True)
    p.close()
    (peer_first, _), (peer_next, _) = clipped(nodes)
    case = f"cut-away, {len(np.unique(nodes.original))} nodes, {len(nodes.tets)} tets, 1280 x 800"
    return nodes, [
        row(case, "first picture", "s", wall, peer_first, "pyvista clip"),
        row(case, "first picture, CPU", "s", cpu),
        row(case, "next frame", "s", float(np.median(walls)), peer_next, "pyvista clip"),
        row(case, "next frame, CPU", "s", float(np.median(cpus))),
    ]


def clipped(nodes: SplitMesh) -> list[tuple[float, float]]:
    """(wall, CPU) seconds of the peer: the same wedge by two clips of the volume, then the second field."""
    import pyvista

    grid = pyvista.UnstructuredGrid({pyvista.CellType.TETRA: nodes.tets}, nodes.points)

    def draw(share: float) -> None:
        p = pyvista.Plotter(off_screen=True, window_size=[1280, 800])
        p.enable_anti_aliasing("ssaa")
        grid.point_data["T"] = field(nodes, share)
        left = grid.clip("x", invert=False)
        p.add_mesh(left, scalars="T", clim=(20.0, 120.0))
        p.add_mesh(grid.clip("x").clip("y"), scalars="T", clim=(20.0, 120.0))
        p.render()
        p.screenshot(return_img=True)
        p.close()

    return [timed(lambda s=s: draw(s))[:2] for s in (1.0, 0.5)]


def recording(nodes: SplitMesh) -> list[dict[str, Any]]:
    comparison, at = hour(nodes.points)
    times = np.linspace(0.0, 3600.0, FRAMES)
    fields = np.array([field(nodes, s) for s in np.linspace(0.0, 1.0, FRAMES)])
    with tempfile.TemporaryDirectory() as folder:
        wall, cpu, path = timed(
            lambda: write_recording(Path(folder) / "hour.rrd", nodes, comparison, (times, fields), at)
        )
        megabytes = path.stat().st_size / 1e6
    case = f"recording, 1 h, {FRAMES} frames, {SENSORS} sensors"
    return [row(case, "time", "s", wall), row(case, "time, CPU", "s", cpu), row(case, "size", "MB", megabytes)]


def click(nodes: SplitMesh) -> list[dict[str, Any]]:
    """What the workbench does on the server when a sensor is clicked: its curves as JSON."""
    comparison = hour(nodes.points)[0]

    def clicked(name: str) -> None:
        json.dumps(sensor(comparison, name).to_plotly_json())

    clicked("T1")
    walls, cpus, _ = zip(*(timed(lambda n=n: clicked(f"T{n}")) for n in range(2, 9)), strict=True)
    case = "workbench, click to curve, server side"
    return [row(case, "time", "s", float(np.median(walls))), row(case, "time, CPU", "s", float(np.median(cpus)))]


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("--size-mm", type=float, default=10.0)
    parser.add_argument("--segments", type=int, default=200)
    options = parser.parse_args()
    load = os.getloadavg()[0]
    mesh = build_mesh(load_machine("series-dc-100kw"), size_m=1e-3 * options.size_mm, segments=options.segments)
    nodes, rows = pictures(mesh)
    rows = [*rows, *recording(nodes), *click(nodes)]
    print(f"{os.cpu_count()} cores, load {load:.1f}")
    print_rows(rows)
    write_rows(options.json, "rendering", rows, load=load)


if __name__ == "__main__":
    main()
