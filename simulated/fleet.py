"""A fleet of water-cooled motors that should be equal: 11 cells each, all motors in one array, steps of fourth order.

    python -m simulated.fleet --out DIR [--motors 200] [--fouled 37] [--loose 112]

Writes DIR/fleet/motor-001@2025-01.csv ... and DIR/case, a declared network of three nodes to look at them with. Motors
differ in jacket, joint and resistance as production does; in all of them the jacket fouls over the months; in one it is
fouled much more, in one the joint of stator and housing is loose. No code of the tool is used.
"""

import argparse
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np

MONTHS = ("2025-01", "2026-01", "2027-01")
DRIFT_YEAR = -0.10  # of the logarithm of the jacket's film
SCATTER = {"jacket": 0.08, "joint": 0.12, "resistance": 0.02}  # log-sd from motor to motor
FOULED, LOOSE = 0.5, 0.4  # of the usual
STEP_S, RECORD_S, LENGTH_S = 1.0, 2.0, 5400.0
SIGMA_K = 0.15
# cells: slot winding, two end windings, four rings of the stator, two of the housing, rotor, water
C = np.array([1500.0, 700.0, 700.0, 1600.0, 1600.0, 1600.0, 1600.0, 2200.0, 2200.0, 5000.0, 900.0])
RING = 260.0  # W/K from ring to ring of the stator
HEADER = "time_s,current,speed,water,room,winding,stator,housing"


@dataclass(frozen=True)
class Motors:
    """(n,) factors of every motor, one being usual"""

    jacket: np.ndarray
    joint: np.ndarray
    resistance: np.ndarray


def drawn(n: int, rng: np.random.Generator, fouled: int | None, loose: int | None) -> Motors:
    """Motors as production makes them, and two that are not (counted from 0)."""
    jacket, joint, resistance = (np.exp(sd * rng.standard_normal(n)) for sd in SCATTER.values())
    if fouled is not None:
        jacket[fouled] *= FOULED
    if loose is not None:
        joint[loose] *= LOOSE
    return Motors(jacket, joint, resistance)


def slope(T: np.ndarray, amps: float, rpm: float, water: float, room: float, m: Motors) -> np.ndarray:
    """dT/dt (n, 11) of all motors; T in degC."""
    n = rpm / 3000.0
    F = np.zeros_like(T)

    def flow(a: int, b: int, G: np.ndarray | float) -> None:
        q = G * (T[:, a] - T[:, b])
        F[:, a] -= q
        F[:, b] += q

    for cell, share in ((0, 0.55), (1, 0.225), (2, 0.225)):
        F[:, cell] += share * 0.02 * m.resistance * amps**2 * (1.0 + 0.00393 * (T[:, cell] - 20.0))
    for ring, share in zip(range(3, 7), (0.5, 0.25, 0.15, 0.1), strict=True):
        F[:, ring] += share * (90.0 * n + 220.0 * n**2)
    F[:, 9] += 25.0 * n**1.6
    flow(0, 1, 9.0)
    flow(0, 2, 9.0)
    flow(0, 3, 70.0)
    for ring in range(3, 6):
        flow(ring, ring + 1, RING)
    flow(6, 7, 75.0 * m.joint)
    flow(7, 8, 400.0)
    flow(8, 10, 110.0 * m.jacket)
    flow(9, 3, 1.5 + 2.5 * n)
    rise = np.abs(T[:, 8] - room)
    out = 0.9 * rise**0.25 * (T[:, 8] - room) + 4.5e-9 * ((T[:, 8] + 273.15) ** 4 - (room + 273.15) ** 4)
    F[:, 8] -= out
    F[:, 10] -= 600.0 * (T[:, 10] - water)
    return F / C


def warmed(motors: Motors, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Times and loads (t, 5) of a test, and the readings (t, n, 3) of every motor: winding, stator, housing."""
    time = np.arange(0.0, LENGTH_S, STEP_S)
    amps = 120.0 * rng.uniform(0.4, 1.2, 19)[(time / 300.0).astype(int)]
    rpm = 3000.0 * rng.uniform(0.3, 1.2, 13)[(time / 450.0).astype(int)]
    water, room = 30.0 + 2.0 * np.sin(time / 900.0), np.full(time.size, 22.0)
    T = np.full((motors.jacket.size, C.size), 25.0)
    kept = []
    for k in range(time.size):
        if k % int(RECORD_S / STEP_S) == 0:
            winding = T[:, :3] @ np.array([0.55, 0.225, 0.225])
            kept.append(np.stack([winding, T[:, 3:7].mean(axis=1), T[:, 7:9].mean(axis=1)], axis=1))
        given = (amps[k], rpm[k], water[k], room[k], motors)
        a = slope(T, *given)
        b = slope(T + 0.5 * STEP_S * a, *given)
        c = slope(T + 0.5 * STEP_S * b, *given)
        d = slope(T + STEP_S * c, *given)
        T = T + STEP_S / 6.0 * (a + 2.0 * b + 2.0 * c + d)
    y = np.array(kept)
    y = y + 0.3 * rng.standard_normal((1, *y.shape[1:])) + SIGMA_K * rng.standard_normal(y.shape)
    return np.column_stack([time, amps, rpm, water, room])[:: int(RECORD_S / STEP_S)], y


def written(
    out: Path, motors: int, fouled: int | None, loose: int | None, seed: int = 1, months: tuple[str, ...] = MONTHS
) -> tuple[Path, Path]:
    """The case, and the folder of the recordings."""
    rng = np.random.default_rng(seed)
    usual = drawn(motors, rng, fouled, loose)
    case, fleet = out / "case", out / "fleet"
    (case / "tests").mkdir(parents=True)
    fleet.mkdir()
    for name, file in (("case", "case.toml"), ("network", "network.toml"), ("sheet", "tests/reference.toml")):
        shutil.copyfile(Path(__file__).with_name(f"fleet.{name}.toml"), case / file)
    for month in months:
        years = int(month[:4]) - int(months[0][:4]) + (int(month[5:]) - int(months[0][5:])) / 12.0
        loads, y = warmed(Motors(usual.jacket * np.exp(DRIFT_YEAR * years), usual.joint, usual.resistance), rng)
        for i in range(motors):
            _csv(fleet / f"motor-{i + 1:03d}@{month}.csv", loads, y[:, i])
    loads, y = warmed(Motors(*np.ones((3, 1))), rng)
    _csv(case / "tests" / "reference.csv", loads, y[:, 0])
    return case, fleet


def _csv(file: Path, loads: np.ndarray, y: np.ndarray) -> None:
    np.savetxt(file, np.column_stack([loads, y]), fmt="%.3f", delimiter=",", header=HEADER, comments="")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--motors", type=int, default=200)
    parser.add_argument("--fouled", type=int, default=37)
    parser.add_argument("--loose", type=int, default=112)
    given = parser.parse_args()
    written(given.out, given.motors, given.fouled - 1, given.loose - 1)


if __name__ == "__main__":
    main()
