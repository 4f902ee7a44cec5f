"""The page: mesh once, a few shapes of its temperature, amplitudes per instant; a script that draws them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geom.disk_cache import atomic_write
from geom.meshing.mesh import NamedMesh
from viz.colours import VERDICT, heat, missing, part_colours, power
from viz.data import Comparison, short
from viz.rendering.nodes import SplitMesh
from viz.rendering.scale import marks, rounded
from viz.viewer.error_map import ErrorMap, error_marks, packed_maps
from viz.viewer.flux import nodal_flux
from viz.viewer.low_rank import LowRank, low_rank
from viz.viewer.network import NetworkRun, network_document
from viz.viewer.packing import packed_integers, packed_numbers

Array = NDArray[np.float64]
FRAMES = 21  # instants of a test that the range of its errors is looked up at
STEP_K = 0.02  # of the shapes: small ones then take few bits


@dataclass(frozen=True)
class Earlier:
    """A test with an earlier revision.  fields : (n, n_nodes) degC;  readings : sensor -> (n_time,) degC"""

    fields: Array
    readings: Mapping[str, Array]


@dataclass(frozen=True)
class Recorded:
    """A test as the page plays it.

    times : (n,) s;  fields : (n, n_nodes) degC;  before : the same of the model before its last step, if there is one
    earlier : other revisions, as many for every test, named in the same order by `document`
    error_map : what its residuals tell between the sensors;  network : its heat flows at the same times
    """

    comparison: Comparison
    times: Array
    fields: Array
    before: Array | None = None
    earlier: tuple[Earlier, ...] = ()
    error_map: ErrorMap | None = None
    network: NetworkRun | None = None

    @property
    def states(self) -> list[Array]:
        """Fields of the model as it is, before its last step, and of the earlier revisions."""
        first = [self.fields] if self.before is None else [self.fields, self.before]
        return [*first, *(e.fields for e in self.earlier)]


def write_viewer(
    path: str | Path, title: str, nodes: SplitMesh, tests: Sequence[Recorded], positions: Mapping[str, Sequence[float]]
) -> Path:
    """Write the page and return its path. positions : sensor -> (m)"""
    path, page = Path(path), render(document(title, nodes, tests, positions))
    with atomic_write(path) as partial:
        partial.write_text(page, encoding="utf-8")
    return path


def document(
    title: str, nodes: SplitMesh, tests: Sequence[Recorded], positions: Mapping[str, Sequence[float]],
    conductivity: Mapping[str, tuple[float, float]] | None = None, revisions: Sequence[str] = ("now", "before"),
    mesh: NamedMesh | None = None,
) -> dict[str, Any]:  # fmt: skip
    """All the page draws.

    conductivity : part -> across and along the axis (W/m/K), for heat flux;  revisions : names of a test's states
    mesh : where the nodes of the tests' networks are
    """
    every, runs = [part for t in tests for part in t.states], [t.network for t in tests if t.network is not None]
    found = low_rank(np.concatenate(every))
    triangles, part = nodes.boundary()
    order = np.argsort(part, kind="stable")
    colours = part_colours(nodes.parts, nodes.identities)
    low, high = rounded(min(float(f.min()) for f in every), max(float(f.max()) for f in every))
    return {
        "title": title, "points": packed_numbers(nodes.points), "tets": packed_integers(_by_part(nodes)),
        "triangles": packed_integers(triangles[order]), "owner": packed_integers(nodes.owner[:, None]),
        "parts": [{"name": name, "colour": colours[name]} for name in nodes.parts],
        "mean": packed_numbers(found.mean[:, None]), "shapes": packed_numbers(found.shapes.T, found.steps(STEP_K)),
        "revisions": list(revisions), "tests": _tests(tests, found, positions), "marks": marks(low, high),
        "change_marks": _change(tests), "heat": _palette(heat()), "missing": _palette(missing()),
        "k": conductivity and [conductivity[name] for name in nodes.parts], "power": _palette(power()),
        "flux_marks": conductivity and _flux(nodes, tests, conductivity), "errors": _errors(tests),
        "network": _network(mesh, nodes, runs) if len(runs) == len(tests) else None,
        "tints": [[int(c[i : i + 2], 16) / 255 for i in (1, 3, 5)] for c in VERDICT.values()],
    }  # fmt: skip


def render(shown: Mapping[str, Any]) -> str:
    """The page as text. The data stand in a block that no browser runs."""
    page, css = (files("viz.viewer").joinpath(f"viewer.{end}").read_text(encoding="utf-8") for end in ("html", "css"))
    data = json.dumps(shown, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    for key, text in (("TITLE", escape(shown["title"])), ("CSS", css), ("DATA", data), ("SCRIPT", script())):
        page = page.replace(f"@{key}@", text, 1)
    return page


def script() -> str:
    """All that the page runs."""
    return "\n".join(files("viz.viewer").joinpath(f"{n}.js").read_text(encoding="utf-8") for n in ("network", "viewer"))


def _change(tests: Sequence[Recorded]) -> list[float]:
    """Round marks for the difference of any two states (K), as far below zero as above."""
    changes = [float(np.ptp(np.stack(t.states), axis=0).max()) for t in tests if len(t.states) > 1]
    return marks(*rounded(-max(changes, default=1.0), max(changes, default=1.0)))


def _errors(tests: Sequence[Recorded]) -> dict[str, Any] | None:
    """What residuals tell between the sensors, if it is known for every test."""
    maps = [t.error_map for t in tests if t.error_map is not None]
    if len(maps) < len(tests):
        return None
    return {**packed_maps(maps), "marks": error_marks(maps, [t.comparison for t in tests], FRAMES)}


def _network(mesh: NamedMesh | None, nodes: SplitMesh, runs: Sequence[NetworkRun]) -> dict[str, Any] | None:
    """The network, if any of its nodes has a place in the mesh."""
    return (network_document(mesh, nodes, runs) or None) if mesh is not None else None


def _flux(nodes: SplitMesh, tests: Sequence[Recorded], conductivity: Mapping[str, tuple[float, float]]) -> list[float]:
    """Round marks for the heat flux (kW/m2) of every test's end, the densest twentieth of the nodes left out."""
    ends = [nodal_flux(nodes, t.fields[-1], conductivity) for t in tests]
    return marks(*rounded(0.0, max(float(np.quantile(q, 0.95)) for q in ends)))


