"""Hysteresis and eddy currents told apart by speed: a core's rise is a parabola of it.

P = h n + e n^2 (Steinmetz, Bertotti), so that the rise over the speed is a straight line.

    python examples/iron_loss.py
"""

# %%
import numpy as np

import thermoscope as ts

HYSTERESIS, EDDY, RATED, G, AIR = 40.0, 60.0, 3000.0, 2.5, 25.0  # W and W at RATED rpm, W/K, degC

# %%
network = ts.read_network(
    {
        "network": {"name": "core", "boundaries": ["air"]},
        "nodes": {"core": {"C_J_K": 4000.0}},
        "links": {"film": {"between": ["core", "air"], "G_W_K": G}},
        "losses": {
            "iron": {"kind": "iron", "at": "core", "hysteresis_W": HYSTERESIS, "eddy_W": EDDY, "speed_at": RATED}
        },
    }
)
speeds = np.array([600.0, 1500.0, 3000.0, 4500.0])
rises = np.array([ts.steady(network, {"speed_rpm": n}, {"air": AIR})["core"] - AIR for n in speeds])

# %% Slope and intercept of rise / speed give both shares back (W).
slope, intercept = np.polyfit(speeds / RATED, G * rises / (speeds / RATED), 1)
computed, expected = np.array([intercept, slope]), np.array([HYSTERESIS, EDDY])
print(f"hysteresis and eddy currents: computed {computed} W, declared {expected} W")
