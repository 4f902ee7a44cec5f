"""Ducts that are no tubes: what their shape does to a laminar film, and air between two cylinders that starts to swirl.

Shah and London's table for rectangles of one heat flux goes from parallel plates to a square. An annulus at rest has a
number of its own, and in a fast stream that of a tube within a tenth.

    python examples/duct_shapes.py
"""

# %%
import numpy as np

from thermoscope.lumped.correlations.ducts import duct_film, gnielinski_annulus, hausen_laminar, shah_london
from thermoscope.lumped.transfer.properties import air

AIR, INNER, OUTER, LENGTH = air(40.0), 0.1, 0.12, 0.5  # m
WIDE = OUTER - INNER

# %%
plates, square = shah_london(0.0), shah_london(1.0)
resting = gnielinski_annulus(0.0, INNER, OUTER, LENGTH, AIR)[0] * WIDE / AIR.k
far = hausen_laminar(1000.0, AIR.Pr, WIDE, 1e6)
computed = np.array([plates, square, resting, far])

# %%
expected = np.array([8.235, 3.608, 3.66 + 1.2 * (INNER / OUTER) ** -0.8, 3.66])
for speed in (1.0, 5.0, 20.0, 40.0):
    annulus, tube = gnielinski_annulus(speed, INNER, OUTER, LENGTH, AIR)[0], duct_film(speed, WIDE, LENGTH, AIR)[0]
    print(f"{speed:4.0f} m/s: between cylinders {annulus:6.1f} W/m2/K, in a tube as wide {tube:6.1f}")
print("Nu: computed", computed.round(3), "published", expected.round(3))
