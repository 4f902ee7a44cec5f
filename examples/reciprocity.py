"""Reciprocity: a watt here warms there as much as a watt there warms here.

The network of links is symmetric, and so is its inverse, the matrix of thermal resistances.

    python examples/reciprocity.py
"""

# %%
import numpy as np

import thermoscope as ts

RNG, NODES = np.random.default_rng(7), [f"n{i}" for i in range(8)]
links = {
    f"{a}-{b}": {"between": [a, b], "G_W_K": float(RNG.uniform(0.5, 20.0))}
    for i, a in enumerate(NODES)
    for b in NODES[i + 1 :]
    if RNG.random() < 0.5
}
links |= {f"{a}-air": {"between": [a, "air"], "G_W_K": float(RNG.uniform(0.1, 3.0))} for a in NODES}


# %%
def rises(at: str) -> list[float]:
    """Rise (K) of every node by 1 W in one of them."""
    network = ts.read_network(
        {
            "network": {"name": "eight nodes", "boundaries": ["air"]},
            "nodes": {n: {"C_J_K": 1.0} for n in NODES},
            "links": links,
            "losses": {"watt": {"kind": "constant", "at": at, "P_W": 1.0}},
        }
    )
    found = ts.steady(network, {}, {"air": 0.0})
    return [found[n] for n in NODES]


computed = np.array([rises(n) for n in NODES])
expected = computed.T

# %% And against the inverse of the matrix of conductances.
G = np.zeros((8, 8))
for link in links.values():
    a, b = (NODES.index(n) if n in NODES else None for n in link["between"])
    G[a, a] += link["G_W_K"]
    if b is not None:
        G[b, b] += link["G_W_K"]
        G[a, b] -= link["G_W_K"]
        G[b, a] -= link["G_W_K"]
inverse = np.linalg.inv(G)
print(
    f"largest asymmetry {np.abs(computed - expected).max():.1e} K/W; off the inverse by "
    f"{np.abs(computed - inverse).max():.1e} K/W"
)
