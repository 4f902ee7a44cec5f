"""Pages of the viewer, and a browser that draws them: shared by the tests of pages."""

import base64
import shutil
import zlib
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
from small_motor import motor

from geom.plugins import plugins
from lumped.model.network import Row
from measured.case import Channel, Test
from viz import split
from viz.data import Comparison
from viz.viewer.page import ErrorMap, Recorded, analysis_document, machine_document, render, temperature_document
from viz.viewer.part_shapes import UNKNOWN, NetworkRun

NODES = split(motor(24))
TIMES = np.linspace(0.0, 3600.0, 13)
PLACE = {"T_housing": (0.0, 0.22, 0.3), "T_shaft": (0.0, 0.0, 0.3)}
BROWSER = shutil.which("chromium") or shutil.which("google-chrome")
GL = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
)  # by software: it needs no graphics card
TOP = "viewer.pick($('gl').clientWidth * 0.45, $('gl').clientHeight * 0.5)"


def warming(hot: float) -> np.ndarray:
    """Each part with a time constant of its own: not a product of one shape and one curve."""
    tau = 600.0 * (1 + NODES.owner)
    return 20.0 + hot * (1 - np.exp(-TIMES[:, None] / tau)) * (1 + NODES.points[:, 2])


def recorded(before: bool = True) -> Recorded:
    row = Row(np.array([0]), np.array([1.0]))
    model = {n: 20.0 + 30.0 * (1 - np.exp(-TIMES / 900.0)) for n in PLACE}
    channels = tuple(Channel(n, n, row, model[n] + 5.0) for n in PLACE)
    test = Test("hour", "hold-out", TIMES, {}, {"ambient": np.full(TIMES.size, 20.0)}, channels)
    return Recorded(
        Comparison(test, model, dict.fromkeys(model, 1.0)), TIMES, warming(60.0), warming(50.0) if before else None
    )


def mapped() -> Recorded:
    """One residual tells more along the axis, the other less; the left half is known, the right a guess."""
    share = (NODES.points[:, 2] - NODES.points[:, 2].min()) / np.ptp(NODES.points[:, 2])
    between = ErrorMap(tuple(PLACE), np.stack([share, 0.3 * (1.0 - share)], axis=1), 1.0 - share)
    part = NODES.parts[:2]
    T = {name: np.linspace(20.0, 60.0 + i, TIMES.size) for i, name in enumerate(part)}
    run = NetworkRun(T, {part: np.linspace(0.0, -120.0, TIMES.size)}, {part: 3.0})
    return replace(recorded(), error_map=between, network=run)


def document(title, nodes, tests, positions, k=None, revisions=("now", "before"), mesh=None, limits=None, machine=None):
    """All that a page draws.  machine : is drawn as it looks, too;  mesh : of the tests' networks"""
    looks = None if machine is None else plugins("sections")["looks"].packed_looks(machine, nodes)
    temperatures = temperature_document(nodes, tests, positions, k, revisions, limits)
    return {**machine_document(title, nodes, k, looks), **temperatures, **analysis_document(tests, nodes, mesh)}


def write_viewer(path, title, nodes, tests, positions):
    path.write_text(render(document(title, nodes, tests, positions)), encoding="utf-8")
    return path


def still(page):
    """Wait until the page has taken a new size, which it does between two frames, and has drawn what follows."""
    page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    page.wait_for_function("!viewer.dirty && viewer.smooth")


@contextmanager
def tab(browser, file: Path, width: int = 800, height: int = 600):
    """The page of a file once it has drawn, and what it says on the console; in a tab that shares nothing."""
    context = browser.new_context(viewport={"width": width, "height": height})
    page, said = context.new_page(), []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda fault: said.append(str(fault)))
    try:
        page.goto(file.as_uri())
        page.wait_for_function("window.viewer && viewer.frames > 0")
        yield page, said
    finally:
        context.close()


def unpacked(packed):
    """What the page reads: (n, k)."""
    columns = packed["columns"]
    planes = np.frombuffer(zlib.decompress(base64.b64decode(packed["data"])), np.uint8).reshape(4, -1)
    unsigned = np.ascontiguousarray(planes.T).view("<u4").reshape(columns, -1).T.astype(np.int64)
    whole = np.cumsum(np.where(unsigned % 2, -(unsigned + 1) // 2, unsigned // 2), axis=0)
    if "step" not in packed:
        return whole
    return np.where(whole == UNKNOWN, np.nan, whole * np.array(packed["step"]) + np.array(packed["low"]))


def mixed(packed):
    """What the page mixes: (n_fields, n_nodes)."""
    weights, first, out = unpacked(packed["weights"]), 0, []
    for block in map(unpacked, packed["blocks"]):
        out.append(weights[:, first : first + block.shape[1]] @ block.T)
        first += block.shape[1]
    return np.hstack(out)
