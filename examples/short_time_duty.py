"""Short-time duty (S2, IEC 60034-1): how long may a cold machine carry twice its continuous load?

First order: t = tau ln(1 / (1 - limit / rise)), where rise is what the overload would reach in the end.

    python examples/short_time_duty.py
"""

# %%
import numpy as np

import thermoscope as ts

C, G, R, AIR, RATED = 18e3, 10.0, 0.05, 40.0, 120.0  # J/K, W/K, ohm, degC, A
LIMIT = AIR + R * RATED**2 / G  # what the rated current reaches in the end: 72 K
OVERLOAD = 2.0 * RATED

# %% Copper with constant resistance, so that one exponential is exact.
network = ts.read_network(
    {
        "network": {"name": "machine", "boundaries": ["air"]},
        "nodes": {"winding": {"C_J_K": C}},
        "links": {"film": {"between": ["winding", "air"], "G_W_K": G}},
        "losses": {
            "copper": {"kind": "copper", "at": "winding", "currents": ["current_A"], "R20_ohm": R, "alpha_1_K": 0.0}
        },
    }
)
time = np.arange(0.0, 1801.0, 1.0)
current = np.full(time.size, OVERLOAD)
run = ts.simulate(network, ts.Record(time, {"current_A": current}, {"air": AIR}, AIR), keep_states=True)

# %%
T = run.z[:, network.column("winding")]
computed = float(np.interp(LIMIT, T, time))
expected = C / G * np.log(1.0 / (1.0 - (LIMIT - AIR) / (R * OVERLOAD**2 / G)))
print(f"time to {LIMIT:.0f} degC: computed {computed:.2f} s, exact {expected:.2f} s")
