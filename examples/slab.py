"""A slab that cools in a stream of air, cut into forty nodes.

Initially hot throughout, insulated at the back, Biot number 1 at the face. After a while one shape is left, which
decays with the time constant L^2 / (alpha zeta^2), zeta tan zeta = Bi: zeta = 0.8603 (Incropera and DeWitt, 6th
edition, table 5.1).

    python examples/slab.py
"""

# %%
import numpy as np

import thermoscope as ts

L, AREA, K, RHO_CP, H = 0.05, 1.0, 20.0, 3.6e6, 400.0  # m, m2, W/m/K, J/m3/K, W/m2/K: Bi = h L / k = 1
N, AIR, HOT = 40, 20.0, 120.0
CELL = L / N

# %% One node per cell, half a cell of conduction between the last node and the face.
nodes = {f"cell {i}": {"C_J_K": RHO_CP * CELL * AREA} for i in range(N)}
links = {f"conduction {i}": {"between": [f"cell {i}", f"cell {i + 1}"], "G_W_K": K * AREA / CELL} for i in range(N - 1)}
links["film"] = {"between": [f"cell {N - 1}", "air"], "R_K_W": 1 / (H * AREA) + CELL / 2 / (K * AREA)}
network = ts.read_network({"network": {"name": "slab", "boundaries": ["air"]}, "nodes": nodes, "links": links})

# %% Half an hour of cooling; the middle of the slab is its back.
time = np.arange(0.0, 1801.0, 5.0)
run = ts.simulate(network, ts.Record(time, {}, {"air": AIR}, HOT), keep_states=True)
rise = run.z[:, network.column("cell 0")] - AIR

# %% Time constant (s) over the last quarter of an hour, and Heisler's.
computed = 900.0 / np.log(rise[time == 900.0] / rise[time == 1800.0])[0]
expected = L**2 / (K / RHO_CP * 0.8603**2)
print(f"time constant: computed {computed:.1f} s, series {expected:.1f} s")
