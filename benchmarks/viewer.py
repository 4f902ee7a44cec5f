"""The machine in a browser's own GL: bytes sent, seconds to the first picture, pictures a second, and who takes them.

    python benchmarks/viewer.py [--size-mm 30] [--seconds 4] [--json FILE]

A headless Chromium without a graphics card opens the page of viz.viewer, from disk, with an hour of a synthetic field
on the mesh of the series-wound motor. The peer is pyvista's own trame view as it can be kept, `export_html`, of the
same mesh cut open by the same plane, with one field: it cannot play, cut or name anything. Both are turned by the same
movements of the mouse, as fast as the page answers; ours is played, too. The first picture is there when the browser
hands out a frame with colours in it, drawn to the end. A picture counts when something was drawn between two frames.
CPU time is the browser's own count: of its script's process, and of the process that draws (here software GL).
The second peer is the same view live: a trame server draws and sends a picture for every movement. Its bytes are those
of pictures, its CPU time the server's, both while it is turned; a picture counts when it has come.
"""

import base64
import io
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from geom import build_mesh, load_machine
from geom.plugins import plugins
from lumped.model.network import Row
from measured.case import Channel, Test
from scripts.published import benchmark_parser, write_rows
from viz import split
from viz.data import Comparison
from viz.rendering.nodes import SplitMesh
from viz.viewer.page import Recorded, analysis_document, machine_document, render, temperature_document

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
ARGUMENTS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
MEASURES = (
    ("bytes sent", "MB"),
    ("first picture", "s"),
    ("first picture, CPU of the browser", "s"),
    ("pictures a second while turned", "1/s"),
    ("a turned picture, CPU of the script", "ms"),
    ("a turned picture, CPU of GL", "ms"),
    ("pictures a second while played", "1/s"),
    ("a played picture, CPU of the script", "ms"),
    ("a played picture, CPU of GL", "ms"),
)
MACHINE = "series-dc-100kw"
FRAMES, WAIT_S = 61, 120
PICTURE = 2000  # bytes of a message from which it holds a picture
COLOURED, SHARE = 40, 0.02  # between the channels of a pixel that is no grey; of the middle that has such pixels
COUNT = """(() => {
  const gl = WebGL2RenderingContext.prototype;
  let drew = false;
  for (const name of ["drawArrays", "drawElements"]) {
    const draw = gl[name];
    gl[name] = function (...all) { drew = true; return draw.apply(this, all); };
  }
  window.drawn = 0;
  const count = () => { window.drawn += drew; drew = false; requestAnimationFrame(count); };
  count();
})()"""


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
    page, machine = folder / "viewer.html", load_machine(MACHINE)
    tests, looks = [Recorded(comparison, times, fields)], plugins("sections")["looks"].packed_looks(machine, nodes)
    content = machine_document("motor", nodes, None, looks) | analysis_document(tests, nodes, None)
    page.write_text(render(content | temperature_document(nodes, tests, at, None, ("now", "before"), None)))
    return page


def cut_open(nodes: SplitMesh) -> Any:
    """The surface of the mesh cut open, with the last field, as pyvista has it."""
    import pyvista

    grid = pyvista.UnstructuredGrid({pyvista.CellType.TETRA: nodes.tets}, nodes.points)
    grid.point_data["T"] = warming(nodes)[1][-1]
    return grid.clip("x", invert=False).extract_surface(algorithm="dataset_surface")


def peer(nodes: SplitMesh, folder: Path) -> Path:
    """What pyvista keeps of its own view in the browser, of the last field."""
    import pyvista

    p = pyvista.Plotter(off_screen=True, window_size=[1280, 800])
    p.add_mesh(cut_open(nodes), scalars="T")
    path = folder / "peer.html"
    p.trame.export_html(path)
    p.close()
    return path


SERVED = """
import sys, numpy as np, pyvista
from trame.app import get_server
from trame.ui.vuetify3 import SinglePageLayout
from trame.widgets import vuetify3
from trame_pyvista.ui import plotter_ui

held = np.load(sys.argv[1])
data = pyvista.PolyData.from_regular_faces(held["points"], held["triangles"])
data.point_data["T"] = held["T"]
p = pyvista.Plotter(off_screen=True, window_size=[1280, 800])
p.add_mesh(data, scalars="T")
server = get_server(client_type="vue3")
with SinglePageLayout(server) as layout, layout.content:
    with vuetify3.VContainer(fluid=True, classes="pa-0 fill-height"):
        plotter_ui(p, mode="server", default_server_rendering=True)
server.start(port=int(sys.argv[2]), open_browser=False, show_connection_info=False, exec_mode="main", timeout=0)
"""
LIVE = (
    "first picture",
    "pictures a second while turned",
    "MB a second while turned",
    "a turned picture, CPU of the server",
)


