"""A plate pressed on a cooler, and what its faces radiate: contacts and view factors for a network.

The joint is that of rough metals under pressure; grooves look blacker than their walls. Discs, rectangles and cylinders
see each other by their view factors.

    python examples/pressed_and_grey.py
"""

# %%
import numpy as np

import thermoscope as ts
from thermoscope.geom.constants import SIGMA, ZERO_C
from thermoscope.lumped.correlations.contacts import (
    coaxial_discs,
    concentric_cylinders,
    cooper_mikic_yovanovich,
    groove_emissivity,
    parallel_rectangles,
    radiation_film,
)

HEAT, AREA, ROOM = 400.0, 0.01, 20.0  # W, m2, degC

# %%
joint = cooper_mikic_yovanovich(k=180.0, slope=0.1, roughness=2e-6, pressure=1e6, hardness=1e9)[0]
network = ts.read_network(
    {
        "network": {"name": "plate", "boundaries": ["cooler"]},
        "nodes": {"plate": {"C_J_K": 900.0}},
        "links": {"joint": {"between": ["plate", "cooler"], "area_m2": AREA, "h_W_m2K": joint}},
        "losses": {"heat": {"kind": "constant", "at": "plate", "P_W": HEAT}},
    }
)
pressed = ts.steady(network, {}, {"cooler": ROOM})["plate"]

# %%
black = groove_emissivity(0.3, depth=0.03, spacing=0.01)
film = radiation_film(black, 90.0, ROOM, view=parallel_rectangles(0.2, 0.2, 0.1))[0]
discs, shell = coaxial_discs(0.1, 0.1, 0.1), concentric_cylinders(1.0, 1.02, 0.3, 0.3)

# %%
computed = np.array([pressed, film * (90.0 - ROOM), discs, shell])
flux = SIGMA * ((90.0 + ZERO_C) ** 4 - (ROOM + ZERO_C) ** 4)
view = parallel_rectangles(2.0, 2.0, 1.0)  # of the same shape
grey = 0.3 / (0.3 + 0.7 * 0.01 / 0.07)
shells = 1 / (1 / 0.3 + 0.7 / 0.3 / 1.02)
expected = np.array([ROOM + HEAT / (joint * AREA), grey * view * flux, (3 - np.sqrt(5)) / 2, shells])
print(f"joint {joint:.0f} W/m2/K, grooves of 0.3 look like {black:.2f}; computed {computed}, exact {expected}")
