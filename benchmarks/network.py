"""Network time stepping against general ODE solvers: same network, same record, same run.

    python benchmarks/network.py [--only peers] [--json FILE]

30 nodes, 3,600 s at 1 s with radiation, natural convection and copper feedback, on three records: a road (inputs change
every second, so no solver may step over a sample), steps (a minute or five apart) and smooth inputs.
Errors are the largest difference to scipy Radau at rtol 1e-10 over all nodes and times. Times are CPU seconds, best of
three for us, after compiling; ensembles and first calls are wall seconds.
"""

import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from peers.network import peers, reference

from lumped.integration.ensemble import dask_cluster, ensemble
from lumped.integration.simulate import Record, simulate
from lumped.model.build import bare_network, node_link, node_source
from lumped.model.network import Network, Parameter
from lumped.transfer.laws import Fixed, InputPower, Linear, Power, Radiation
from scripts.published import benchmark_parser, measured_row as row, print_rows, timed, write_rows

MEMBERS = 1000


def ring(n: int) -> Network:
    """A ring of n nodes; every third radiates, every third convects, one carries a copper loss, one an iron loss."""
    random = np.random.default_rng(0)
    net = bare_network(f"ring {n}", {f"n{i}": 300.0 + 400.0 * random.random() for i in range(n)}, ("ambient",))
    links = [
        node_link(net, f"g{i}", "link", f"n{i}", f"n{(i + 1) % n}", Fixed(3 + 4 * random.random())) for i in range(n)
    ]
    links += [node_link(net, f"r{i}", "film", f"n{i}", "ambient", Fixed(0.1, Radiation())) for i in range(0, n, 3)]
    links += [node_link(net, f"c{i}", "film", f"n{i}", "ambient", Fixed(0.5, Power(0.25))) for i in range(1, n, 3)]
    copper = InputPower(100.0 * n / 30, (("current_A", 10.0, 2.0),), Linear(0.0039, 20.0))
    iron = InputPower(50.0 * n / 30, (("speed_rpm", 1000.0, 1.5),))
    sources = [
        node_source(net, "copper", "copper", {"n3": 1.0}, copper),
        node_source(net, "iron", "iron", {f"n{n // 2}": 1.0}, iron),
    ]
    parameters = tuple(Parameter(link.name, ((link.name, 1.0),)) for link in links)
    return net.extended(links, sources, parameters)


def record(seconds: int, step: float = 1.0) -> Record:
    """As measured on a road: current and speed change from sample to sample, with stops."""
    t = np.arange(0.0, seconds + 0.5 * step, step)
    noise = np.random.default_rng(1).standard_normal((2, t.size))
    moving = np.sin(t / 47) > -0.7
    current = np.abs(10 + 3 * np.sin(t / 200) + 3 * noise[0]) * moving
    given = {"current_A": current, "speed_rpm": np.abs(1000 + 500 * np.cos(t / 300) + 60 * noise[1]) * moving}
    return Record(t, given, {"ambient": 20 + 5 * np.sin(t / 1000)}, 20.0)


def smooth(seconds: int) -> Record:
    """As on a test bed: current, speed and air change over minutes; a solver may take steps over many samples."""
    t = np.arange(0.0, seconds + 0.5)
    given = {"current_A": 10 + 3 * np.sin(t / 200), "speed_rpm": 1000 + 500 * np.cos(t / 300)}
    return Record(t, given, {"ambient": 20 + 5 * np.sin(t / 1000)}, 20.0)


