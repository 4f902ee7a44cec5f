"""A cooling jacket in a wall of one temperature, cut into sixty coolant cells.

The coolant warms along its way; with the wall held at T_w its outlet is T_w - (T_w - T_in) exp(-h A / (m cp))
(Incropera and DeWitt, 6th edition, equation 8.41b).

    python examples/jacket.py
"""

# %%
import numpy as np

import thermoscope as ts

H, AREA, MCP, WALL, INLET, N = 2000.0, 0.12, 400.0, 90.0, 40.0, 60  # W/m2/K, m2, W/K, degC

# %% Each cell takes its share of the wall's area; the stream carries the heat to the next one.
cells = [f"cell {i}" for i in range(N)]
network = ts.read_network(
    {
        "network": {"name": "jacket", "boundaries": ["inlet", "wall"]},
        "nodes": {cell: {"kind": "fluid", "C_J_K": 5.0} for cell in cells},
        "links": {
            f"film {i}": {"between": [cell, "wall"], "h_W_m2K": H, "area_m2": AREA / N} for i, cell in enumerate(cells)
        },
        "streams": {"water": {"path": ["inlet", *cells], "mcp_W_K": MCP}},
    }
)

# %% The cells are mixed: they err by half of a cell's number of transfer units, here 0.3 % of the rise.
found = ts.steady(network, {}, {"inlet": INLET, "wall": WALL})
computed = found[cells[-1]]
expected = WALL - (WALL - INLET) * np.exp(-H * AREA / MCP)
print(f"outlet: computed {computed:.3f} degC, exact {expected:.3f} degC")
