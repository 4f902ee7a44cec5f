"""Simulate cases/pmsm-bases and cases/pmsm-machines:  python -m simulated.pm_tests --out DIR [--quick]

Writes NAME.csv and .toml, the record up to switching off; NAME-cooling.csv, the readings after it; and the truth.
"""

import argparse
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tomlkit
from numpy.typing import NDArray

from simulated.physics.draws import Draws
from simulated.physics.plant import State
from simulated.physics.surfaces import Conditions
from simulated.pm import files as pm_files, plant as pm_plant
from simulated.pm.plant import PmLosses, PmPlant

Array = NDArray[np.float64]
SEED = 31
TRUTH = Path(__file__).with_name("pmsm.truth.toml")
STEP, COOL = 600, 15
AXIAL = {"pmsm-m1-no-base": 0.01, "pmsm-m1-plate": 0.01}  # thickest layer (m); a base's edges add more
USUAL = 0.02


@dataclass(frozen=True)
class Plan:
    """One test.  hours of load;  ambient at start (degC) and its drift over the test (K)"""

    machine: str
    base: str
    losses: PmLosses
    current: float
    rpm: float
    emf_V: float
    ambient: float
    drift: float
    hours: float


M1 = PmLosses(2.73, 1.0, 0.0, 5.0)
M2 = PmLosses(0.48, 1.5, 77.0, 5.0)
M3 = PmLosses(1.346, 1.5, 76.0, 5.0)
PLANS = {
    "wood": Plan("pmsm-m1-no-base", "none", M1, 8.0, 0.0, 290.0, 21.0, 0.8, 10.0),
    "plate": Plan("pmsm-m1-plate", "plate", M1, 8.0, 0.0, 290.0, 20.2, 1.1, 10.0),
    "bench": Plan("pmsm-m1", "bench", M1, 8.0, 0.0, 290.0, 22.4, -0.6, 10.0),
    "bench-2": Plan("pmsm-m1", "bench", M1, 8.0, 0.0, 290.0, 19.1, 0.9, 10.0),
    "bench-3": Plan("pmsm-m1", "bench", M1, 8.0, 0.0, 290.0, 23.0, 0.4, 10.0),
    "m2": Plan("pmsm-m2", "bench", M2, 16.0, 383.0, 285.0, 21.6, 0.7, 10.0),
    "m3": Plan("pmsm-m3", "bench", M3, 16.0, 383.0, 300.0, 22.0, 1.2, 10.0),
}


@dataclass(frozen=True)
class Course:
    """time (n,) s; winding and magnet means (degC); ohm; ambient

    imbalance: heat not accounted for over heat made
    base_path, body_path: heat through base and foot, and from the body itself, at the end (W/K over the laminations)
    """

    time: Array
    winding: Array
    magnets: Array
    ohm: Array
    ambient: Array
    imbalance: float
    base_path: float
    body_path: float


def run(plant: PmPlant, plan: Plan, hours: float, quick: bool) -> tuple[Course, Course]:
    """Load, then cooling after switching off; the machine starts at ambient throughout."""
    state, slope = plant.start(plan.ambient), np.zeros(len(plant.body.points))
    loaded, state, slope = _course(plant, plan, state, slope, hours * 3600.0, 900 if quick else STEP, True)
    cooling, _, _ = _course(plant, plan, state, np.zeros_like(slope), 345.0, COOL, False)
    return loaded, cooling


def _course(
    plant: PmPlant, plan: Plan, state: State, slope: Array, end: float, dt: int, on: bool
) -> tuple[Course, State, Array]:
    current, rpm = (plan.current, plan.rpm) if on else (0.0, 0.0)
    rows, balance, begun = [_seen(plant, plan, state, 0.0, on)], np.zeros(2), state.T
    for t in range(dt, int(end) + 1, dt):
        now = Conditions(current, current**2, rpm, 0.0, 0.0, _ambient(plan, t - dt / 2 if on else 36e3))
        state, slope, flows = plant.step(state, slope, now, float(dt))
        balance += dt * np.array([flows.made, flows.outside])
        rows.append(_seen(plant, plan, state, float(t), on))
    stored = float(plant.body.capacity @ (state.T - begun))
    left = (balance[0] - balance[1] - stored) / (balance[0] if on else max(balance[1], 1.0))
    end = Conditions(current, current**2, rpm, 0.0, 0.0, rows[-1][-1])
    return Course(*np.array(rows).T, float(left), *(plant.path(state.T, end, b) for b in (True, False))), state, slope


def _ambient(plan: Plan, t: float) -> float:
    return plan.ambient + plan.drift * np.sin(np.pi * min(t, 36e3) / 72e3)


def _seen(plant: PmPlant, plan: Plan, state: State, t: float, on: bool) -> tuple[float, ...]:
    T = state.T
    return t, plant.winding_mean(T), plant.mean("magnets", T), plant.ohm(T), _ambient(plan, t if on else 36e3)


