"""A field of one's own: a heated ring on a grid made by hand, without a machine file.

Uniform heat, an adiabatic bore, a film outside. T(r) follows by integrating -k r dT/dr = q (r^2 - ri^2) / 2.

    python examples/field_of_a_ring.py
"""

# %%
import numpy as np

from thermoscope import fem
from thermoscope.fem.matrices.grids import ring

BORE, OUTSIDE, HEIGHT, K, Q, FILM, AIR = 0.03, 0.06, 0.01, 20.0, 4e5, 100.0, 20.0  # m, W/m/K, W/m3, W/m2/K, degC


# %%
def fluid(centres):
    """Air on the outside, nothing in the bore and on the faces; centres (n, 3) in (r, theta, z)."""
    return np.where(centres[:, 0] > OUTSIDE - 1e-4, "ambient", "").astype(object)


mesh = ring(
    np.linspace(BORE, OUTSIDE, 13), 144, np.array([0.0, HEIGHT]), lambda c: np.full(len(c), "iron", object), fluid
)
field = fem.assemble(mesh, {"iron": fem.isotropic(K)}, {"iron": 3.6e6})
heat = Q * np.pi * (OUTSIDE**2 - BORE**2) * HEIGHT * field.load("iron")
found = fem.steady(fem.Solver(field), {"iron.outer": FILM}, {}, heat, fem.only_fixed(ambient=AIR))

# %%
radius = np.hypot(field.xyz[:, 0], field.xyz[:, 1])
surface = AIR + Q * (OUTSIDE**2 - BORE**2) / (2 * FILM * OUTSIDE)
computed = found.T
expected = surface + Q / (4 * K) * (OUTSIDE**2 - radius**2) - Q * BORE**2 / (2 * K) * np.log(OUTSIDE / radius)
print(f"bore: computed {computed[radius.argmin()]:.2f} degC, exact {expected[radius.argmin()]:.2f} degC")
print(f"{mesh.tets.shape[0]} tetrahedra; heat in and out agree to {found.energy_balance:.0e}")
