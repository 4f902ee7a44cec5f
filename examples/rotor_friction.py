"""What a rotor rubs, and the way its heat takes through the bearings while nothing else cools it.

The air in the gap, the end faces, bearings and brushes make heat; two bearings of Kylander's resistance carry it off.

    python examples/rotor_friction.py
"""

# %%
import numpy as np

import thermoscope as ts
from thermoscope.lumped.correlations.bearings import brush_friction, kylander_bearing, skf_friction
from thermoscope.lumped.correlations.rotating import disc_windage, saari_windage

OMEGA, RADIUS, GAP, LENGTH, BORE, AIR = 1500 * np.pi / 30, 0.1, 0.001, 0.2, 0.06, 20.0  # rad/s, m, degC

# %%
watts = {
    "gap": saari_windage(OMEGA, RADIUS, GAP, LENGTH)[0],
    "faces": 2 * disc_windage(OMEGA, RADIUS, BORE / 2)[0],
    "bearings": 2 * skf_friction(1000.0, BORE, OMEGA),
    "brushes": brush_friction(2e-4, OMEGA * 0.05),
}
bearing = kylander_bearing(BORE, OMEGA)[0]
network = ts.read_network(
    {
        "network": {"name": "rotor", "boundaries": ["housing"]},
        "nodes": {"rotor": {"C_J_K": 9000.0}},
        "links": {side: {"between": ["rotor", "housing"], "R_K_W": bearing} for side in ("drive end", "other end")},
        "losses": {name: {"kind": "friction", "at": "rotor", "P_W": heat} for name, heat in watts.items()},
    }
)
computed = ts.steady(network, {}, {"housing": AIR})["rotor"]

# %%
expected = AIR + sum(watts.values()) * bearing / 2
print(", ".join(f"{name} {heat:.1f} W" for name, heat in watts.items()))
print(f"rotor: computed {computed:.3f} degC, exact {expected:.3f} degC through {bearing:.2f} K/W at either end")
