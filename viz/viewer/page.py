"""The page: mesh once, a few shapes of its temperature, amplitudes per instant; a script that draws them."""

import json
import math
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from importlib.resources import files
from typing import Any

import numpy as np

from geom.arrays import Array, Ints
from geom.meshing.mesh import NamedMesh
from viz.colours import VERDICT, heat, marks, missing, part_colours, power, rgb, rounded
from viz.data import Comparison, late_mean, short
from viz.rendering.flux import nodal_flux
from viz.rendering.nodes import SplitMesh
from viz.viewer.part_shapes import ERROR_K, NetworkRun, network_document, packed_fields, packed_integers, packed_numbers

ERROR = 0.02  # of a residual: far below what a sensor can tell
STEP = 0.008  # of a residual, of the shapes at their largest amplitude
SHARE = 0.02  # in which steps the explained share is kept
PEAK = 0.99  # of the instants whose largest error the colours reach: the first seconds of a start are left out


@dataclass(frozen=True)
class ErrorMap:
    """Measured minus modelled everywhere, as the page mixes it: what each sensor's residual tells at every node.

    sensors : names of m channels;  gain : (n_nodes, m) K/K;  explained : (n_nodes,) share of the variance, see
    validation.comparison.interpolation"""

    sensors: tuple[str, ...]
    gain: Array
    explained: Array

    def at(self, residual_K: Mapping[str, Array]) -> Array:
        """(n_nodes, n) K from residuals (n,) K; what was not read tells nothing."""
        return np.asarray(self.gain @ np.nan_to_num(np.stack([residual_K[name] for name in self.sensors])))


def packed_maps(maps: Sequence[ErrorMap], nodes: SplitMesh) -> dict[str, Any]:
    """gains : of every test and sensor, in the order of their names;  told : of every test, the explained share."""
    return {
        "gains": packed_fields(np.concatenate([m.gain.T for m in maps]), nodes, ERROR, STEP),
        "sensors": [[short(name) for name in m.sensors] for m in maps],
        "told": packed_fields(np.stack([m.explained for m in maps]), nodes, SHARE, SHARE),
    }


