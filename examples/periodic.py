"""A body in air that warms and cools by the day: how far it follows, and how late.

First order: amplitude 1 / sqrt(1 + (w tau)^2) of the air's, phase atan(w tau) behind (any textbook on control).

    python examples/periodic.py
"""

# %%
import numpy as np

import thermoscope as ts

C, G, MEAN, SWING, PERIOD = 60e3, 5.0, 20.0, 10.0, 86400.0  # J/K, W/K, degC, K, s: tau = 12000 s
w, tau = 2 * np.pi / PERIOD, C / G

# %% Three days, the first two to forget the start.
network = ts.read_network(
    {
        "network": {"name": "body", "boundaries": ["air"]},
        "nodes": {"body": {"C_J_K": C}},
        "links": {"film": {"between": ["body", "air"], "G_W_K": G}},
    }
)
time = np.arange(0.0, 3 * PERIOD + 1.0, 300.0)
air = MEAN + SWING * np.sin(w * time)
run = ts.simulate(network, ts.Record(time, {}, {"air": air}, MEAN), keep_states=True)

# %% The third day against the steady oscillation.
last = time >= 2 * PERIOD
computed = run.z[last, network.column("body")]
expected = MEAN + SWING / np.hypot(1.0, w * tau) * np.sin(w * time[last] - np.arctan(w * tau))
print(
    f"largest: computed {computed.max():.3f} degC, exact {expected.max():.3f} degC, "
    f"{np.arctan(w * tau) / w / 3600:.1f} h late"
)
