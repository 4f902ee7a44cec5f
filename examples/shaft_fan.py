"""A totally enclosed motor whose fan sits on the shaft: the slower it turns, the less it is cooled.

The film of the housing goes with speed to the power 0.8. The speed rises and falls within an hour; the reference is the
same differential equation, written out and solved by SciPy's Radau method.

    python examples/shaft_fan.py
"""

# %%
import numpy as np
from scipy.integrate import solve_ivp

import thermoscope as ts

C_WINDING, C_HOUSING, G, H, AREA, P, AIR = 3000.0, 12000.0, 12.0, 40.0, 0.5, 400.0, 25.0

# %% The network, and the hour.
network = ts.read_network(
    {
        "network": {"name": "enclosed motor", "boundaries": ["ambient"]},
        "nodes": {
            "winding": {"C_J_K": C_WINDING},
            "housing": {"C_J_K": C_HOUSING, "area_m2": AREA, "washed_by": "ambient"},
        },
        "links": {
            "slot": {"between": ["winding", "housing"], "G_W_K": G},
            "film": {"between": ["housing.outer", "ambient"], "fan": {"h_W_m2K": H, "at_rpm": 1500.0, "exponent": 0.8}},
        },
        "losses": {"copper": {"kind": "constant", "at": "winding", "P_W": P}},
    }
)
time = np.arange(0.0, 3601.0, 10.0)
speed = 1500.0 * (0.6 - 0.4 * np.cos(2 * np.pi * time / 1800.0))
run = ts.simulate(network, ts.Record(time, {"speed_rpm": speed}, {"ambient": AIR}, AIR), keep_states=True)
computed = run.z[:, network.column("winding")]


# %% The same by Radau.
def slope(t: float, T: np.ndarray) -> list[float]:
    """dT/dt (K/s) of winding and housing."""
    n = np.interp(t, time, speed)
    across = G * (T[0] - T[1])
    return [(P - across) / C_WINDING, (across - H * AREA * (n / 1500.0) ** 0.8 * (T[1] - AIR)) / C_HOUSING]


expected = solve_ivp(slope, (0, 3600), [AIR, AIR], "Radau", time, max_step=10.0, rtol=1e-8, atol=1e-8).y[0]
print(f"winding after an hour: computed {computed[-1]:.4f} degC, Radau {expected[-1]:.4f} degC")
