"""A network of one node against its closed form.

One heat capacity, one conductance to the air, a constant loss: T = T_air + P/G (1 - exp(-G t / C)).
Prints the largest difference between the run and the formula.

    python examples/one_node.py
"""

# %%
import numpy as np

from thermoscope.lumped import Record, bare_network, node_link, node_source, simulate
from thermoscope.lumped.transfer.laws import Fixed

C, G, P, AIR = 3000.0, 4.0, 120.0, 20.0

# %% The network: one node, one link, one source.
network = bare_network("one node", {"housing": C}, ("ambient",))
link = node_link(network, "film", "film", "housing", "ambient", Fixed(G))
source = node_source(network, "loss", "copper", {"housing": 1.0}, Fixed(P))
network = network.extended([link], [source], ())

# %% An hour at constant loss.
time = np.arange(0.0, 3601.0, 5.0)
run = simulate(
    network, Record(time, {}, {"ambient": np.full(time.size, AIR)}, AIR), rows=[network.place("housing").mean]
)
computed = np.asarray(run.y)[:, 0]
exact = AIR + P / G * (1.0 - np.exp(-G * time / C))

# %%
error_K = float(np.abs(computed - exact).max())
print(f"computed {computed[-1]:.4f} degC, exact {exact[-1]:.4f} degC, largest difference {error_K:.2e} K")
