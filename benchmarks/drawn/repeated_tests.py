"""Does `bench curves --against` call equal runs changed, and does it see a machine that drifts? Drawn pairs of tests.

    python benchmarks/drawn/repeated_tests.py [--pairs 200] [--times 4 8] [--json FILE]

A heated core in a shell is drawn with its tests of so many time constants, a month apart: another ambient that
wanders, a load 1 % off, a start off ambient, an error of reading of one sigma that every test has anew, noise that is
correlated over 1 to 20 minutes, a logger of 0.1 K. The user's network is off by 20 % in every value and never fitted.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from extras.bench.measuring.drift import Drift, drift
from lumped.declarations.network import read_network
from lumped.integration.simulate import Record, simulate
from lumped.model.network import Network
from measured.case import Case, Channel, Model, Test
from scripts.published import benchmark_parser, table, write_json

SIGMA_K, STEP_S = 0.3, 60.0
DRIFTS = {  # what the later test has: factors of film, contact and loss
    "nothing": (1.0, 1.0, 1.0),
    "film 10 % less": (0.9, 1.0, 1.0),
    "contact resistance doubled": (1.0, 0.5, 1.0),
    "loss 5 % more": (1.0, 1.0, 1.05),
}
PLACES = ("core", "shell")


def network(values: np.ndarray) -> Network:
    """values : capacities of core and shell (J/K), contact and film (W/K), heat (W)"""
    core, shell, contact, film, heat = values.tolist()
    of = {"input": "load", "at": 1.0, "exponent": 2.0}
    return read_network(
        {
            "network": {"name": "machine", "boundaries": ["ambient"]},
            "nodes": {"core": {"C_J_K": core}, "shell": {"C_J_K": shell}},
            "links": {
                "contact": {"between": ["core", "shell"], "G_W_K": contact},
                "film": {"between": ["shell", "ambient"], "G_W_K": film},
            },
            "losses": {"heat": {"kind": "constant", "at": "core", "P_W": heat, "of": of}},
        }
    )


def correlated(rng: np.random.Generator, n: int, sd: float, time_s: float) -> np.ndarray:
    """A first-order autoregressive series of a standard deviation and a time."""
    rho, out = np.exp(-STEP_S / time_s), sd * rng.standard_normal(n)
    for k in range(1, n):
        out[k] = rho * out[k - 1] + np.sqrt(1.0 - rho**2) * out[k]
    return out


def measured(rng: np.random.Generator, truth: Network, name: str, time: np.ndarray) -> Test:
    """A test of the machine as its logger has it."""
    load = np.full(time.size, rng.uniform(0.99, 1.01))
    air = rng.uniform(16, 28) + rng.uniform(-2, 2) * np.sin(np.pi * time / time[-1])
    air = air + correlated(rng, time.size, 0.3, 1800.0)
    test = Test(name, "calibrate", time, {"load": load}, {"ambient": air}, (), float(air[0]))
    rows = [truth.places[p].mean for p in PLACES]
    start = float(air[0]) + 0.3 * rng.standard_normal()
    y = simulate(truth, Record(time, test.signals, test.boundaries, start), {}, rows).y
    sd, over = rng.uniform(0.05, 0.3), rng.uniform(60.0, 1200.0)
    read = [
        y[:, j] + SIGMA_K * rng.standard_normal() + correlated(rng, time.size, sd, over) for j in range(len(PLACES))
    ]
    channels = [Channel(p, p, row, np.round(x, 1), SIGMA_K) for p, row, x in zip(PLACES, rows, read, strict=True)]
    return replace(test, channels=tuple(channels))


def pair(seed: int, kind: str, times: Sequence[float] = (4.0, 8.0)) -> Drift:
    """Both tests of a machine that drifted so in between, by a network that nobody fitted."""
    rng = np.random.default_rng(seed)
    film, rise = rng.uniform(0.5, 3.0), rng.uniform(30, 80)
    capacity, inner = rng.uniform(20, 60) * 60.0 * film, rng.uniform(0.05, 0.25)
    values = np.array([0.4 * capacity, 0.6 * capacity, film / inner, film, film * rise])
    length = rng.uniform(times[0], times[1]) * capacity / film
    time = np.arange(0.0, length, STEP_S)
    less, contact, more = DRIFTS[kind]
    changed = values * [1.0, 1.0, contact, less, more]
    before, after = (measured(rng, network(v), n, time) for v, n in ((values, "october"), (changed, "november")))
    user = network(values * np.exp(0.2 * rng.standard_normal(values.size)))
    return drift(Case("machine", Model(user), (before, after)), after, before)


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("--pairs", type=int, default=200, help="drawn of each kind")
    parser.add_argument(
        "--times", type=float, nargs=2, default=(4.0, 8.0), help="length in time constants, from and to"
    )
    options = parser.parse_args()
    found: dict[str, list[dict]] = {kind: [] for kind in DRIFTS}
    for seed, kind in product(range(options.pairs), DRIFTS):
        found[kind].append(pair(seed, kind, options.times).document())
    columns = "drift | drawn | changed | cannot tell | equal | part named | cools less | cools as before"
    rows = []
    for kind, every in found.items():
        verdicts, parts = (Counter(one[key] for one in every) for key in ("verdict", "part"))
        named = ", ".join(f"{p} {n}" for p, n in parts.items() if p) or "-"
        counts = (verdicts[word] for word in ("changed", "cannot tell", "equal"))
        signs = (sum(w in one["sentence"] for one in every) for w in ("cools less", "cools as before"))
        rows.append([kind, len(every), *counts, named, *signs])
    print(table(columns.split(" | "), rows))
    write_json(options.json, found)


if __name__ == "__main__":
    main()
