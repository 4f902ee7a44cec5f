"""Random networks against SciPy's Radau: how far off, whether any node leaves what is allowed, what the estimate says.

    python benchmarks/time_steps.py [--first SEED] [--count 1000] [--json FILE] [--references FOLDER]

Networks, equations and reference are those of tests/lumped/random_networks.py: 3 to 40 nodes, capacities over six
decades and none, cells of 0.1 J/K, samples of 1 to 60 s, inputs in steps and ramps, streams through zero and reversed,
copper losses that follow temperature. Radau goes from sample to sample at rtol 1e-9 with equations of its own.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

import numpy as np

from lumped.integration.simulate import simulate

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "lumped"))
from random_networks import Machine, admissible, built, machine, reference

WRONG_K, WRONG_SHARE, OUTSIDE_K = 0.1, 1e-3, 0.01


def exactly(m: Machine, seed: int, folder: Path | None) -> np.ndarray:
    """Radau's answer, which takes most of the time: from a folder where it is known."""
    if folder is None:
        return reference(m)
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / f"{seed}.npy"
    if not file.exists():
        np.save(file, reference(m))
    return np.load(file)


def measured(seed: int, folder: Path | None = None) -> dict[str, float]:
    """One network: error (K), what is allowed (K), how far outside (K), estimate (K), steps per sample."""
    m = machine(seed)
    network, record = built(m)
    run = simulate(network, record, rows=[network.place(n).mean for n in network.states], keep_states=True)
    assert run.z is not None
    x, exact, (low, high) = run.z[:, : m.C.size], exactly(m, seed, folder), admissible(m)
    span = max(exact.max(), m.around.max()) - min(exact.min(), m.around.min())
    return {
        "seed": seed, "error_K": float(np.abs(x - exact).max()), "allowed_K": max(WRONG_K, WRONG_SHARE * span),
        "outside_K": float(max(low - x.min(), x.max() - high, 0.0)), "estimate_K": float(run.time_error_K.max()),
        "steps": run.steps.knot.size / m.time.size,
    }  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--json", type=Path, metavar="FILE", help="one row per network")
    parser.add_argument(
        "--references", type=Path, metavar="FOLDER", help="keep Radau's answers there for the next time"
    )
    given = parser.parse_args()
    rows = []
    for seed in range(given.first, given.first + given.count):
        rows.append(measured(seed, given.references))
        r = rows[-1]
        if r["error_K"] > r["allowed_K"] or r["outside_K"] > OUTSIDE_K:
            print(f"seed {seed}: error {r['error_K']:.4f} K, outside by {r['outside_K']:.4f} K", flush=True)
    error, estimate = (np.array([r[k] for r in rows]) for k in ("error_K", "estimate_K"))
    wrong = sum(r["error_K"] > r["allowed_K"] for r in rows)
    outside = sum(r["outside_K"] > OUTSIDE_K for r in rows)
    print(f"{len(rows)} networks: {wrong} beyond the allowed error, {outside} outside by {OUTSIDE_K} K")
    print(f"error (K): median {np.median(error):.4f}, 99 % {np.quantile(error, 0.99):.4f}, largest {error.max():.4f}")
    print(f"estimate above the error in {100 * np.mean(estimate >= error):.1f} %, median ratio "
          f"{np.median(estimate / error):.1f}; {np.mean([r['steps'] for r in rows]):.1f} steps per sample")  # fmt: skip
    if given.json:
        given.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
