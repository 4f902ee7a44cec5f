"""Winding and housing: the two time constants of a machine, against the eigenvalues of its equations.

Loss is switched on at a cold machine. The exact answer is the matrix exponential of the 2 x 2 system.

    python examples/two_bodies.py
"""

# %%
import numpy as np
from scipy.linalg import expm

import thermoscope as ts

C = np.array([900.0, 12000.0])  # J/K: winding, housing
G, G_AIR, P, AIR = 10.0, 6.0, 300.0, 30.0  # W/K, W/K, W, degC

# %%
network = ts.read_network(
    {
        "network": {"name": "two bodies", "boundaries": ["air"]},
        "nodes": {"winding": {"C_J_K": C[0]}, "housing": {"C_J_K": C[1]}},
        "links": {
            "slot": {"between": ["winding", "housing"], "G_W_K": G},
            "film": {"between": ["housing", "air"], "G_W_K": G_AIR},
        },
        "losses": {"copper": {"kind": "constant", "at": "winding", "P_W": P}},
    }
)
time = np.arange(0.0, 7201.0, 20.0)
run = ts.simulate(network, ts.Record(time, {}, {"air": AIR}, AIR), keep_states=True)
computed = run.z[:, [network.column("winding"), network.column("housing")]]

# %%
A = np.array([[-G, G], [G, -G - G_AIR]]) / C[:, None]
steady = np.linalg.solve(-A, np.array([P, 0.0]) / C)
expected = AIR + np.array([steady - expm(A * t) @ steady for t in time])
slow, fast = sorted(-1.0 / np.linalg.eigvals(A))[::-1]
print(
    f"time constants {slow:.0f} and {fast:.0f} s; winding at the end: computed {computed[-1, 0]:.4f}, "
    f"exact {expected[-1, 0]:.4f} degC"
)