def served_live(nodes: SplitMesh, folder: Path, seconds: float) -> list[float]:
    """What LIVE says of pyvista's own view, served and drawn by trame; turned as the others are."""
    cut = cut_open(nodes).triangulate()
    np.savez(folder / "cut.npz", points=cut.points, triangles=cut.regular_faces, T=cut.point_data["T"])
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = subprocess.Popen(
        [sys.executable, "-c", SERVED, str(folder / "cut.npz"), str(port)], stderr=subprocess.DEVNULL
    )
    try:
        listening(port)
        with open_page() as (_, page):
            came: list[int] = []
            page.on("websocket", lambda line: line.on("framereceived", lambda payload: came.append(len(payload))))
            first = first_picture(page, f"http://127.0.0.1:{port}/index.html")
            page.mouse.move(400, 400)
            page.mouse.down()
            came.clear()
            before, begin, step = cpu_of(server.pid), time.perf_counter(), 0
            while (spent := time.perf_counter() - begin) < seconds:
                step += 1
                turned(page, step)
                page.wait_for_timeout(1)  # what came is heard
            page.mouse.up()
            pictures = [size for size in came if size > PICTURE]
            used = cpu_of(server.pid) - before
    finally:
        server.terminate()
        server.wait()
    each = 1e3 / len(pictures) if pictures else 0.0
    return [first, len(pictures) / spent, 1e-6 * sum(pictures) / spent, each * used]


@contextmanager
def open_page() -> Iterator[tuple[Any, Any]]:
    """A browser with an empty page."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as engine:
        path = next(filter(None, map(shutil.which, BROWSERS)))
        browser = engine.chromium.launch(executable_path=path, args=ARGUMENTS)
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.set_default_timeout(1e3 * WAIT_S)
        yield browser, page
        browser.close()


def listening(port: int) -> None:
    """Wait until a server answers there."""
    for _ in range(10 * WAIT_S):
        with suppress(OSError), socket.create_connection(("127.0.0.1", port), timeout=1):
            return
        time.sleep(0.1)
    raise SystemExit(f"nothing answers at {port} after {WAIT_S} s")


def cpu_of(pid: int) -> float:
    """CPU seconds of a process (Linux)."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def looked(file: Path, seconds: float, plays: bool) -> list[float]:
    """What MEASURES says, after the bytes; played only where the page can."""
    with open_page() as (browser, page):
        page.add_init_script(COUNT)
        clock = browser.new_browser_cdp_session()
        before, first = cpu(clock), first_picture(page, file.as_uri())
        out = [first, sum(cpu(clock).values()) - sum(before.values())]
        page.mouse.move(400, 400)
        page.mouse.down()
        out += moved(page, clock, seconds, turned)
        page.mouse.up()
        if plays:
            page.keyboard.press(" ")
            out += moved(page, clock, seconds, lambda page, step: page.wait_for_timeout(50))
    return out


def first_picture(page: Any, address: str) -> float:
    """Seconds from asking for the page until a frame of the screen has colours; later frames are not asked for."""
    screen, came = page.context.new_cdp_session(page), []

    def frame(event: dict[str, Any]) -> None:
        if not came:
            if coloured(event["data"]):
                came.append(time.perf_counter())
            screen.send("Page.screencastFrameAck", {"sessionId": event["sessionId"]})

    screen.on("Page.screencastFrame", frame)
    screen.send("Page.startScreencast", {"format": "jpeg", "quality": 50, "maxWidth": 640, "maxHeight": 400})
    start = time.perf_counter()
    page.goto(address)
    while not came:
        assert time.perf_counter() - start < WAIT_S, f"{address} shows nothing after {WAIT_S} s"
        page.wait_for_timeout(20)
    screen.send("Page.stopScreencast")
    return came[0] - start


