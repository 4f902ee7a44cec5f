"""Network time stepping against general ODE solvers: same network, same record, same run.

    python benchmarks/network.py [--json FILE]

30 nodes, 3,600 s at 1 s with radiation, natural convection and copper feedback; inputs change every second, so no
solver may step over a sample (max_step 1 s). On smooth inputs, where LSODA may take steps of 20 s, it is as fast.
Errors are the largest difference to scipy Radau at rtol 1e-10 over all nodes and times. Times are single-thread CPU
seconds, best of three for us.
"""

from __future__ import annotations

import argparse
import datetime
import json
import platform
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from lumped.build import bare_network, node_link, node_source
from lumped.laws import Fixed, InputPower, Linear, Power, Radiation
from lumped.network import Network, Parameter
from lumped.simulate import Record, simulate
from lumped.terms import SIGMA, SMOOTH, ZERO_C


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


def halved(rec: Record) -> Record:
    """The same record at half the step: the loss factors, not the inputs, are linear between the old times."""
    t = np.linspace(rec.time[0], rec.time[-1], 2 * rec.time.size - 1)
    exponents = {"current_A": 2.0, "speed_rpm": 1.5}
    given = {k: np.interp(t, rec.time, rec.inputs[k] ** p) ** (1 / p) for k, p in exponents.items()}
    return Record(t, given, {"ambient": np.interp(t, rec.time, rec.boundaries["ambient"])}, rec.initial)


def right_hand_side(net: Network, rec: Record) -> Callable[[float, np.ndarray], np.ndarray]:
    """The same equations as a NumPy function; factors and boundaries linear between the times, as in the kernel."""
    n = len(net.states)
    K, kinds = np.zeros((n, n + 1)), {"r": [], "c": []}
    for link in net.links:
        if link.name[0] == "g":
            np.add.at(K, (link.rows, link.cols), link.law.value * link.vals)
        else:
            kinds[link.name[0]].append(int(link.rows[0]))
    tables = [np.broadcast_to(s.law.factor(rec.inputs), rec.time.shape) for s in net.sources]
    hot, core = (int(s.index[0]) for s in net.sources)

    def f(t: float, x: np.ndarray) -> np.ndarray:
        ambient = np.interp(t, rec.time, rec.boundaries["ambient"])
        q = -(K @ np.append(x, ambient))
        T, A = x[kinds["r"]] + ZERO_C, ambient + ZERO_C
        q[kinds["r"]] -= 0.1 * SIGMA * (T**4 - A**4)
        d = x[kinds["c"]] - ambient
        q[kinds["c"]] -= 0.5 * (d * d + SMOOTH**2) ** 0.125 * d
        q[hot] += np.interp(t, rec.time, tables[0]) * (1 + 0.0039 * (x[hot] - 20.0))
        q[core] += np.interp(t, rec.time, tables[1])
        return q / net.C

    return f


def timed(run: Callable[[], object], repeats: int = 3) -> tuple[float, object]:
    """Best CPU seconds and the result."""
    best, out = np.inf, None
    for _ in range(repeats):
        start = time.process_time()
        out = run()
        best = min(best, time.process_time() - start)
    return best, out


def peers(net: Network, rec: Record) -> tuple[list[tuple[str, float, float]], np.ndarray]:
    """(name, CPU s, largest error K) of scipy's solvers at their usual tolerance, and the reference (nt, n)."""
    f, x0 = right_hand_side(net, rec), np.full(len(net.states), 20.0)
    span = (rec.time[0], rec.time[-1])

    def solve(method: str, rtol: float, atol: float) -> np.ndarray:
        return solve_ivp(f, span, x0, method, t_eval=rec.time, rtol=rtol, atol=atol, max_step=1.0).y.T

    print("reference ...", file=sys.stderr)
    reference = solve("Radau", 1e-10, 1e-9)
    out = []
    for method in ("LSODA", "BDF"):
        print(f"scipy {method} ...", file=sys.stderr)
        seconds, y = timed(lambda method=method: solve(method, 1e-6, 1e-5), 1)
        out.append((f"scipy {method}", seconds, float(np.abs(y - reference).max())))
    return out, reference


def rows() -> list[dict[str, Any]]:
    net, rec = ring(30), record(3600)
    simulate(net, record(3), keep_states=True)
    seconds, run = timed(lambda: simulate(net, rec, keep_states=True).z[:, :30])
    fine_seconds, fine = timed(lambda: simulate(net, halved(rec), keep_states=True).z[::2, :30])
    others, reference = peers(net, rec)
    out = []
    for case, cost, curve in (
        ("30 nodes, 3600 steps", seconds, run),
        ("30 nodes, 7200 half steps", fine_seconds, fine),
    ):
        error = float(np.abs(curve - reference).max())
        for name, peer_seconds, peer_error in others:
            out.append(row(case, "time", "s", cost, peer_seconds, name))
            out.append(row(case, "largest error", "K", error, peer_error, name))
    mean = [net.place("n0").mean]
    with_tangents, _ = timed(lambda: simulate(net, rec, rows=mean, tangents=net.parameters[:40]))
    out.append(row("30 nodes, 40 tangents", "time", "s", with_tangents, 40 * seconds, "40 runs"))
    long, _ = timed(lambda: simulate(ring(10), record(97200), rows=[ring(10).place("n0").mean]), 2)
    out.append(row("10 nodes, 27 h at 1 Hz", "time", "s", long))
    for n in (10, 30, 100, 300):
        network = ring(n)
        cost, _ = timed(lambda network=network: simulate(network, record(3600, 10.0)), 2)
        out.append(row(f"{n} nodes, 360 steps", "time", "s", cost))
    return out


def row(case: str, measure: str, unit: str, ours: float, peer: float | None = None, name: str = "") -> dict[str, Any]:
    """One line of the table; ratio is ours over the peer's."""
    ratio = ours / peer if peer else None
    out = {"case": case, "measure": measure, "unit": unit, "ours": ours}
    return {**out, "peer": peer, "peer_name": name, "ratio": ratio}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path)
    target = parser.parse_args().json
    document = {
        "benchmark": "network",
        "computer": f"{platform.machine()}, {platform.processor() or platform.system()}",
        "date": datetime.date.today().isoformat(),
        "rows": rows(),
    }
    for r in document["rows"]:
        peer = f"  {r['peer_name']} {r['peer']:.4g}  ratio {r['ratio']:.3g}" if r["peer"] else ""
        print(f"{r['case']:26s} {r['measure']:14s} {r['ours']:.4g} {r['unit']}{peer}")
    if target:
        target.write_text(json.dumps(document, indent=1))


if __name__ == "__main__":
    main()
