"""A fan that nobody wrote down: it blew on one of two heaters for four minutes of the second recording.

The board is made by its author's own energy balance (APMonitor temperature control lab): 4 g and 10 cm2 a heater,
films of 10 W/m2/K, radiation, exchange over 2 cm2, thermometers that read to 0.3 K. SciPy solves it. The network is
linear and knows neither radiation nor the fan. When did it blow, on what, and how hard?

    python examples/fan_for_a_while.py
"""

# %%
import tempfile
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

import thermoscope as ts

BEGIN, END, TIMES = 420.0, 660.0, 2.5  # s, s, of the film in still air
MASS, CP, FILM, AREA, BETWEEN, BLACK, SIGMA = 0.004, 500.0, 10.0, 1e-3, 2e-4, 0.9, 5.67e-8
AIR, STEP = 21.0, 5.0  # degC, s
rng = np.random.default_rng(3)
time = np.arange(0.0, 1200.0 + STEP, STEP)


# %% What happens on the board.
def slope(t: float, T: np.ndarray, u: np.ndarray, fan: bool) -> np.ndarray:
    """dT/dt (K/s) of both heaters; u : their power (W) at every sample"""
    power = u[min(int(t / STEP), len(u) - 1)]
    blown = np.array([TIMES if fan and BEGIN <= t < END else 1.0, 1.0])
    K, air = T + 273.15, AIR + 273.15
    lost = AREA * (FILM * blown * (T - AIR) + BLACK * SIGMA * (K**4 - air**4))
    across = BETWEEN * (FILM * (T[1] - T[0]) + BLACK * SIGMA * (K[1] ** 4 - K[0] ** 4))
    return (power - lost + across * np.array([1.0, -1.0])) / (MASS * CP)


def recorded(levels: list[tuple[float, float]], fan: bool) -> np.ndarray:
    """(n, 5) time (s), power of both heaters (%), their readings (degC)"""
    percent = np.repeat(levels, int(np.ceil(time.size / len(levels))), axis=0)[: time.size]
    power = percent / 100.0 * np.array([1.0, 0.75])
    run = solve_ivp(slope, (0.0, time[-1]), [AIR, AIR], "Radau", time, max_step=STEP, args=(power, fan))
    read = run.y.T + rng.normal(0.0, 0.2, run.y.T.shape)
    return np.column_stack([time, percent, 0.3 * np.round(read / 0.3)])


TESTS = {
    "steps": ("calibrate", recorded([(80, 0), (80, 60), (20, 60), (60, 20)], False)),
    "work": ("calibrate", recorded([(70, 30), (70, 70), (40, 70), (70, 30)], True)),
}

# %% What is written down: a network of two masses, and two recordings.
NETWORK = """
[network]
name = "board"
boundaries = ["ambient"]
settles_s = 180
[nodes.heater1]
turns = false
mass_kg = 0.004
cp_J_kgK = 500
area_m2 = 0.001
washed_by = "ambient"
[nodes.heater2]
turns = false
mass_kg = 0.004
cp_J_kgK = 500
area_m2 = 0.001
washed_by = "ambient"
[links.film1]
between = ["heater1", "ambient"]
G_W_K = 0.015
prior_sd = 0.2
[links.film2]
between = ["heater2", "ambient"]
G_W_K = 0.015
prior_sd = 0.2
[links.exchange]
between = ["heater1", "heater2"]
G_W_K = 0.003
prior_sd = 0.3
[losses.transistor1]
kind = "constant"
at = "heater1"
P_W = 1.0
of = { input = "power1", at = 1.0, exponent = 1.0 }
[losses.transistor2]
kind = "constant"
at = "heater2"
P_W = 0.75
of = { input = "power2", at = 1.0, exponent = 1.0 }
"""
COLUMNS = """
[test]
time = "t (s)"
initial = "first-readings"
[boundaries]
ambient = 21.0
[columns.power1]
input = "power1"
column = "heater 1 (%)"
quantity = "share"
unit = "%"
[columns.power2]
input = "power2"
column = "heater 2 (%)"
quantity = "share"
unit = "%"
[columns.T1]
column = "T1 (degC)"
quantity = "temperature"
unit = "degC"
place = "heater1"
sigma_K = 0.5
[columns.T2]
column = "T2 (degC)"
quantity = "temperature"
unit = "degC"
place = "heater2"
sigma_K = 0.5
"""


def written(folder: Path) -> Path:
    (folder / "tests").mkdir()
    (folder / "network.toml").write_text(NETWORK)
    roles = [f'[tests.{name}]\nrole = "{role}"\n' for name, (role, _) in TESTS.items()]
    (folder / "case.toml").write_text("".join(['[case]\nname = "board"\nnetwork = "network.toml"\n', *roles]))
    for name, (_, rows) in TESTS.items():
        (folder / "tests" / f"{name}.toml").write_text(COLUMNS)
        head = "t (s),heater 1 (%),heater 2 (%),T1 (degC),T2 (degC)"
        np.savetxt(folder / "tests" / f"{name}.csv", rows, "%.2f", ",", header=head, comments="")
    return folder


# %% Which effect is missing, and when?
with tempfile.TemporaryDirectory() as folder:
    found = ts.open(written(Path(folder))).diagnose()
best = found.odds[0]
print(f"{best.hypothesis}: {100 * best.probability:.0f} %")
size = next(c for c in found.candidates if c.effect == best.effects[0])
low, high = size.ci95
print(f"{size.value:.1f} W/m2/K more ({low:.1f} to {high:.1f}); true {(TIMES - 1.0) * FILM:.1f}")
for event in found.events:
    print(event)
named = best.effects[0].split(" in ")[0]
computed = np.array([best.begin_s or np.nan, best.end_s or np.nan])
expected = np.array([BEGIN, END])