def coloured(picture: str) -> bool:
    """Is there more than paper, letters and grey in the middle of the left half?"""
    from PIL import Image

    rgb = np.asarray(Image.open(io.BytesIO(base64.b64decode(picture))).convert("RGB")).astype(int)
    high, wide, _ = rgb.shape
    middle = rgb[high // 4 : 3 * high // 4, wide // 5 : wide // 2]
    return bool((np.ptp(middle, axis=2) > COLOURED).mean() > SHARE)


def moved(page: Any, clock: Any, seconds: float, act: Callable[[Any, int], None]) -> list[float]:
    """Pictures a second while `act` is repeated; CPU time (ms) of script and GL for each."""
    page.evaluate("window.drawn = 0")
    before, begin, step = cpu(clock), time.perf_counter(), 0
    while (spent := time.perf_counter() - begin) < seconds:
        step += 1
        act(page, step)
    drawn, after = page.evaluate("window.drawn"), cpu(clock)
    each = 1e3 / drawn if drawn else 0.0
    return [drawn / spent, *(each * (after[kind] - before[kind]) for kind in ("renderer", "GPU"))]


def turned(page: Any, step: int) -> None:
    page.mouse.move(400 + 150 * np.sin(step / 10), 400 + 60 * np.sin(step / 23))


def cpu(clock: Any) -> Counter[str]:
    """CPU seconds of the browser's processes by kind; some start late."""
    out: Counter[str] = Counter()
    for one in clock.send("SystemInfo.getProcessInfo")["processInfo"]:
        out[one["type"]] += one["cpuTime"]
    return out


def rows(size_m: float, seconds: float) -> list[dict[str, Any]]:
    nodes = split(build_mesh(load_machine(MACHINE), size_m))
    case = f"series-wound motor, {nodes.size} nodes, {len(nodes.tets)} tets, 1280 x 800, no graphics card"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files = [ours(nodes, folder), *([peer(nodes, folder)] if find_spec("trame_pyvista") else [])]
        found = [(file.stat().st_size / 1e6, *looked(file, seconds, file is files[0])) for file in files]
        live = served_live(nodes, folder, seconds) if len(files) > 1 else []
    columns = [[one[i] for one in found if i < len(one)] for i in range(len(MEASURES))]
    out = [row(case, *measure, values) for measure, values in zip(MEASURES, columns, strict=True)]
    mine = {one["measure"]: one["ours"] for one in out}
    name = "pyvista's live trame view"
    for measure, unit, value in zip(LIVE, ("s", "1/s", "MB/s", "ms"), live, strict=False):
        both = against(mine[measure], value) if measure in mine else {"ours": 0.0, "peer": value}
        out.append({"case": case, "measure": measure, "unit": unit, **both, "peer_name": name})
    return out


def against(ours: float, peer: float) -> dict[str, Any]:
    """Both and their ratio; a peer that drew nothing while it was watched has none, and the row says so."""
    return {"ours": ours, "peer": peer} | ({"ratio": ours / peer} if peer > 0 else {"remark": "the peer drew nothing"})


def row(case: str, measure: str, unit: str, values: list[float]) -> dict[str, Any]:
    """values : ours, and the peer's where it is installed"""
    out = {"case": case, "measure": measure, "unit": unit, "ours": values[0]}
    if len(values) == 1:
        return out
    return {**out, **against(values[0], values[1]), "peer_name": "pyvista's trame view (export_html)"}


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("--size-mm", type=float, default=30.0)
    parser.add_argument("--seconds", type=float, default=4.0, help="for which the machine is turned")
    asked = parser.parse_args()
    if not any(map(shutil.which, BROWSERS)) or find_spec("playwright") is None:
        print("skipped: needs playwright and a browser: apt-get install -y chromium")
        return
    found = rows(asked.size_mm / 1e3, asked.seconds)
    load = os.getloadavg()[0]
    for one in found:
        beside = f" {one['peer_name']} {one['peer']:8.3g}" if "peer" in one else ""
        beside += f"  ratio {one['ratio']:.2g}" if "ratio" in one else ""
        beside += f"  {one['remark']}" if "remark" in one else ""
        print(f"{one['measure']:38} {one['ours']:8.3g} {one['unit']:4}{beside}")
    write_rows(asked.json, "viz", found, load=load)


if __name__ == "__main__":
    main()
