"""Random networks against SciPy's Radau: how far off, whether any node leaves what is allowed, what the run says.

    python benchmarks/peers/time_steps.py [--first SEED] [--count 1000] [--tangents 3] [--json FILE]

Networks, equations and reference are those of tests/random_networks.py: 3 to 40 nodes, capacities over six
decades and none, cells of 0.1 J/K, samples of 1 to 60 s, inputs in steps and ramps, streams through zero and reversed,
copper losses that follow temperature. Radau goes from sample to sample at rtol 1e-9 with equations of its own.
Tangents of some of a network's parameters are held against central differences on the steps of the run.
"""

import sys
from pathlib import Path

import numpy as np

from lumped.integration.record import Record
from lumped.integration.simulate import simulate
from lumped.model.network import Network, Row

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "shared"))
from random_networks import Machine, admissible, built, machine, reference

from scripts.published import benchmark_parser, write_json

WRONG_K, WRONG_SHARE, OUTSIDE_K = 0.1, 1e-3, 0.01
STEP, WRONG_TANGENT = 1e-4, 1e-5  # of log(parameter);  of the largest tangent: rounding leaves 1e-7 to 1e-6


def exactly(m: Machine, seed: int, folder: Path | None) -> np.ndarray:
    """Radau's answer, which takes most of the time: from a folder where it is known."""
    if folder is None:
        return reference(m)
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / f"{seed}.npy"
    if not file.exists():
        np.save(file, reference(m))
    return np.load(file)


def measured(seed: int, folder: Path | None = None, parameters: int = 0) -> dict[str, float]:
    """One network: error (K), what is allowed (K), how far outside (K), estimate (K), steps per sample, tangents."""
    m = machine(seed)
    network, record = built(m)
    rows = [network.place(n).mean for n in network.states]
    run = simulate(network, record, rows=rows, keep_states=True)
    assert run.z is not None
    x, exact, (low, high) = run.z[:, : m.C.size], exactly(m, seed, folder), admissible(m)
    span = max(exact.max(), m.around.max()) - min(exact.min(), m.around.min())
    return {
        "seed": seed,
        "error_K": float(np.abs(x - exact).max()),
        "allowed_K": max(WRONG_K, WRONG_SHARE * span),
        "outside_K": float(max(low - x.min(), x.max() - high, 0.0)),
        "estimate_K": float(run.time_error_K.max()),
        "steps": run.steps.knot.size / m.time.size,
        "tangent": tangent_error(network, record, rows, parameters),
    }


def tangent_error(network: Network, record: Record, rows: list[Row], count: int) -> float:
    """Largest difference of tangents to central differences on the same steps, over the largest tangent."""
    every = network.parameters
    some = every[:: max(1, len(every) // count)][:count] if count else ()
    if not some:
        return 0.0
    run = simulate(network, record, rows=rows, tangents=some)
    assert run.dy is not None
    worst = 0.0
    for k, p in enumerate(some):
        up, down = (simulate(network, record, {p.name: np.exp(h)}, rows, steps=run.steps).y for h in (STEP, -STEP))
        worst = max(worst, float(np.abs(run.dy[:, :, k] - (up - down) / (2 * STEP)).max()))
    return worst / max(float(np.abs(run.dy).max()), 1e-3)


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--tangents", type=int, default=3, help="parameters of each network")
    parser.add_argument(
        "--references", type=Path, metavar="FOLDER", help="keep Radau's answers there for the next time"
    )
    given = parser.parse_args()
    rows = []
    for seed in range(given.first, given.first + given.count):
        rows.append(measured(seed, given.references, given.tangents))
        r = rows[-1]
        if r["tangent"] > WRONG_TANGENT:
            print(f"seed {seed}: tangents {r['tangent']:.1e} from finite differences", flush=True)
        if r["error_K"] > r["allowed_K"] or r["outside_K"] > OUTSIDE_K:
            print(f"seed {seed}: error {r['error_K']:.4f} K, outside by {r['outside_K']:.4f} K", flush=True)
    error, estimate = (np.array([r[k] for r in rows]) for k in ("error_K", "estimate_K"))
    wrong = sum(r["error_K"] > r["allowed_K"] for r in rows)
    outside = sum(r["outside_K"] > OUTSIDE_K for r in rows)
    print(f"{len(rows)} networks: {wrong} beyond the allowed error, {outside} outside by {OUTSIDE_K} K")
    print(f"error (K): median {np.median(error):.4f}, 99 % {np.quantile(error, 0.99):.4f}, largest {error.max():.4f}")
    print(
        f"told error over the error: {(estimate / error).min():.2f} to {(estimate / error).max():.2f}; "
        f"{np.mean([r['steps'] for r in rows]):.1f} steps per sample"
    )
    apart = np.array([r["tangent"] for r in rows])
    print(
        f"tangents from finite differences, over the largest: median {np.median(apart):.1e}, largest {apart.max():.1e}"
    )
    write_json(given.json, rows)


if __name__ == "__main__":
    main()
