"""Ten minutes on, twenty minutes off, again and again: how hot a body of one time constant gets.

With tau = C / G the peak of the periodic state is T_air + P/G (1 - exp(-t_on / tau)) / (1 - exp(-t_period / tau)).

    python examples/duty_cycle.py
"""

# %%
import numpy as np

import thermoscope as ts

C, G, P, AIR = 9000.0, 5.0, 600.0, 25.0  # J/K, W/K, W, degC
ON, PERIOD, CYCLES = 600.0, 1800.0, 12  # s

# %% The loss is P times the input "load_percent" over 100.
network = ts.read_network(
    {
        "network": {"name": "motor", "boundaries": ["air"]},
        "nodes": {"motor": {"C_J_K": C}},
        "links": {"film": {"between": ["motor", "air"], "G_W_K": G}},
        "losses": {
            "all": {
                "kind": "friction",
                "at": "motor",
                "P_W": P,
                "of": {"input": "load_percent", "at": 100.0, "exponent": 1.0},
            }
        },
    }
)

# %% A time that is given twice is a jump of the load.
edges = np.array([[0.0, ON, ON, PERIOD]]) + PERIOD * np.arange(CYCLES)[:, None]
time = edges.ravel()
load = np.tile([100.0, 100.0, 0.0, 0.0], CYCLES)
run = ts.simulate(network, ts.Record(time, {"load_percent": load}, {"air": AIR}, AIR), keep_states=True)
computed = run.z[:, network.column("motor")][-3]
tau = C / G
expected = AIR + P / G * (1 - np.exp(-ON / tau)) / (1 - np.exp(-PERIOD / tau))
print(f"peak: computed {computed:.4f} degC, exact {expected:.4f} degC")
