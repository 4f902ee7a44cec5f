"""Does `bench law` find the law that a table of steady tests was drawn from, and none where there is none?

    python benchmarks/drawn/steady_laws.py [--tables 100] [--few] [--json FILE]

Six layers at two ends are nodes of a network: each is heated, washed by a share of the film, tied to its neighbours.
The film is drawn: flow^0.5 and speed^1.2; the same with flow that counts only up to a value, beyond which the space is
flooded; a film that is another in every test; one that is the same in all. Flow, speed and oil are set within 1 %,
sensors read within 0.1 K. The highest flow and the highest speed are left out of what the law is found from.
"""

from itertools import product
from typing import Any

import numpy as np

from extras.bench.steady_law.law import SteadyLaw, find_law
from extras.bench.steady_law.steady_tests import Columns, SteadyTests, steady_tests
from scripts.published import benchmark_parser, write_json

KINDS = ("powers", "flooding", "scatter", "constant")
Plan = tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]  # flows (l/min), speeds (rpm), inlets (degC)
MANY: Plan = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0), (0.0, 2500.0, 5000.0, 7500.0, 10000.0, 12500.0), (40.0, 75.0)
FEW: Plan = (1.0, 2.0, 3.0, 4.0, 6.0), (0.0, 4000.0, 8000.0, 12000.0), (40.0,)
EXPONENTS = (0.5, 1.2)  # of flow and speed
LAYERS, AMBIENT_C, READ_K, SET = 6, 25.0, 0.1, 0.01
COLUMNS = Columns("loss", "oil", (("flow", "l/min"), ("speed", "rpm")), "T_*", AMBIENT_C)
NAMES = tuple(f"T_{layer}_{end}" for layer in "abcdef" for end in ("front", "rear"))


def film(rng: np.random.Generator, kind: str, inputs: np.ndarray, oil: np.ndarray) -> tuple[np.ndarray, float]:
    """Conductance (W/K) of all layers together in each test, and the flow beyond which no more helps."""
    jet, thrown, limit = rng.uniform(60.0, 150.0), rng.uniform(60.0, 250.0), rng.uniform(2.4, 4.6)
    thin = np.exp(rng.uniform(0.05, 0.3) * (oil - 57.5) / 10.0)
    if kind == "scatter":
        return jet * np.exp(0.3 * rng.standard_normal(len(oil))), np.inf
    if kind == "constant":
        return np.full(len(oil), jet), np.inf
    limit = limit if kind == "flooding" else np.inf
    flow, speed = np.minimum(inputs[:, 0], limit) / 4.0, inputs[:, 1] / 1e4
    return (jet * flow ** EXPONENTS[0] + thrown * speed ** EXPONENTS[1]) * thin, limit


def table(seed: int, kind: str, levels: Plan = MANY) -> tuple[SteadyTests, float]:
    """All tests of a machine, the left-out ones too, and its limit of flow."""
    rng = np.random.default_rng(seed)
    plan = np.array(list(product(*levels)))
    true = plan * (1.0 + SET * rng.standard_normal(plan.shape))
    G, limit = film(rng, kind, true[:, :2], true[:, 2])
    G0 = rng.uniform(0.0, 8.0)
    heat = np.round(G * rng.uniform(8.0, 25.0, len(G)) * rng.uniform(0.8, 1.0))
    washed, lost = rng.dirichlet(np.full(2 * LAYERS, 20.0)), rng.dirichlet(np.full(2 * LAYERS, 5.0))
    ties = np.zeros((2 * LAYERS, 2 * LAYERS))
    for n, m, g in [(n, n + 2, rng.uniform(5.0, 40.0)) for n in range(2 * LAYERS - 2)] + [
        (n, n + 1, rng.uniform(2.0, 10.0)) for n in range(0, 2 * LAYERS, 2)
    ]:
        ties[[n, m], [n, m]] += g
        ties[[n, m], [m, n]] -= g
    read = []
    for k in range(len(G)):
        A = ties + np.diag(washed * G[k] + lost * G0)
        T = np.linalg.solve(A, heat[k] / len(A) + washed * G[k] * true[k, 2] + lost * G0 * AMBIENT_C)
        read.append(T + READ_K * rng.standard_normal(T.size))
    ambient = np.full(len(G), AMBIENT_C)
    return steady_tests(COLUMNS, NAMES, plan[:, :2], heat, true[:, 2], ambient, np.round(read, 1)), limit


def judged(seed: int, kind: str, levels: Plan = MANY) -> dict[str, Any]:
    """What was found of a table, and how it predicts the tests with the highest flow or speed."""
    tests, limit = table(seed, kind, levels)
    highest = (tests.inputs >= [levels[0][-1], levels[1][-1]]).any(axis=1)
    law, rest = find_law(tests.only(np.flatnonzero(~highest))), tests.only(np.flatnonzero(highest))
    return {"seed": seed, "sentence": law.sentence, **law.predict(rest).agreement(rest), **outcome(law, kind, limit)}


def outcome(law: SteadyLaw, kind: str, limit: float) -> dict[str, Any]:
    """right : the form that was drawn, every exponent within 0.15 and the limit within 0.5 l/min of the truth"""
    form, numbers = law.best.form, law.numbers
    if kind in ("scatter", "constant"):
        return {"right": law.verdict == "no law"}
    flooded = (0, "up to") if np.isfinite(limit) else None
    if form.terms != ((0,), (1,)) or form.blend or form.limit != flooded:
        return {"right": False}
    truth = {("a", n, n): (e, 0.15) for n, e in enumerate(EXPONENTS)} | ({("at",): (limit, 0.5)} if flooded else {})
    there = {label: numbers[label] for label in truth if label in numbers}
    within = [n["low"] <= truth[label][0] <= n["high"] for label, n in there.items()]
    near = all(abs(n["value"] - truth[label][0]) < truth[label][1] for label, n in there.items())
    return {"right": near and len(there) == len(truth), "within": within}


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("--tables", type=int, default=100, help="drawn of each kind")
    parser.add_argument("--few", action="store_true", help="12 tests at one inlet, not 50 at two")
    options = parser.parse_args()
    columns = "drawn | tables | right | beyond: rms (K) | largest (K) | in the 95 % band"
    print(f"| {columns} |\n|{'---|' * (columns.count('|') + 1)}")
    every: dict[str, list[dict[str, Any]]] = {}
    for kind in KINDS:
        rows = every[kind] = [judged(seed, kind, FEW if options.few else MANY) for seed in range(options.tables)]
        rms = [r["rms_K"] for r in rows]
        inside = 100.0 * np.mean([r["inside"] for r in rows])
        right = sum(r["right"] for r in rows)
        print(f"| {kind} | {len(rows)} | {right} | {np.median(rms):.2f} | {max(rms):.2f} | {inside:.0f} % |")
    write_json(options.json, every)


if __name__ == "__main__":
    main()
