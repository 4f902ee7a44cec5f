"""A fan that starts after half an hour: two exponentials, joined where the film changes.

python examples/switched_fan.py
"""

# %%
import numpy as np

import thermoscope as ts

C, P, STILL, FAN, AIR, ON = 9000.0, 200.0, 2.0, 8.0, 20.0, 1800.0  # J/K, W, W/K, W/K, degC, s

# %% The fan's film is in parallel with that of still air, and follows an input that is 0 or 1.
network = ts.read_network(
    {
        "network": {"name": "housing", "boundaries": ["air"]},
        "nodes": {"housing": {"C_J_K": C}},
        "links": {
            "still": {"between": ["housing", "air"], "G_W_K": STILL},
            "fan": {"between": ["housing", "air"], "G_W_K": FAN, "of": {"input": "fan_on", "at": 1.0, "exponent": 1.0}},
        },
        "losses": {"heat": {"kind": "constant", "at": "housing", "P_W": P}},
    }
)
time = np.arange(0.0, 3601.0, 1.0)
fan = (time >= ON).astype(float)
run = ts.simulate(network, ts.Record(time, {"fan_on": fan}, {"air": AIR}, AIR), keep_states=True)
computed = run.z[:, network.column("housing")]


# %%
def course(start: float, G: float, t: np.ndarray) -> np.ndarray:
    """Temperature (degC) t seconds after it was at `start`, with all of G to the air."""
    end = AIR + P / G
    return end + (start - end) * np.exp(-t * G / C)


hot = float(course(AIR, STILL, np.array(ON)))
expected = np.where(time < ON, course(AIR, STILL, time), course(hot, STILL + FAN, time - ON))
print(
    f"hottest {computed.max():.3f} degC, exact {expected.max():.3f}; at the end {computed[-1]:.3f} and "
    f"{expected[-1]:.3f} degC"
)
