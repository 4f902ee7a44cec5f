"""A small case on disk: a hand-declared network of three nodes and simulated tests with convection it lacks."""

from functools import cache
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

NETWORK = """
[network]
name = "three"
boundaries = ["ambient"]

[nodes.winding]
C_J_K = 2000
prior_sd = 0.1
[nodes.yoke]
C_J_K = 6000
[nodes.flange]
C_J_K = 3000

[links.winding-yoke]
between = ["winding", "yoke"]
G_W_K = 8
prior_sd = 0.3
[links.yoke-flange]
between = ["yoke", "flange"]
G_W_K = 6
[links.yoke-air]
between = ["yoke", "ambient"]
G_W_K = 3
prior_sd = 0.3
[links.flange-air]
between = ["flange", "ambient"]
G_W_K = 1.5
prior_sd = 0.3

[losses.copper]
at = "winding"
kind = "copper"
R20_ohm = 0.02
currents = ["current_A"]
prior_sd = 0.05
"""

CASE = """
[case]
name = "three"
network = "network.toml"
sample_s = 20

[tests.stand]
role = "calibrate"
[tests.road]
role = "validate"
[tests.town]
role = "hold-out"
"""

SHEET = """
[test]
time = "time_s"
description = "simulated"

[columns.current]
quantity = "current"
unit = "A"
[columns.wind]
quantity = "vehicle_speed"
unit = "km/h"
[columns.air]
quantity = "temperature"
unit = "degC"
place = "ambient"
[columns.T_winding]
quantity = "temperature"
unit = "degC"
place = "winding"
[columns.T_yoke]
quantity = "temperature"
unit = "K"
place = "yoke"
[columns.T_flange]
quantity = "temperature"
unit = "degC"
place = "flange"
sigma_K = 0.4
"""

HEADER = "time_s,current,wind,air,T_winding,T_yoke,T_flange"


def measured(seed: int, wind: bool, strength: float, step: float = 10.0) -> np.ndarray:
    """(n, 7) rows of a test of 50 min, one every `step` (s), the columns of HEADER.

    strength : W/K at 10 m/s, the convection at the flange that the network lacks
    """
    return _integrated(seed, wind, strength, step).copy()


@cache
def _integrated(seed: int, wind: bool, strength: float, step: float) -> np.ndarray:
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 3000.0, step)
    current = 100.0 * rng.uniform(0.5, 1.2, 11)[(t / 300).astype(int)]
    speed = rng.uniform(3.0, 15.0, 11)[(t / 280).astype(int)] if wind else np.zeros_like(t)

    def slope(now, T):
        w, y, f = T
        amps, v = np.interp(now, t, current), np.interp(now, t, speed)
        P = 0.02 * amps**2 * (1 + 0.00393 * (w - 20))
        lost = 1.5 + strength * (v / 10) ** 0.8
        return [
            (P - 8 * (w - y)) / 2000,
            (8 * (w - y) - 6 * (y - f) - 3 * (y - 20)) / 6000,
            (6 * (y - f) - lost * (f - 20)) / 3000,
        ]

    T = solve_ivp(slope, (0, t[-1]), [20.0] * 3, t_eval=t, max_step=10, rtol=1e-7).y + 0.05 * rng.standard_normal(
        (3, t.size)
    )
    return np.column_stack(
        [t, current, 3.6 * speed, 20.0 + 0.05 * rng.standard_normal(t.size), T[0], T[1] + 273.15, T[2]]
    )


def write_csv(path: Path, rows: np.ndarray) -> None:
    lines = [HEADER, *(",".join(f"{v:.3f}" for v in row) for row in rows)]
    path.write_text("\n".join(lines) + "\n")


def small_case(folder: Path, strength: float = 6.0, step: float = 10.0) -> Path:
    """The case folder `folder`/three."""
    case = folder / "three"
    (case / "tests").mkdir(parents=True)
    (case / "network.toml").write_text(NETWORK)
    (case / "case.toml").write_text(CASE)
    for seed, name in enumerate(["stand", "road", "town"]):
        write_csv(case / "tests" / f"{name}.csv", measured(seed, name != "stand", strength, step))
        (case / "tests" / f"{name}.toml").write_text(SHEET)
    return case
