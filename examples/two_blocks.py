"""Two blocks of different temperature brought together and left alone: no heat is lost.

They end at the mean weighted by their heat capacities, on one exponential with C1 C2 / (C1 + C2) / G.

    python examples/two_blocks.py
"""

# %%
import numpy as np

import thermoscope as ts

C = np.array([500.0, 2000.0])  # J/K
G, HOT, COLD = 4.0, 150.0, 20.0  # W/K, degC, degC

# %% The wire to the room is a millionth of the joint: a network needs somewhere for heat to go in the end.
network = ts.read_network(
    {
        "network": {"name": "blocks", "boundaries": ["room"]},
        "nodes": {"hot": {"C_J_K": C[0]}, "cold": {"C_J_K": C[1]}},
        "links": {
            "joint": {"between": ["hot", "cold"], "G_W_K": G},
            "wire": {"between": ["cold", "room"], "G_W_K": 1e-6 * G},
        },
    }
)
time = np.arange(0.0, 601.0, 2.0)
start = {"hot": HOT, "cold": COLD}
run = ts.simulate(network, ts.Record(time, {}, {"room": COLD}, start), keep_states=True)
computed = run.z[:, [network.column("hot"), network.column("cold")]]

# %%
end = C @ [HOT, COLD] / C.sum()
share = np.array([C[1], -C[0]]) / C.sum() * (HOT - COLD)
expected = end + np.exp(-time[:, None] * G * C.sum() / C.prod()) * share
print(
    f"end: computed {computed[-1]}, exact {expected[-1]} degC; heat {C @ computed[-1]:.1f} of {C @ [HOT, COLD]:.1f} J"
)