def simulate(name: str, quick: bool) -> tuple[Course, Course, dict[str, float]]:
    """A test and the drawn values behind it."""
    draws, plan = Draws(SEED), PLANS[name]
    axial, segments = (0.09, 24) if quick else (AXIAL.get(plan.machine, USUAL), 36)
    plant = pm_plant.build(plan.machine, plan.losses, plan.base, draws, axial, segments)
    loaded, cooling = run(plant, plan, plan.hours, quick)
    print(f"{name}: winding {loaded.winding[-1]:.1f} degC, magnets {loaded.magnets[-1]:.1f} degC", file=sys.stderr)
    return loaded, cooling, draws.taken


def write(out: Path, name: str, loaded: Course, cooling: Course, draws: Draws) -> dict[str, float]:
    """The two files of a test; returns the cold readings."""
    plan, every = PLANS[name], int(loaded.time[1])
    alpha = draws.around("magnet.alpha", -0.105e-2, 0.02)
    cold_emf = pm_files.emf(plan.emf_V, alpha, loaded.magnets[0])
    cold = {
        "cold_ohm": float(pm_files.read("ohm", loaded.ohm[0], f"{name}.cold", draws)),
        "cold_V": float(pm_files.read("volt", cold_emf, f"{name}.cold", draws)),
        "cold_degC": float(pm_files.thermometer(loaded.ambient[0], f"{name}.cold", draws)),
    }
    ohm = pm_files.read("ohm", loaded.ohm, f"{name}.hot", draws)
    volt = pm_files.read("volt", pm_files.emf(plan.emf_V, alpha, loaded.magnets), f"{name}.hot", draws)
    air = pm_files.thermometer(loaded.ambient, f"{name}.hot", draws)
    with_R, with_E = (np.isclose(loaded.time % s, 0.0) & (loaded.time > 0) for s in (max(1800, every), 3600))
    lines = ["time_s,current_A,speed_rpm,T_ambient_degC,R_winding_ohm,emf_V"]
    for i, t in enumerate(loaded.time):
        R, E = (f"{v[i]:.4g}" if w[i] else "" for v, w in ((ohm, with_R), (volt, with_E)))
        lines.append(f"{t:.0f},{plan.current:g},{plan.rpm:g},{air[i]:.1f},{R},{E}")
    (out / f"{name}.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    kept = (cooling.time >= 30.0) & (cooling.time <= 330.0)
    hot = pm_files.read("ohm", cooling.ohm[kept], f"{name}.hot", draws)
    sheet = pm_files.sheet(name, plan.base, plan.current, cold, float(air[-1]))
    (out / f"{name}.toml").write_text(tomlkit.dumps(sheet), encoding="utf-8")
    after = [f"{t:.0f},{R:.4g}" for t, R in zip(cooling.time[kept], hot)]
    (out / f"{name}-cooling.csv").write_text("\n".join(["time_s,R_winding_ohm", *after]) + "\n", encoding="utf-8")
    return cold


def make(out: Path, truth: Path, quick: bool, names: Sequence[str]) -> None:
    out.mkdir(parents=True, exist_ok=True)
    draws, document = Draws(SEED), tomlkit.document()
    document.add(tomlkit.comment("The truth behind cases/pmsm-bases and cases/pmsm-machines. No room reads this file."))
    document["seed"] = SEED
    with ProcessPoolExecutor(1) as pool:
        jobs = {name: pool.submit(simulate, name, quick) for name in names}
        for name, job in jobs.items():
            loaded, cooling, taken = job.result()
            cold = write(out, name, loaded, cooling, draws)
            draws.taken.update(taken)
            document[name] = {
                "imbalance": float(f"{loaded.imbalance:.1e}"),
                "cooling_imbalance": float(f"{cooling.imbalance:.1e}"),
                "winding_degC": round(float(loaded.winding[-1]), 2),
                "magnets_degC": round(float(loaded.magnets[-1]), 2),
                "ambient_degC": round(float(loaded.ambient[-1]), 2),
                "base_path_W_K": round(loaded.base_path, 4),
                "body_path_W_K": round(loaded.body_path, 4),
                **cold,
            }
    document["drawn"] = {name: float(f"{value:.6g}") for name, value in sorted(draws.taken.items())}
    truth.write_text(tomlkit.dumps(document), encoding="utf-8")


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="simulated.pm_tests", description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder for the CSV files")
    parser.add_argument("--quick", action="store_true", help="coarse mesh, steps of 15 min")
    parser.add_argument("--only", nargs="+", choices=list(PLANS), default=list(PLANS))
    given = parser.parse_args(arguments)
    truth = given.out / "truth.toml" if given.quick or given.only != list(PLANS) else TRUTH
    make(given.out, truth, given.quick, given.only)


if __name__ == "__main__":
    main()
