"""The machine in a browser's own GL: bytes sent, seconds to the first picture, pictures a second while it is turned.

    python benchmarks/viewer.py [--size-mm 30] [--seconds 4] [--json FILE]

A headless Chromium without a graphics card opens the page of viz.viewer, from disk, with an hour of a synthetic field
on the mesh of the series-wound motor. The peer is pyvista's own trame view as it can be kept, `export_html`, of the
same mesh cut open by the same plane, with one field: it cannot play, cut or name anything. Both are turned by the same
movements of the mouse, as fast as the page answers; counted are the callbacks that the browser makes before it draws.
"""

from __future__ import annotations

import argparse
import datetime
import io
import json
import platform
import shutil
import sys
import tempfile
import time
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

sys.path = [p for p in sys.path if Path(p).resolve() != Path(__file__).resolve().parent]
# ruff: noqa: E402

from geom import build_mesh, load_machine
from lumped.model.network import Row
from validation.case import Channel, Test
from viz import split
from viz.data import Comparison
from viz.rendering.nodes import SplitMesh
from viz.viewer.page import Recorded, write_viewer

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
ARGUMENTS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
MEASURES = (("bytes sent", "MB"), ("first picture", "s"), ("pictures a second while turned", "1/s"))
FRAMES, WAIT_S, COLOURS = 61, 120, 100
COUNT = "window.drawn = 0; const count = () => { window.drawn += 1; requestAnimationFrame(count); }; count();"


def warming(nodes: SplitMesh) -> tuple[np.ndarray, np.ndarray]:
    """An hour: times (s) and fields (degC); every part with a time constant of its own."""
    times = np.linspace(0.0, 3600.0, FRAMES)
    radius = np.hypot(*nodes.points[:, :2].T)
    hot, tau = 20.0 + 80.0 * np.exp(-((radius / 0.15) ** 2)), 400.0 * (1 + nodes.owner)
    return times, 20.0 + hot * (1 - np.exp(-times[:, None] / tau))


def ours(nodes: SplitMesh, folder: Path) -> Path:
    times, fields = warming(nodes)
    row, model = Row(np.array([0]), np.array([1.0])), 20.0 + 40.0 * (1 - np.exp(-times / 900.0))
    at = {f"T{i}": tuple(nodes.points[i * nodes.size // 11].tolist()) for i in range(11)}
    channels = tuple(Channel(n, n, row, model + i - 5.0) for i, n in enumerate(at))
    test = Test("hour", "hold-out", times, {}, {"ambient": np.full(FRAMES, 20.0)}, channels)
    comparison = Comparison(test, dict.fromkeys(at, model), dict.fromkeys(at, 1.0))
    return write_viewer(folder / "viewer.html", "motor", nodes, [Recorded(comparison, times, fields)], at)


def peer(nodes: SplitMesh, folder: Path) -> Path:
    """What pyvista keeps of its own view in the browser, of the last field."""
    import pyvista

    grid = pyvista.UnstructuredGrid({pyvista.CellType.TETRA: nodes.tets}, nodes.points)
    grid.point_data["T"] = warming(nodes)[1][-1]
    p = pyvista.Plotter(off_screen=True, window_size=[1280, 800])
    p.add_mesh(grid.clip("x", invert=False).extract_surface(algorithm="dataset_surface"), scalars="T")
    path = folder / "peer.html"
    p.trame.export_html(path)
    p.close()
    return path


def looked(file: Path, seconds: float) -> tuple[float, float]:
    """Seconds to the first picture, and pictures a second while the machine is turned."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as engine:
        path = next(filter(None, map(shutil.which, BROWSERS)))
        browser = engine.chromium.launch(executable_path=path, args=ARGUMENTS)
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.set_default_timeout(1e3 * WAIT_S)
        start = time.perf_counter()
        page.goto(file.as_uri())
        while not drawn(page):
            assert time.perf_counter() - start < WAIT_S, f"{file.name} shows nothing after {WAIT_S} s"
        first = time.perf_counter() - start
        page.evaluate(COUNT)
        page.mouse.move(400, 400)
        page.mouse.down()
        begin, step = time.perf_counter(), 0
        while (spent := time.perf_counter() - begin) < seconds:
            step += 1
            page.mouse.move(400 + 150 * np.sin(step / 10), 400 + 60 * np.sin(step / 23))
        page.mouse.up()
        rate = page.evaluate("window.drawn") / spent
        browser.close()
    return first, float(rate)


def drawn(page: Any) -> bool:
    """Is there more than paper and letters in the middle of the page: many colours?"""
    from PIL import Image

    middle = Image.open(io.BytesIO(page.screenshot(clip={"x": 250, "y": 200, "width": 400, "height": 350})))
    return len(middle.convert("RGB").getcolors(400 * 350) or []) > COLOURS


def rows(size_m: float, seconds: float) -> list[dict[str, Any]]:
    nodes = split(build_mesh(load_machine("series-dc-100kw"), size_m))
    case = f"series-wound motor, {nodes.size} nodes, {len(nodes.tets)} tets, 1280 x 800, no graphics card"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files = [ours(nodes, folder), *([peer(nodes, folder)] if find_spec("trame_pyvista") else [])]
        found = [(file.stat().st_size / 1e6, *looked(file, seconds)) for file in files]
    return [row(case, measure, unit, [one[i] for one in found]) for i, (measure, unit) in enumerate(MEASURES)]


def row(case: str, measure: str, unit: str, values: list[float]) -> dict[str, Any]:
    """values : ours, and the peer's where it is installed"""
    out = {"case": case, "measure": measure, "unit": unit, "ours": values[0]}
    if len(values) == 1:
        return out
    peer_name = "pyvista's trame view (export_html)"
    return {**out, "peer": values[1], "peer_name": peer_name, "ratio": values[0] / values[1]}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size-mm", type=float, default=30.0)
    parser.add_argument("--seconds", type=float, default=4.0, help="for which the machine is turned")
    parser.add_argument("--json", type=Path)
    asked = parser.parse_args()
    if not any(map(shutil.which, BROWSERS)) or find_spec("playwright") is None:
        print("skipped: needs playwright and a browser: apt-get install -y chromium")
        return
    found = rows(asked.size_mm / 1e3, asked.seconds)
    document = {
        "benchmark": "viewer", "computer": f"{platform.machine()}, Python {platform.python_version()}",
        "date": datetime.date.today().isoformat(), "rows": found,
    }  # fmt: skip
    for one in found:
        beside = f" peer {one['peer']:8.3g}  ratio {one['ratio']:.2g}" if "peer" in one else ""
        print(f"{one['measure']:32} {one['ours']:8.3g} {one['unit']:4}{beside}")
    if asked.json:
        asked.json.write_text(json.dumps(document, indent=1))


if __name__ == "__main__":
    main()
