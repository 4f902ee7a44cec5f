"""A locked rotor: the winding warms adiabatically, ever faster as its resistance grows.

No heat leaves within seconds, so C dT/dt = R20 I^2 (1 + alpha (T - 20)) and T grows as an exponential. IEC 60079-7 asks
for the time in which it reaches its limit.

    python examples/locked_rotor.py
"""

# %%
import numpy as np

import thermoscope as ts

C, R20, ALPHA, CURRENT, START, LIMIT = 1500.0, 0.4, 0.00393, 120.0, 40.0, 155.0  # J/K, ohm, 1/K, A, degC, degC

# %%
network = ts.read_network(
    {
        "network": {"name": "locked", "boundaries": ["air"]},
        "nodes": {"winding": {"C_J_K": C}},
        "links": {"film": {"between": ["winding", "air"], "G_W_K": 1e-6}},  # a network has to touch a boundary
        "losses": {
            "copper": {"kind": "copper", "at": "winding", "currents": ["current_A"], "R20_ohm": R20, "alpha_1_K": ALPHA}
        },
    }
)
time = np.arange(0.0, 40.01, 0.1)
record = ts.Record(time, {"current_A": np.full_like(time, CURRENT)}, {"air": START}, START)
T = ts.simulate(network, record, keep_states=True).z[:, network.column("winding")]
computed = float(np.interp(LIMIT, T, time))

# %%
heat = R20 * CURRENT**2
growth = np.log((1 + ALPHA * (LIMIT - 20.0)) / (1 + ALPHA * (START - 20.0)))
expected = C / (heat * ALPHA) * growth
constant = C * (LIMIT - START) / (heat * (1 + ALPHA * (START - 20.0)))
print(f"{LIMIT:g} degC after: computed {computed:.3f} s, exact {expected:.3f} s; if it stayed cold {constant:.1f} s")