def stepped(seconds: int) -> Record:
    """As on a duty cycle: current and speed hold for a minute or five and change within a second."""
    rec, random = smooth(seconds), np.random.default_rng(3)
    edges = np.cumsum(random.integers(60, 300, seconds // 60 + 1))
    k = np.searchsorted(edges, rec.time)
    given = {
        "current_A": random.uniform(0, 15, edges.size + 1)[k],
        "speed_rpm": random.uniform(0, 1500, edges.size + 1)[k],
    }
    return Record(rec.time, given, rec.boundaries, 20.0)


RECORDS = {"road": record, "steps": stepped, "smooth": smooth}


def against_peers() -> list[dict[str, Any]]:
    """On each kind of record: ours, and each peer at equal error and at its usual tolerance."""
    net, out = ring(30), []
    simulate(net, record(3), keep_states=True)
    for kind, make in RECORDS.items():
        rec = make(3600)
        _, seconds, curve = timed(lambda rec=rec: simulate(net, rec, keep_states=True).z[:, :30], 3)
        exact, case = reference(net, rec), f"30 nodes, 3600 samples, {kind}"
        error = float(np.abs(curve - exact).max())
        for name, peer_seconds, peer_error in peers(net, rec, exact, error, kind == "road"):
            out.append(row(case, "time", "s", seconds, peer_seconds, name))
            out.append(row(case, "largest error", "K", error, peer_error, name))
        if kind == "road":
            out += tangents(net, rec, seconds)
    return out


def tangents(net: Network, rec: Record, seconds: float) -> list[dict[str, Any]]:
    mean = [net.place("n0").mean]
    simulate(net, record(3), rows=mean, tangents=net.parameters[:40])
    _, cost, _ = timed(lambda: simulate(net, rec, rows=mean, tangents=net.parameters[:40]), 3)
    return [row("30 nodes, 40 sensitivities", "time", "s", cost, 10 * seconds, "10 runs")]


def sizes() -> list[dict[str, Any]]:
    """Cost over time (linear) and over the number of nodes."""
    small, mean = ring(10), [ring(10).place("n0").mean]
    out = []
    for hours in (1, 3, 9, 27):
        _, cost, _ = timed(lambda hours=hours: simulate(small, record(3600 * hours), rows=mean), 2)
        out.append(row(f"10 nodes, {hours} h at 1 Hz", "time", "s", cost))
    for n in (10, 30, 100, 300):
        network = ring(n)
        _, cost, _ = timed(lambda network=network: simulate(network, record(3600, 10.0)), 2)
        out.append(row(f"{n} nodes, 360 steps", "time", "s", cost))
    return out


def ensembles() -> list[dict[str, Any]]:
    """1,000 members of 30 nodes and 360 steps: one thread, a thread per core, and a local Dask cluster."""
    net, rec, random = ring(30), record(3600, 10.0), np.random.default_rng(2)
    members = [{p.name: float(np.exp(0.2 * random.standard_normal())) for p in net.parameters} for _ in range(MEMBERS)]
    rows = [net.place("n0").mean]
    with ThreadPoolExecutor(1) as alone:
        one, _, expected = timed(lambda: ensemble(net, rec, members, rows, alone))
    all_cores, _, y = timed(lambda: ensemble(net, rec, members, rows))
    assert np.array_equal(y, expected)
    cores, case = os.cpu_count(), f"{MEMBERS} members, 30 nodes, 360 steps"
    out = [row(case, f"time, {cores} threads", "s", all_cores, one, "1 thread")]
    try:
        from distributed import LocalCluster
    except ImportError:
        return out
    options = {"n_workers": cores, "threads_per_worker": 1, "dashboard_address": None}
    with LocalCluster(**options) as cluster, dask_cluster(cluster.scheduler_address) as executor:
        ensemble(net, rec, members[: 4 * (cores or 1)], rows, executor, 1)
        spread, _, y = timed(lambda: ensemble(net, rec, members, rows, executor))
    assert np.array_equal(y, expected)
    return [*out, row(case, f"time, Dask, {cores} processes", "s", spread, one, "1 thread")]


FIRST = """
import time, sys
sys.path.insert(0, {here!r})
from network import record, ring
from lumped.integration.simulate import simulate
net, rec = ring(10), record(5)
for tangents in ((), net.parameters[:2]):
    start = time.process_time()
    simulate(net, rec, rows=[net.place("n0").mean], tangents=tangents)
    print(time.process_time() - start)
"""


def compiling() -> list[dict[str, Any]]:
    """CPU seconds of the first run and of the first with sensitivities, with an empty cache and with a full one."""
    out = []
    with tempfile.TemporaryDirectory() as cache:
        for state in ("nothing cached", "cached"):
            command = [sys.executable, "-c", FIRST.format(here=str(Path(__file__).parent))]
            done = subprocess.run(
                command, env={**os.environ, "NUMBA_CACHE_DIR": cache}, capture_output=True, text=True, check=True
            )
            plain, tangent = (float(line) for line in done.stdout.split())
            out.append(row(f"first run, {state}", "time", "s", plain))
            out.append(row(f"first sensitivities, {state}", "time", "s", tangent))
    return out


PARTS = {"compiling": compiling, "sizes": sizes, "ensembles": ensembles, "peers": against_peers}


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("--only", choices=list(PARTS), nargs="+", default=list(PARTS), help="parts of the benchmark")
    given = parser.parse_args()
    target = given.json
    rows: list[dict[str, Any]] = []
    for part in (PARTS[name] for name in given.only):
        rows += (found := part())
        print_rows(found, sys.stderr if str(target) == "-" else sys.stdout)
    write_rows(target, "network", rows)


if __name__ == "__main__":
    main()
