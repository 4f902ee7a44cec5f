"""A furnace wall of three layers with a film on either side: resistances in series.

q = (T_hot - T_cold) / (1/h1 + sum L/k + 1/h2) (Incropera and DeWitt, 6th edition, equation 3.14).

    python examples/composite_wall.py
"""

# %%
import numpy as np

import thermoscope as ts

LAYERS = {"brick": (0.10, 1.2), "wool": (0.05, 0.04), "steel": (0.003, 50.0)}  # thickness (m), conductivity (W/m/K)
H_HOT, H_COLD, HOT, COLD = 25.0, 8.0, 400.0, 20.0  # W/m2/K, degC; all for 1 m2

# %% A node on each face of a layer; faces hold no heat worth naming.
faces = [f"face {i}" for i in range(len(LAYERS) + 1)]
links = {
    "hot film": {"between": ["furnace", faces[0]], "h_W_m2K": H_HOT, "area_m2": 1.0},
    "cold film": {"between": [faces[-1], "room"], "h_W_m2K": H_COLD, "area_m2": 1.0},
}
for (name, (thick, k)), a, b in zip(LAYERS.items(), faces, faces[1:]):
    links[name] = {"between": [a, b], "R_K_W": thick / k}
network = ts.read_network(
    {
        "network": {"name": "wall", "boundaries": ["furnace", "room"]},
        "nodes": {face: {"C_J_K": 1.0} for face in faces},
        "links": links,
    }
)
rest = ts.steady(network, {}, {"furnace": HOT, "room": COLD})

# %% Temperatures of all faces.
R = np.cumsum([1 / H_HOT, *(thick / k for thick, k in LAYERS.values())])
q = (HOT - COLD) / (R[-1] + 1 / H_COLD)
computed = np.array([rest[face] for face in faces])
expected = HOT - q * R
print(f"heat flux {q:.1f} W/m2; outer face: computed {computed[-1]:.4f}, exact {expected[-1]:.4f} degC")
