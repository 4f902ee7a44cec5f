"""A slab in which heat arises evenly, cooled on one face: how much warmer is its back?

T(0) - T(L) = q L^2 / (2 k) (Incropera and DeWitt, 6th edition, equation 3.43); a flat coil on a cold plate.

    python examples/generation.py
"""

# %%
import thermoscope as ts

L, K, Q, PLATE, N = 0.02, 1.5, 2.0e5, 40.0, 50  # m, W/m/K, W/m3, degC; for 1 m2
CELL = L / N

# %% Fifty cells, a half cell of conduction between the last one and the plate.
nodes = {f"cell {i}": {"C_J_K": 2.5e6 * CELL} for i in range(N)}
links = {f"layer {i}": {"between": [f"cell {i}", f"cell {i + 1}"], "G_W_K": K / CELL} for i in range(N - 1)}
links["plate"] = {"between": [f"cell {N - 1}", "plate"], "G_W_K": 2 * K / CELL}
losses = {f"heat {i}": {"kind": "constant", "at": f"cell {i}", "P_W": Q * CELL} for i in range(N)}
network = ts.read_network(
    {"network": {"name": "coil", "boundaries": ["plate"]}, "nodes": nodes, "links": links, "losses": losses}
)

# %% The heat of every layer through the layers before it sums to N^2 / 2 cells exactly.
computed = ts.steady(network, {}, {"plate": PLATE})["cell 0"] - PLATE
expected = Q * L**2 / (2 * K)
print(f"rise of the back: computed {computed:.3f} K, exact {expected:.3f} K")
