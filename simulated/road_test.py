"""Simulate the five tests of cases/road-test:  python -m simulated.road_test --out DIR [--quick] [--only NAME ...]"""

import argparse
import sys
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np

from geom import load_machine
from simulated.physics import air, conduction, losses, materials, surfaces
from simulated.physics.draws import Draws
from simulated.physics.plant import Plant
from simulated.road import drive, files, halves, sensors
from simulated.road.run import Result, run

SEED = 20251
FULL = {"stator_m": 0.02, "rotor_m": 0.005}
QUICK = {"stator_m": 0.08, "rotor_m": 0.02, "segments": 24}
TRUTH = Path(__file__).with_name("road_test.truth.toml")
_STAND = "60 min on the brake stand, below 40 A, fan on; the vehicle does not move, its GPS speed is 0. "
_ROAD = "60 min on the road: stops, a 4 % overpass, fan on. "
_MADE = "Simulated measurement, see docs/data-road-test.md."
DESCRIPTIONS = {
    **{f"stand-{i}": f"{_STAND}Repeat {i} of 3. {_MADE}" for i in (1, 2, 3)},
    "road-1": f"{_ROAD}About 40 km/h on average. {_MADE}",
    "road-2": f"{_ROAD}Another route and season: town, fast road, a long halt. {_MADE}",
}


def motor(draws: Draws, mesh: dict[str, float], hidden: bool = True) -> Plant:
    """The true motor; hidden=False switches the hidden effect off and changes nothing else."""
    machine = load_machine("series-dc-100kw")
    built = halves.build(machine, **mesh)  # type: ignore[arg-type]
    solids = materials.solids(machine, draws)
    joints = materials.contacts([*built.mesh.contacts, *built.joints], draws)
    body = conduction.build(built.mesh, solids, joints, built.copies, built.joints)
    gap_share = draws.around("fan.gap_share", 0.13, 0.15)
    films = surfaces.draw(draws)
    return Plant(body, losses.draw(draws), films if hidden else replace(films, shelter=0.0), air.path(body, gap_share))


def simulate(test: str, hidden: bool, quick: bool) -> tuple[Result, float]:
    """One test and the seconds it took. Everything follows from the seed, so each process builds its own motor."""
    draws, begun = Draws(SEED), time.perf_counter()
    plant = motor(draws, QUICK if quick else FULL, hidden)

    def tell(second: int) -> None:
        if second % 600 == 0:
            print(f"{test}: {second // 60} min", file=sys.stderr, flush=True)

    result = run(plant, drive.drives(draws)[test], sensors.install(plant.body, draws), 60 if quick else 10, tell)
    return result, time.perf_counter() - begun


def make(out: Path, truth: Path, quick: bool, tests: Sequence[str]) -> None:
    """Simulate, write NAME.csv, NAME.toml and their columns to `out` and the truth to `truth`."""
    out.mkdir(parents=True, exist_ok=True)
    jobs = [(test, hidden) for test in tests for hidden in ((True, False) if test.startswith("road") else (True,))]
    with ProcessPoolExecutor(2) as pool:
        futures = {job: pool.submit(simulate, *job, quick) for job in jobs}
        done = {job: future.result() for job, future in futures.items()}
    draws = Draws(SEED)
    plant = motor(draws, QUICK)
    installed = sensors.install(plant.body, draws)
    drive.drives(draws)  # only so that their draws are recorded
    for test in tests:
        files.write_csv(out / f"{test}.csv", done[test, True][0], installed, test, draws)
    files.write_sheets(out, {test: DESCRIPTIONS[test] for test in tests})
    sections = {"hidden": _hidden(draws, done), "runs": {test: _account(*done[test, True]) for test in tests}}
    files.write_truth(truth, draws, installed, sections)


def _hidden(draws: Draws, done: dict[tuple[str, bool], tuple[Result, float]]) -> dict[str, object]:
    """The hidden effect in words and numbers: with minus without, at the end and at its largest."""
    imprint = {}
    for test in sorted(test for test, hidden in done if not hidden):
        change = done[test, True][0].T - done[test, False][0].T
        largest = change[np.abs(change).argmax(axis=0), np.arange(change.shape[1])]
        names = [*sensors.THERMOCOUPLES, sensors.EXHAUST[0]]
        imprint[test] = {
            n: files.inline({"at_end_K": round(float(e), 2), "largest_K": round(float(m), 2)})
            for n, e, m in zip(names, change[-1], largest)
        }
    return {
        "effect": "forced convection by road wind on flange.right.outer",
        "law": "Nu = 0.25 Re^0.63, Re = shelter v D / nu, D = 0.48 m; joined with natural convection by cubes",
        "shelter": round(draws.taken["hidden.shelter"], 4),
        "imprint": imprint,
    }


def _account(result: Result, seconds: float) -> dict[str, object]:
    """Heat of one run (kJ), how well it balances, and how hot the parts became."""
    kJ = {name: round(getattr(result, name) / 1e3, 1) for name in ("made", "outside", "exhaust", "stored")}
    hottest = {part: round(T, 1) for part, T in result.hottest.items()}
    return {**kJ, "imbalance": float(f"{result.imbalance:.1e}"), "seconds": round(seconds), "hottest_degC": hottest}


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="simulated.road_test", description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder for NAME.csv and NAME.toml")
    parser.add_argument("--truth", type=Path, help="file for the truth; beside this script, or in --out with --quick")
    parser.add_argument("--quick", action="store_true", help="coarse mesh, steps of 60 s")
    parser.add_argument("--only", nargs="+", choices=list(DESCRIPTIONS), default=list(DESCRIPTIONS))
    given = parser.parse_args(arguments)
    truth = given.truth or (given.out / "truth.toml" if given.quick else TRUTH)
    make(given.out, truth, given.quick, given.only)


if __name__ == "__main__":
    main()
