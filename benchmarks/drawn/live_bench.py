"""How soon does a bench that steers itself know, beside a fixed plan of three hours and random set points?

    python benchmarks/drawn/live_bench.py --plants 60 --out out/live-bench.jsonl --page docs/how-to/live-bench.md

Drawn plants of `simulated.bench` in simulated time. Every run is a line of OUT; started again, it goes on from there.
"""

import argparse
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from extras.bench.live.assessment import Assessment
from extras.bench.live.planning import LENGTHS_MIN, MINUTE, Choice, choices, is_allowed
from extras.bench.live.settings import Bench, SetPoint, read_bench
from extras.bench.live.steering import Policy, Steering
from extras.bench.live.store import BenchError, Store
from scripts.published import add_lines, json_lines, publish, table
from simulated.bench.kinds import KINDS, write_case
from simulated.bench.plant import Plant, drawn
from thermoscope.plugin import load_case

HOURS, FIRST = (
    3.0,
    8000,
)  # the fixed plan's, and everybody's most; seed of the first plant: the rules were made on others
LOOK_S, SHARE = 120.0, 0.2  # a look at the odds every two minutes, later every fifth of the time so far
SAME = {"gap.convection@rotor|core": "gap.convection@core|rotor"}
# Minutes from the start, then shares of the largest current and speed: what is asked for where nobody steers.
PLAN = ((0, 0.7, 0.0), (45, 0.0, 0.0), (60, 0.7, 0.5), (105, 0.7, 1.0), (150, 0.0, 1.0), (165, 0.0, 0.0))


def lowered(bench: Bench, set_point: SetPoint, current: str) -> Iterator[dict[str, float]]:
    """The set point, and with less and less current."""
    (knob,) = (k for k in bench.knobs if k.name == current)
    for level in sorted((v for v in knob.levels if v <= set_point[current] + 1e-9), reverse=True):
        yield {**set_point, current: level}


def fixed(assessment: Assessment, bench: Bench, now: SetPoint) -> Sequence[Choice]:
    """The plan of three hours; a current that the limits forbid is lowered."""
    t = (assessment.test.time[-1] - assessment.test.time[0]) / MINUTE
    _, amperes, speed = [row for row in PLAN if row[0] <= t][-1]
    end = next((row[0] for row in PLAN if row[0] > t), 60.0 * HOURS + 1.0)
    most = {k.name: k.most for k in bench.knobs}
    wanted = {**bench.safe, "current_A": amperes * most["current_A"], "speed_rpm": speed * most["speed_rpm"]}
    for s in lowered(bench, wanted, "current_A"):
        if is_allowed(assessment, bench, s):
            return [Choice(s, max(min(end - t, LENGTHS_MIN[2]), 0.5), 1.0, {})]
    return []


def random_points(seed: int) -> Policy:
    rng = np.random.default_rng([seed, 13])

    def policy(assessment: Assessment, bench: Bench, now: SetPoint) -> Sequence[Choice]:
        for s in rng.permutation(np.array(bench.set_points(now), dtype=object)):
            if is_allowed(assessment, bench, s):
                return [Choice(s, float(rng.uniform(5.0, 15.0)), 1.0, {})]
        return []

    return policy


def run(kind: str, seed: int, method: str) -> dict:
    """One plant by one method."""
    begin, truth = time.process_time(), drawn(kind, seed)
    plant = Plant(truth)
    with tempfile.TemporaryDirectory() as folder:
        case = write_case(kind, Path(folder))
        network = load_case(case, untested=True).case.model.network
        bench = replace(read_bench(case, network), budget_min=60.0 * HOURS, every_s=LOOK_S)
        bench = bench if method == "steered" else replace(bench, patience_min=60.0 * HOURS)
        policy = {"steered": choices, "fixed": fixed, "random": random_points(seed)}[method]
        steering = Steering(bench, Store(case, "live", bench.sheet_file, sync=False), policy)
        stop, cause, fault, looks = "", "", "", 0
        while not stop and not fault:
            row = plant.row()
            try:
                for s in steering.row(row) if row else ():
                    plant.apply(s)
            except BenchError as said:
                fault = str(said)
                break
            if steering.is_due:
                thought = steering.think(case)
                looks, stop, cause = looks + 1, thought.stop, thought.assessment.odds[0][0]
                for s in steering.apply(thought):
                    plant.apply(s)
                steering.bench = replace(bench, every_s=max(LOOK_S, SHARE * (steering.time - steering.begin)))
        steering.store.close()
    crossed = [x.name for x in bench.limits if plant.hottest[x.place] > x.most_C]
    named = stop.endswith("is missing")
    return {
        "kind": kind, "seed": seed, "method": method, "truth": truth.hidden, "size": truth.size, "stop": stop or fault,
        "named": named, "right": named and SAME.get(cause, cause) == truth.hidden, "cause": cause,
        "minutes": (steering.time - steering.begin) / MINUTE, "crossed": crossed, "looks": looks,
        "hottest": {n: round(T, 1) for n, T in plant.hottest.items()}, "cpu_s": round(time.process_time() - begin, 1),
    }  # fmt: skip


def methods_table(rows: Sequence[dict]) -> str:
    """What is published."""
    head = "method | plants | answers | right | median time (min) | of right ones (min) | limits crossed | CPU (s)"
    out = []
    words = {"steered": "steers itself", "fixed": "fixed plan of three hours", "random": "random set points"}
    for method, called in words.items():
        own = [r for r in rows if r["method"] == method]
        if own:
            named = [r for r in own if r["named"]]
            right = [r for r in named if r["right"]]
            # who names nothing counts as the whole three hours
            spent = [r["minutes"] if r["named"] else 60.0 * HOURS for r in own]
            of_right = f"{np.median([r['minutes'] for r in right]):.0f}" if right else "-"
            counts = len(own), len(named), len(right), f"{np.median(spent):.0f}", of_right
            cost = sum(bool(r["crossed"]) for r in own), f"{np.mean([r['cpu_s'] for r in own]):.0f}"
            out.append([called, *counts, *cost])
    return table(head.split(" | "), out)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plants", type=int, default=60)
    parser.add_argument("--first", type=int, default=FIRST, help="seed of the first plant")
    parser.add_argument("--methods", nargs="+", default=["steered", "fixed", "random"])
    parser.add_argument("--out", type=Path, default=Path("out/live-bench.jsonl"))
    parser.add_argument("--page", type=Path, help="write the table between the markers of this page")
    a = parser.parse_args()
    a.out.parent.mkdir(parents=True, exist_ok=True)
    rows = json_lines(a.out)
    done = {(r["seed"], r["method"]) for r in rows}
    for method in a.methods:
        for i in range(a.plants):
            if (a.first + i, method) not in done:
                rows.append(run(list(KINDS)[i % len(KINDS)], a.first + i, method))
                add_lines(a.out, rows[-1])
                print(
                    {k: rows[-1][k] for k in ("kind", "method", "truth", "stop", "minutes", "crossed", "cpu_s")},
                    flush=True,
                )
    print(methods_table(rows))
    if a.page:
        publish(a.page, "table", methods_table(rows))


if __name__ == "__main__":
    main()
