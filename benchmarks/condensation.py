"""Condensed networks against the fields they come from, on the same mesh: how far off, and what they cost.

    python benchmarks/condensation.py [MACHINE ...] [--coarse] [--accuracy PERCENT] [--json FILE] [--table FILE]
    python benchmarks/condensation.py --offline [--json FILE]      what condensing the motor on 150,000 nodes costs

For every machine of the library, or those named: the network that `thermoscope model build --accuracy` keeps, at
coefficients and load cases not seen before (`condensed/points.py`). Errors are in percent of a part's own rise, at
least a tenth of the machine's largest; after a step of loss, hot spots and points in percent of the largest rise then.
"wanted" is what the network is built for. Shapes are found anew: the cache of earlier builds is not used.
"""

import json
import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from condensed.cost import Row, offline_rows
from condensed.points import Pair, Point

from fem.solvers.solve import Fluids, steady
from geom import library, load_machine
from lumped.build.network_size import NetworkSize, smallest_network
from lumped.build.pipeline import Meshing
from lumped.condensation.reduction_error import Errors, errors, merged
from lumped.model.network import Network
from scripts.published import benchmark_parser, measured_row as row, publish, table, write_rows

WANTED = {"mean": 1.0, "hot": 2.0, "point": 2.0}
AT_RANDOM = {**WANTED, "hot": 3.0}
BALANCED = 1e-10
COARSE = {"how": Meshing(0.1, 36, 1, 0.2)}


def machine_rows(name: str, mesh: Mapping[str, Any], accuracy: float) -> Iterator[Row]:
    """Size and cost of the network, its errors, and the balances of both."""
    start = time.process_time()
    found = smallest_network(load_machine(name), accuracy, **mesh)
    yield row(name, "unknowns of the field", "1", found.built.field.n)
    yield row(name, "states", "1", len(found.built.network.states))
    yield row(name, "build, with error against size", "s CPU", time.process_time() - start)
    pair = Pair.of(found)
    points = [(point, pair.of_field(point), pair.of_network(point)) for point in pair.points()]
    for group in dict.fromkeys(point.group for point, _, _ in points):
        seen = {p.name: over_loads(pair.network, T, z) for p, T, z in points if p.group == group}
        yield from error_rows(name, group, seen, AT_RANDOM if group == "random" else WANTED)
    for point in (points[0][0], pair.random(9)):
        yield from error_rows(name, f"step of loss, {point.group}", after_step(pair, point), WANTED)
    balance = max(unbalanced(pair, point, z) for point, _, z in points)
    yield row(name, "heat of a part or the machine left over", "1", balance, BALANCED, "wanted")
    yield row(name, "energy in minus out of the field", "1", energy(pair), 1e-9, "wanted")
    yield from recovery_rows(found, points[0][2][:, 0])


def over_loads(network: Network, T: np.ndarray, z: np.ndarray, **floors: Any) -> Errors:
    return merged([errors(network, full, x, **floors) for full, x in zip(T.T, z[: len(network.states)].T, strict=True)])


def after_step(pair: Pair, point: Point) -> dict[str, Errors]:
    """Means in percent of a part's own rise, hot spots and points of the machine's largest at that time."""
    out = {}
    for t, T, z in pair.stepped(point):
        own, largest = over_loads(pair.network, T, z), over_loads(pair.network, T, z, floor=1.0)
        out[f"{t:g} s"] = Errors(
            own.mean, largest.hot, largest.point, own.mean_part, largest.hot_part, largest.point_part, own.parts
        )
    return out


def error_rows(machine: str, group: str, seen: dict[str, Errors], wanted: dict[str, float]) -> Iterator[Row]:
    """The worst of each kind, and where it arises."""
    for kind, limit in wanted.items():
        at = max(seen, key=lambda name: getattr(seen[name], kind))
        where = f"{getattr(seen[at], f'{kind}_part')}, {at}"
        yield {**row(machine, f"{kind}, {group}", "%", getattr(seen[at], kind), limit, "wanted"), "where": where}


def unbalanced(pair: Pair, point: Point, z: np.ndarray) -> float:
    """Largest |loss - heat through faces and contacts| of a part, or of all, over all losses; heat read from means."""
    network, zones = pair.network, pair.reduction.zones
    left = {part: np.zeros(z.shape[1]) for part in pair.reduction.field.blocks}
    for zone, watts in zip(zones.values(), pair.watts, strict=True):
        left[zone.part] += watts
    columns = [network.column(name) for name in pair.fluids]
    out = {"fluids": pair.heat.sum(0) - point.flow * (pair.streams @ z[columns]).sum(0)}
    for place in network.places.values():
        if place.kind == "surface":
            flow = point.films[place.name] * (_read(place.mean, z) - z[network.column(str(place.fluid))])
            left[place.part] -= place.area * flow
            out["fluids"] += place.area * flow * (place.fluid in pair.fluids)
    for link in network.links:
        if link.kind == "contact":
            key = link.name.removeprefix("contact:")
            area = pair.reduction.field.contacts[key].area
            flow = point.contacts[key] * area * (_read(link.hot, z) - _read(link.cold, z))
            left[link.places[0]] -= flow
            left[link.places[1]] += flow
    scale = np.abs(pair.watts).sum(0) + np.abs(pair.heat).sum(0)
    return max(float(np.max(np.abs(heat) / scale)) for heat in (*left.values(), *out.values(), sum(left.values())))


