"""A plate that cools in still air, whose film fades with the temperature difference.

h ~ dT^(1/4) gives dT = (dT0^(-1/4) + G1 t / (4 C))^-4 instead of an exponential (Incropera and DeWitt, 6th edition,
problem 5.9 and equation 9.24).

    python examples/free_convection.py
"""

# %%
import numpy as np

import thermoscope as ts

C, G1, AIR, HOT = 900.0, 0.4, 20.0, 120.0  # J/K, W/K at 1 K of difference, degC, degC

# %%
network = ts.read_network(
    {
        "network": {"name": "plate", "boundaries": ["air"]},
        "nodes": {"plate": {"C_J_K": C}},
        "links": {"film": {"between": ["plate", "air"], "power": {"G_W_K": G1, "exponent": 0.25}}},
    }
)
time = np.arange(0.0, 3601.0, 10.0)
run = ts.simulate(network, ts.Record(time, {}, {"air": AIR}, HOT), keep_states=True)

# %%
computed = run.z[:, network.column("plate")]
expected = AIR + ((HOT - AIR) ** -0.25 + G1 * time / (4 * C)) ** -4
print(f"after an hour: computed {computed[-1]:.4f} degC, exact {expected[-1]:.4f} degC")