FRAMES = 21  # instants of a test that the range of its errors is looked up at
UNSEEN = 0.02  # of a range of colours: what lies beyond it by less has its last colour
STEP_K = 0.02  # of fields and readings: a twentieth of what a thermocouple tells, and small shapes then take few bits


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
    absent : parts that are not there in this test: of several bases those that the machine does not stand on
    """

    comparison: Comparison
    times: Array
    fields: Array
    before: Array | None = None
    earlier: tuple[Earlier, ...] = ()
    error_map: ErrorMap | None = None
    network: NetworkRun | None = None
    absent: Collection[str] = ()

    @property
    def states(self) -> list[Array]:
        """Fields of the model as it is, before its last step, and of the earlier revisions."""
        first = [self.fields] if self.before is None else [self.fields, self.before]
        return [*first, *(e.fields for e in self.earlier)]


def analysis_document(tests: Sequence[Recorded], nodes: SplitMesh, mesh: NamedMesh | None) -> dict[str, Any]:
    """What can follow: residuals between the sensors; heat flows of the network, its nodes placed in the mesh."""
    runs = [t.network for t in tests if t.network is not None]
    # None, too, where none of its nodes has a place in the mesh
    network = (network_document(mesh, nodes, runs) or None) if mesh is not None and len(runs) == len(tests) else None
    return {"errors": _errors(tests, nodes), "network": network}


def machine_document(
    title: str, nodes: SplitMesh, conductivity: Mapping[str, tuple[float, float]] | None, looks: dict[str, Any] | None
) -> dict[str, Any]:
    """The machine without temperatures, and the colours of all that a page shows.

    conductivity : part -> across and along the axis (W/m/K), for heat flux;  looks : of `packed_looks`
    """
    order, colours = np.argsort(nodes.region, kind="stable"), part_colours(nodes.parts, nodes.identities)
    # Bits: 1, 2, 4, 8 for faces that bound their part, 16, 32, 64, 128 where another part lies on them
    faces = np.asarray(nodes.outer() @ [1, 2, 4, 8] + nodes.touching() @ [16, 32, 64, 128])
    sizes = np.bincount(nodes.owner, minlength=len(nodes.parts)).tolist()  # parts follow one another
    return {
        "title": title,
        "points": packed_numbers(nodes.points),
        "tets": packed_integers(nodes.tets[order]),
        "faces": packed_integers(faces[order, None]),
        "parts": [{"name": p, "colour": colours[p], "nodes": n} for p, n in zip(nodes.parts, sizes, strict=True)],
        "looks": looks,
        "k": conductivity and [conductivity[name] for name in nodes.parts],
        "heat": _palette(heat()),
        "missing": _palette(missing()),
        "power": _palette(power()),
        "tints": [[part / 255 for part in rgb(c)] for c in VERDICT.values()],
    }


def temperature_document(
    nodes: SplitMesh,
    tests: Sequence[Recorded],
    positions: Mapping[str, Sequence[float]],
    conductivity: Mapping[str, tuple[float, float]] | None,
    revisions: Sequence[str],
    limits: tuple[float, float] | None,
) -> dict[str, Any]:
    """Temperatures and readings of tests; those of more tests replace them.

    revisions : names of a test's states;  limits : of the colours (degC), wider where a state is clearly beyond
    """
    every = [part for t in tests for part in t.states]
    low, high = limits or (math.inf, -math.inf)
    slack = UNSEEN * (high - low) if limits else 0.0
    ends = [end for f in every for end in map(float, (f.min(), f.max())) if not low - slack <= end <= high + slack]
    low, high = rounded(min(low, *ends), max(high, *ends)) if ends else rounded(low, high)
    out, first = [], 0
    for test in tests:
        n, count = len(test.times), len(test.states)
        name = f"{test.comparison.test.name} ({test.comparison.test.role})"
        states = [first + i * n for i in range(count)]
        run = {"test": test.comparison.test.name, "name": name, "times": test.times.tolist(), "states": states}
        absent = [k for k, part in enumerate(nodes.parts) if part in test.absent]
        out.append({**run, "absent": absent, **_sensors(test, positions)})
        first += n * count
    changes = [float(np.ptp(np.stack(t.states), axis=0).max()) for t in tests if len(t.states) > 1]
    return {
        "fields": packed_fields(np.concatenate(every), nodes, ERROR_K, STEP_K),
        "revisions": list(revisions),
        "tests": out,
        "marks": marks(low, high),
        "change_marks": marks(*rounded(-max(changes, default=1.0), max(changes, default=1.0))),
        "flux_marks": conductivity and _flux(nodes, tests, conductivity),
    }


def with_limits(content: Mapping[str, Any], limits: Mapping[str, Mapping[str, float]]) -> dict[str, Any]:
    """The same with the largest errors that count as agreement (K): test -> channel -> limit."""
    tests = []
    for test in content["tests"]:
        of = limits[test["test"]]
        tests.append({**test, "sensors": [{**s, "limit": of.get(s["channel"])} for s in test["sensors"]]})
    return {**content, "tests": tests}


def render(content: Mapping[str, Any]) -> str:
    """The page as text. The data stand in a block that no browser runs."""
    page, css = (files("viz.viewer").joinpath(f"viewer.{end}").read_text(encoding="utf-8") for end in ("html", "css"))
    data = json.dumps(content, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    pieces = {"@TITLE@": escape(content["title"]), "@CSS@": css, "@DATA@": data, "@SCRIPT@": script()}
    return re.sub("|".join(pieces), lambda mark: pieces[mark[0]], page)  # once: a piece may hold a mark


def script() -> str:
    """All that the page runs."""
    return "\n".join(files("viz.viewer").joinpath(f"{n}.js").read_text(encoding="utf-8") for n in ("network", "viewer"))


def _errors(tests: Sequence[Recorded], nodes: SplitMesh) -> dict[str, Any] | None:
    """What residuals tell between the sensors, if it is known for every test."""
    maps = [t.error_map for t in tests if t.error_map is not None]
    if len(maps) < len(tests):
        return None
    most = []
    for m, c in zip(maps, [t.comparison for t in tests], strict=True):
        at = np.linspace(0, len(c.test.time) - 1, FRAMES).astype(int)
        channels = {channel.name: channel for channel in c.channels}
        most.append(np.abs(m.at({name: c.residual(channels[name])[at] for name in m.sensors})).max(axis=0))
    high = max(float(np.quantile(one, PEAK)) for one in most)
    return {**packed_maps(maps, nodes), "marks": marks(*rounded(-high, high))}


def _flux(nodes: SplitMesh, tests: Sequence[Recorded], conductivity: Mapping[str, tuple[float, float]]) -> list[float]:
    """Round marks for the heat flux (kW/m2) of every test's end, the densest twentieth of the nodes left out."""
    ends = [nodal_flux(nodes, t.fields[-1], conductivity) for t in tests]
    return marks(*rounded(0.0, max(float(np.quantile(q, 0.95)) for q in ends)))


def _sensors(test: Recorded, positions: Mapping[str, Sequence[float]]) -> dict[str, Any]:
    """Sensors, their readings and those of every model at the page's instants: a column each. No place is null.

    rmse, late : of every model a number (K) per sensor, over the whole test and its last fifth: they tell its colour
    """
    comparison, clock = test.comparison, np.asarray(test.comparison.test.time, float)
    at = np.clip(np.searchsorted(clock, test.times), 0, len(clock) - 1)
    last = [] if test.before is None or comparison.before is None else [comparison.before]
    models = [comparison.model, *last, *(e.readings for e in test.earlier)]
    places = [[float(x) for x in positions[c.name]] if c.name in positions else None for c in comparison.channels]
    pairs = zip(comparison.channels, places, strict=True)
    comparisons = [replace(comparison, model=of, before=None) for of in models]
    return {
        "sensors": [
            {"channel": c.name, "name": short(c.name), "xyz": xyz, "limit": comparison.limits.get(c.name)}
            for c, xyz in pairs
        ],
        "measured": _columns([c.y for c in comparison.channels], at),
        "models": [_columns([of[c.name] for c in comparison.channels], at) for of in models],
        "rmse": [[one.rmse(c) for c in comparison.channels] for one in comparisons],
        "late": [[late_mean(one.residual(c)) for c in comparison.channels] for one in comparisons],
    }


def _columns(values: Sequence[Array], at: Ints) -> dict[str, Any]:
    return packed_numbers(np.stack([np.asarray(v, float)[at] for v in values], axis=1), STEP_K)


def _palette(colours: Any) -> list[int]:
    return (np.asarray(colours(np.linspace(0, 1, 256)))[:, :3] * 255).round().astype(int).ravel().tolist()