def _read(mean: Any, z: np.ndarray) -> np.ndarray:
    return mean.weights @ z[mean.index]


def energy(pair: Pair) -> float:
    """Of the field with the rated losses, what went in minus what came out, over what went in."""
    r = pair.reduction
    fluids = Fluids(pair.fluids, pair.streams, pair.heat[:, 0], dict.fromkeys(pair.network.boundaries, 0.0))
    return steady(r.solver, r.films, r.contacts, pair.field_loads[:, 0], fluids).energy_balance


def recovery_rows(found: NetworkSize, z: np.ndarray) -> Iterator[Row]:
    """Milliseconds for the whole field, the hot spot of every part, and one more sensor."""
    network, field = found.built.network, found.built.field
    shapes, x = network.recovery, z[: len(network.states)]
    part = max(field.blocks, key=lambda p: len(field.blocks[p].points))
    xyz = field.blocks[part].xyz[field.blocks[part].tets[0]].mean(0)
    yield row(found.built.machine.name, "the whole field from a state", "ms", milliseconds(lambda: shapes.field(x)))
    yield row(
        found.built.machine.name,
        "every part's hot spot",
        "ms",
        milliseconds(lambda: [shapes.hot_spot(p, x) for p in field.blocks]),
    )
    shapes.row(part, xyz)
    yield row(found.built.machine.name, "one more sensor at x, y, z", "ms", milliseconds(lambda: shapes.row(part, xyz)))


def milliseconds(job: Callable[[], object], times: int = 20) -> float:
    start = time.process_time()
    for _ in range(times):
        job()
    return 1e3 * (time.process_time() - start) / times


def shown(r: Row) -> Row:
    """The same row, printed beside the document."""
    peer = f"   {r['peer_name']} {r['peer']:.3g}{'' if r['ratio'] <= 1 else '   MISSED'}" if r["peer"] else ""
    print(
        f"{r['case']:34} {r['measure']:42} {r['ours']:10.3g} {r['unit']:6}{peer:24} {r.get('where', '')}",
        file=sys.stderr,
    )
    return r


GROUPS: tuple[str, ...] = ("nominal", "all films", "one film x10", "contacts")
GROUPS += ("gap, flow", "random", "step of loss, nominal", "step of loss, random")


def accuracy_table(rows: list[Row]) -> str:
    """One line per machine in Markdown: mean / hot spot / point in percent."""
    rows = [r for r in rows if not r["case"].startswith("motor,")]
    value = {(r["case"], r["measure"]): r["ours"] for r in rows}
    head = ["machine", "unknowns", "states", *GROUPS]
    lines = []
    for name in sorted({r["case"] for r in rows}):
        cells = [f"{value[name, 'unknowns of the field']:.0f}", f"{value[name, 'states']:.0f}"]
        cells += [" / ".join(f"{value[name, f'{kind}, {group}']:.2g}" for kind in WANTED) for group in GROUPS]
        lines.append([name, *cells])
    return table(head, lines)


def kept(file: Path | None, machines: list[str]) -> list[Row]:
    """Rows of an earlier run that are not measured again."""
    rows = json.loads(file.read_text())["rows"] if file and file.exists() else []
    return [r for r in rows if r["case"] not in machines]


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("machines", nargs="*", metavar="MACHINE", help="names of the library; all if none is given")
    parser.add_argument("--offline", action="store_true", help="only what condensing a large motor costs")
    parser.add_argument("--coarse", action="store_true", help="a mesh half as fine as of `thermoscope model build`")
    parser.add_argument("--accuracy", type=float, default=2.0, help="percent, as of `thermoscope model build`")
    parser.add_argument("--table", metavar="PAGE", help="put the table between the markers of this Markdown page")
    given = parser.parse_args()
    rows = kept(given.json, given.machines or ([] if given.offline else library()))
    with tempfile.TemporaryDirectory() as cold:
        os.environ["THERMOSCOPE_CACHE"] = cold
        rows += [shown(r) for r in offline_rows()] if given.offline else []
        for name in [] if given.offline else given.machines or library():
            rows += [shown(r) for r in machine_rows(name, COARSE if given.coarse else {}, given.accuracy)]
    write_rows(given.json, "condensation", rows)
    if given.table:
        publish(Path(given.table), "accuracy", accuracy_table(rows))


if __name__ == "__main__":
    main()
