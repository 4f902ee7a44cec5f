"""A thermal wave: a load that comes and goes dies out within a few penetration depths.

The face of a wall swings by a sine. Inside the swing falls as exp(-x / d) and comes late by x / d, d = sqrt(2 a / w).
Source: Carslaw and Jaeger 1959, Conduction of Heat in Solids, 2.6.

    python examples/thermal_wave.py
"""

# %%
import numpy as np

import thermoscope as ts

K, RHO_CP, MEAN, SWING, PERIOD = 50.0, 3.6e6, 60.0, 30.0, 120.0  # W/m/K, J/m3/K, degC, K, s: steel, 1 m2
w, a = 2 * np.pi / PERIOD, K / RHO_CP
d = np.sqrt(2 * a / w)
N, CELL = 120, 0.1 * d  # twelve penetration depths

# %% Twelve periods; the first eleven to forget the start, which fades slowly in a deep wall.
nodes = {f"cell {i}": {"C_J_K": RHO_CP * CELL} for i in range(N)}
links = {f"layer {i}": {"between": [f"cell {i}", f"cell {i + 1}"], "G_W_K": K / CELL} for i in range(N - 1)}
links["face"] = {"between": ["face", "cell 0"], "G_W_K": 2 * K / CELL}
network = ts.read_network({"network": {"name": "wall", "boundaries": ["face"]}, "nodes": nodes, "links": links})
time = np.arange(0.0, 12 * PERIOD + 0.5, 0.5)
face = MEAN + SWING * np.sin(w * time)
run = ts.simulate(network, ts.Record(time, {}, {"face": face}, MEAN), keep_states=True)

# %% The last period, down to three penetration depths.
last, depth = time >= 11 * PERIOD, (np.arange(30) + 0.5) * CELL
computed = run.z[np.ix_(last, [network.column(f"cell {i}") for i in range(30)])]
late = depth / d
expected = MEAN + SWING * np.exp(-late) * np.sin(w * time[last, None] - late)
print(
    f"d = {1e3 * d:.2f} mm; at d the swing is {np.ptp(computed[:, 9:11].mean(1)) / 2:.3f} K, exact {SWING / np.e:.3f} K"
)
