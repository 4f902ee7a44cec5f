"""A thick wall whose face is suddenly held at another temperature: the error function.

(T - Ts) / (Ti - Ts) = erf(x / (2 sqrt(alpha t))) (Incropera and DeWitt, 6th edition, equation 5.57).

    python examples/semi_infinite.py
"""

# %%
import numpy as np
from scipy.special import erf

import thermoscope as ts

K, RHO_CP, START, FACE = 50.0, 3.6e6, 20.0, 100.0  # W/m/K, J/m3/K, degC, degC: steel, 1 m2
N, CELL, DURATION = 120, 0.0025, 300.0  # 0.3 m deep; warmth reaches 4 sqrt(alpha t) = 0.26 m

# %%
nodes = {f"cell {i}": {"C_J_K": RHO_CP * CELL} for i in range(N)}
links = {f"layer {i}": {"between": [f"cell {i}", f"cell {i + 1}"], "G_W_K": K / CELL} for i in range(N - 1)}
links["face"] = {"between": ["face", "cell 0"], "G_W_K": 2 * K / CELL}
network = ts.read_network({"network": {"name": "wall", "boundaries": ["face"]}, "nodes": nodes, "links": links})
time = np.arange(0.0, DURATION + 1.0, 1.0)
run = ts.simulate(network, ts.Record(time, {}, {"face": FACE}, START), keep_states=True)

# %% Down to 0.1 m after five minutes.
depth = (np.arange(40) + 0.5) * CELL
computed = run.z[-1, [network.column(f"cell {i}") for i in range(40)]]
expected = FACE + (START - FACE) * erf(depth / (2 * np.sqrt(K / RHO_CP * DURATION)))
print(f"at {depth[-1] * 1e3:.0f} mm: computed {computed[-1]:.3f} degC, exact {expected[-1]:.3f} degC")
