"""How long a diagnosis takes, and how much memory: 20 nodes, 12 sensors, 4 tests, at least 60 candidates.

    python benchmarks/diagnosis.py [--json FILE] [--samples 1000000] [--case cases/road-test]

Wall and CPU seconds of a diagnosis on two cores; then one test of 1e6 samples: time and the
memory that the residuals and their Gram matrix take, against a test of a quarter of its length: it must not grow.
With `--case` the diagnosis of that case instead, with its whole catalogue and with the first 60 candidates of it.
"""

import tracemalloc
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from lumped.integration.simulate import Record, simulate
from lumped.model.build import bare_network, node_link, node_source
from lumped.model.network import Network, Parameter
from lumped.transfer.laws import Fixed, InputPower, Linear, Power
from measured.case import Case, Channel, Model, Test
from scripts.published import benchmark_parser, measured_row as row, print_rows, timed, write_rows
from thermoscope.case_folder.folder import load_case
from validation import diagnose
from validation.comparison.linearisation import segments
from validation.inference.evidence import calibrated_case, candidates
from validation.inference.score import gram

NODES, SENSORS, CANDIDATES = 20, 12, 60
LIMIT_S = 20.0  # of a diagnosis with 60 candidates
WHOLE_S = 90.0  # of one with the whole catalogue
MORE = 1.25  # memory for four times the samples


def motor() -> Network:
    """A chain of 20 nodes with a film on every third, two windings, an iron loss and friction."""
    names = [
        "winding.a",
        "winding.b",
        "yoke",
        "rotor",
        "shaft",
        "bearing.a",
        "bearing.b",
        "flange.a",
        "flange.b",
        *(f"housing.{i}" for i in range(NODES - 9)),
    ]
    net = bare_network("motor", dict.fromkeys(names, 4000.0), ("ambient",))
    links = [node_link(net, f"g{i}", "link", a, b, Fixed(8.0)) for i, (a, b) in enumerate(pairwise(names))]
    links += [
        node_link(net, f"film{i}", "link", n, "ambient", Fixed(0.6, Power(0.25)))
        for i, n in enumerate(names)
        if i % 3 == 0
    ]
    hot = Linear(0.0039, 20.0)
    losses = {
        "copper.a": ("winding.a", InputPower(0.02, (("current_A", 1.0, 2.0),), hot)),
        "copper.b": ("winding.b", InputPower(0.02, (("current_A", 1.0, 2.0),), hot)),
        "iron": ("yoke", InputPower(60.0, (("speed_rpm", 1000.0, 1.5),))),
        "friction": ("bearing.a", InputPower(8.0, (("speed_rpm", 1000.0, 1.0),))),
    }
    sources = [node_source(net, n, n.split(".")[0], {at: 1.0}, law) for n, (at, law) in losses.items()]
    free = [Parameter(x.name, ((x.name, 1.0),), prior_sd=0.25) for x in links[::4]]
    free += [Parameter(s.name, ((s.name, 1.0),), prior_sd=0.1) for s in sources]
    return net.extended(links, sources, free)


def recorded(net: Network, name: str, samples: int, step: float, missing: Network | None = None) -> Test:
    """One test, simulated with another network where one is given; noise of 0.05 K."""
    rng = np.random.default_rng(sum(map(ord, name)))
    t = step * np.arange(samples)
    levels = (t / max(t[-1] / 9.0, step)).astype(int)
    current, speed = rng.uniform(40, 160, 10)[levels], rng.uniform(200, 1500, 10)[levels]
    inputs = {"current_A": current, "speed_rpm": speed, "vehicle_speed_mps": speed / 100.0}
    air = {"ambient": np.full(samples, 20.0)}
    places = [net.places[n] for n in net.states[:SENSORS]]
    y = simulate(missing or net, Record(t, inputs, air, 20.0), rows=[p.mean for p in places]).y
    y = y + 0.05 * rng.standard_normal(y.shape)
    channels = tuple(Channel(p.name, p.name, p.mean, y[:, j], 0.5) for j, p in enumerate(places))
    return Test(name, "calibrate", t, inputs, air, channels, 20.0)