def _by_part(nodes: SplitMesh) -> NDArray[np.int64]:
    return nodes.tets[np.argsort(nodes.region, kind="stable")]


def _tests(tests: Sequence[Recorded], found: LowRank, positions: Mapping[str, Sequence[float]]) -> list[dict[str, Any]]:
    """Amplitudes in the order in which the fields were given."""
    out, first = [], 0
    for test in tests:
        n, count = len(test.times), len(test.states)
        states = [_digits(found.amplitudes[first + i * n : first + (i + 1) * n], 3) for i in range(count)]
        first += n * count
        name = f"{test.comparison.test.name} ({test.comparison.test.role})"
        out.append({
            "name": name, "times": test.times.tolist(), "states": states, "sensors": _sensors(test, positions),
        })  # fmt: skip
    return out


def _sensors(test: Recorded, positions: Mapping[str, Sequence[float]]) -> list[dict[str, Any]]:
    """Readings at the page's instants; null where nothing was read, and for a place that is not known."""
    shown, clock = test.comparison, np.asarray(test.comparison.test.time, float)
    at = np.clip(np.searchsorted(clock, test.times), 0, len(clock) - 1)
    last = [] if test.before is None or shown.before is None else [shown.before]
    models = [shown.model, *last, *(e.readings for e in test.earlier)]
    return [
        {
            "name": short(c.name), "xyz": [float(x) for x in positions[c.name]] if c.name in positions else None,
            "limit": shown.limit_K(c),
            "measured": _digits(np.asarray(c.y, float)[at], 2),
            "models": [_digits(np.asarray(of[c.name])[at], 2) for of in models],
        }
        for c in shown.channels
    ]  # fmt: skip


def _digits(values: Array, digits: int) -> Any:
    """Rounded lists; null for what is not finite."""
    if values.ndim > 1:
        return [_digits(row, digits) for row in values]
    return [round(float(v), digits) if np.isfinite(v) else None for v in values]


def _palette(colours: Any) -> list[int]:
    return (np.asarray(colours(np.linspace(0, 1, 256)))[:, :3] * 255).round().astype(int).ravel().tolist()
