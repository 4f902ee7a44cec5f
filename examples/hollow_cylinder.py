"""Mellor's T-circuit of a uniformly heated hollow cylinder, held against the exact solution.

A stator yoke with losses throughout, cooled at its outside only. The circuit has three resistances; one of them is
negative, and its mean temperature is exact.

    python examples/hollow_cylinder.py
"""

# %%
import numpy as np
from scipy.integrate import quad

import thermoscope as ts
from thermoscope.lumped.correlations.windings import mellor

OUTER, INNER, LENGTH, K, P, FACE = 0.12, 0.08, 0.2, 25.0, 500.0, 60.0  # m, W/m/K, W, degC

# %% Nothing leaves inside or at the ends: outer and mean resistance in series, the second of them negative.
circuit = mellor(OUTER, INNER, LENGTH, K, K)
network = ts.read_network(
    {
        "network": {"name": "Mellor", "boundaries": ["face"]},
        "nodes": {"mean": {"C_J_K": 1000.0}},
        "links": {"outer": {"between": ["mean", "face"], "R_K_W": circuit.outer + circuit.radial_mean}},
        "losses": {"iron": {"kind": "constant", "at": "mean", "P_W": P}},
    }
)
computed = ts.steady(network, {}, {"face": FACE})["mean"]

# %% Exact: T(r) from the heat equation with an insulated inner face, averaged over the section by quadrature.
q = P / (np.pi * (OUTER**2 - INNER**2) * LENGTH)


def exact(r: float) -> float:
    """Temperature (degC) at the radius r (m)."""
    return FACE + q / (4 * K) * (OUTER**2 - r**2) - q * INNER**2 / (2 * K) * np.log(OUTER / r)


expected = quad(lambda r: exact(r) * 2 * r, INNER, OUTER)[0] / (OUTER**2 - INNER**2)
print(f"mean: computed {computed:.4f} degC, exact {expected:.4f} degC")