def case() -> Case:
    """Four tests of an hour at 1 s; the real machine loses more at the yoke."""
    net = motor()
    law = InputPower(4.0, (("vehicle_speed_mps", 10.0, 0.8),))
    real = net.extended([node_link(net, "wind", "link", "flange.a", "ambient", law)])
    tests = tuple(recorded(net, f"test-{i}", 3600, 1.0, real) for i in range(4))
    return Case("motor", Model(net), (*tests[:3], replace(tests[3], role="validate")))


def kinds(now: Case) -> list[str]:
    """The first kinds of effects that come to 60 candidates together."""
    every = [e.kind for e in candidates(now)]
    chosen: list[str] = []
    for kind in dict.fromkeys(every):
        if sum(every.count(k) for k in (*chosen, kind)) <= CANDIDATES:
            chosen.append(kind)
    return chosen


def peak(now: Case) -> float:
    """Peak of Python's memory (MB) while residuals and Gram matrix of a case are made, beyond the recordings."""
    fit = calibrated_case(replace(now, tests=tuple(_short(t) for t in now.tests)))
    tracemalloc.start()
    parts = segments(fit.network, now.tests, fit.values, fit.unknowns.parameters[:8])
    gram(parts, fit.noise, 8)
    high = tracemalloc.get_traced_memory()[1] / 1e6
    tracemalloc.stop()
    return high


def _short(test: Test) -> Test:
    """The first tenth of a percent of a long test, enough to calibrate on."""
    n = min(len(test.time), 2000)
    cut = slice(0, n)
    channels = tuple(replace(c, y=c.y[cut]) for c in test.channels)
    inputs = {k: v[cut] for k, v in test.inputs.items()}
    return replace(
        test,
        time=test.time[cut],
        inputs=inputs,
        channels=channels,
        boundaries={k: v[cut] for k, v in test.boundaries.items()},
    )


def rows(samples: int) -> list[dict[str, Any]]:
    now, out, name = case(), [], f"{CANDIDATES} candidates"
    chosen = kinds(now)
    diagnose(now, chosen)  # compile
    wall, cpu, _ = timed(lambda: diagnose(now, chosen))
    out += [row(name, "wall time", "s", wall, LIMIT_S, "limit"), row(name, "CPU time", "s", cpu, 2 * LIMIT_S, "limit")]
    net = motor()
    sizes = {n: peak(Case("long", Model(net), (recorded(net, "long", n, 1.0),))) for n in (samples // 4, samples)}
    measure = f"memory over a quarter's {sizes[samples // 4]:.0f} MB"
    out.append(row(f"{samples} samples", measure, "1", sizes[samples] / sizes[samples // 4], MORE, "limit"))
    return out


def rows_of(folder: Path) -> list[dict[str, Any]]:
    """A case with a folder: how long its diagnosis takes, the ranking of further tests and sensors left out."""
    now, out = load_case(folder).case, []
    few = kinds(now)
    for what, limit, chosen in (("whole catalogue", WHOLE_S, None), (f"{CANDIDATES} candidates", LIMIT_S, few)):
        wall, cpu, _ = timed(lambda chosen=chosen: diagnose(now, chosen, plan=False))
        name = f"{now.name}, {what}"
        out += [row(name, "wall time", "s", wall, limit, "limit"), row(name, "CPU time", "s", cpu, 2 * limit, "limit")]
    return out


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("--samples", type=int, default=1_000_000)
    parser.add_argument("--case", type=Path)
    options = parser.parse_args()
    found = rows_of(options.case) if options.case else rows(options.samples)
    print_rows(found)
    write_rows(options.json, "diagnosis", found)


if __name__ == "__main__":
    main()
