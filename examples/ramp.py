"""A thermometer in a chamber that warms steadily reads late by its time constant, and so low by rate times tau.

python examples/ramp.py
"""

# %%
import numpy as np

import thermoscope as ts

C, G, RATE, START = 20.0, 0.5, 0.05, 20.0  # J/K, W/K: tau = 40 s; K/s, degC
tau = C / G

# %%
network = ts.read_network(
    {
        "network": {"name": "thermometer", "boundaries": ["chamber"]},
        "nodes": {"bulb": {"C_J_K": C}},
        "links": {"film": {"between": ["bulb", "chamber"], "G_W_K": G}},
    }
)
time = np.arange(0.0, 601.0, 2.0)
chamber = START + RATE * time
run = ts.simulate(network, ts.Record(time, {}, {"chamber": chamber}, START), keep_states=True)
computed = run.z[:, network.column("bulb")]

# %%
expected = chamber - RATE * tau * (1 - np.exp(-time / tau))
print(f"at the end {chamber[-1] - computed[-1]:.4f} K too low: rate times tau is {RATE * tau:.4f} K")
