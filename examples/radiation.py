"""A body that cools by radiation alone, as in a vacuum.

The time to reach a temperature is known in closed form (Incropera and DeWitt, 6th edition, equation 5.18).

    python examples/radiation.py
"""

# %%
import numpy as np

import thermoscope as ts

C, AREA, EMISSIVITY, WALLS, HOT = 2000.0, 0.1, 0.9, 20.0, 300.0  # J/K, m2, 1, degC, degC
SIGMA, ZERO = 5.670374e-8, 273.15

# %%
network = ts.read_network(
    {
        "network": {"name": "body", "boundaries": ["walls"]},
        "nodes": {"body": {"C_J_K": C}},
        "links": {"cooling": {"between": ["body", "walls"], "area_m2": AREA, "radiation": {"emissivity": EMISSIVITY}}},
    }
)
time = np.arange(0.0, 3601.0, 10.0)
run = ts.simulate(network, ts.Record(time, {}, {"walls": WALLS}, HOT), keep_states=True)
T = run.z[:, network.column("body")] + ZERO

# %% When does the formula say that the body has the temperature of the last instant?
Ts, Ti, Te = WALLS + ZERO, HOT + ZERO, T[-1]


def part(x: float) -> float:
    """The formula's integral, up to the temperature x (K)."""
    return np.log((x + Ts) / (x - Ts)) + 2 * np.arctan(x / Ts)


computed = time[-1]
expected = C / (4 * EMISSIVITY * AREA * SIGMA * Ts**3) * (part(Te) - part(Ti))
print(f"{HOT:.0f} to {Te - ZERO:.1f} degC: computed {computed:.1f} s, exact {expected:.1f} s")
