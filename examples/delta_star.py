"""Three bodies joined in a delta or in the equivalent star: the same temperatures.

R_a = R_ab R_ca / (R_ab + R_bc + R_ca) (Kennelly 1899), as for resistors.

    python examples/delta_star.py
"""

# %%
import numpy as np

import thermoscope as ts

AB, BC, CA = 0.5, 0.8, 1.1  # K/W
NODES = {"a": {"C_J_K": 100.0}, "b": {"C_J_K": 100.0}, "c": {"C_J_K": 100.0}}
HEAD = {"name": "bodies", "boundaries": ["air"]}
FILM = {"film": {"between": ["c", "air"], "R_K_W": 2.0}}
LOSSES = {"p": {"kind": "constant", "at": "a", "P_W": 30.0}, "q": {"kind": "constant", "at": "b", "P_W": 10.0}}

# %%
delta = {
    "ab": {"between": ["a", "b"], "R_K_W": AB},
    "bc": {"between": ["b", "c"], "R_K_W": BC},
    "ca": {"between": ["c", "a"], "R_K_W": CA},
}
total = AB + BC + CA
star = {
    f"{body} star": {"between": [body, "star"], "R_K_W": x * y / total}
    for body, x, y in (("a", AB, CA), ("b", AB, BC), ("c", BC, CA))
}
one = ts.read_network({"network": HEAD, "nodes": NODES, "links": {**delta, **FILM}, "losses": LOSSES})
other = ts.read_network(
    {"network": HEAD, "nodes": {**NODES, "star": {"C_J_K": 1.0}}, "links": {**star, **FILM}, "losses": LOSSES}
)

# %%
computed = np.array([ts.steady(one, {}, {"air": 20.0})[body] for body in NODES])
expected = np.array([ts.steady(other, {}, {"air": 20.0})[body] for body in NODES])
print(f"delta {computed}, star {expected} degC; the film carries 40 W: {20.0 + 2.0 * 40.0:.1f} degC")
