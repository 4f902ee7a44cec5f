"""A pin fin cut into forty nodes: its efficiency against tanh(mL) / (mL).

Adiabatic tip; m = sqrt(4 h / (k d)) (Incropera and DeWitt, 6th edition, equation 3.89).

    python examples/fin.py
"""

# %%
import numpy as np

import thermoscope as ts

L, D, K, H, BASE, AIR = 0.06, 0.005, 200.0, 60.0, 90.0, 20.0  # m, m, W/m/K, W/m2/K, degC, degC
N = 40
CELL, SECTION, SKIN = L / N, np.pi * D**2 / 4, np.pi * D * L / N

# %% Conduction from middle to middle, half a cell to the base, a film on every cell.
nodes = {f"cell {i}": {"C_J_K": 0.2} for i in range(N)}
links = {f"film {i}": {"between": [f"cell {i}", "air"], "G_W_K": H * SKIN} for i in range(N)}
links |= {
    f"cell {i} on": {"between": [f"cell {i}", f"cell {i + 1}"], "G_W_K": K * SECTION / CELL} for i in range(N - 1)
}
links["base"] = {"between": ["base", "cell 0"], "G_W_K": 2 * K * SECTION / CELL}
network = ts.read_network({"network": {"name": "fin", "boundaries": ["base", "air"]}, "nodes": nodes, "links": links})

# %% Heat off the skin as a share of what an isothermal fin would give.
rest = ts.steady(network, {}, {"base": BASE, "air": AIR})
computed = np.mean([rest[name] - AIR for name in nodes]) / (BASE - AIR)
m = (4 * H / (K * D)) ** 0.5
expected = np.tanh(m * L) / (m * L)
print(f"efficiency: computed {computed:.5f}, exact {expected:.5f}")
