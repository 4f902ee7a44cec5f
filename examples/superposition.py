"""Superposition: what two losses do together is what each does alone, added.

True of every network whose coefficients are constant; a film of still air breaks it, and the example says by how much.

    python examples/superposition.py
"""

# %%
import numpy as np

import thermoscope as ts

LOSSES, AIR = {"winding": 150.0, "iron": 80.0}, 25.0  # W, degC
TIME = np.arange(0.0, 7201.0, 30.0)


def rise(at: list[str], still_air: bool = False) -> np.ndarray:
    """Rise of the winding (K) over time, with losses at some nodes only."""
    film = {"between": ["housing", "air"], "G_W_K": 6.0}
    if still_air:
        film = {"between": ["housing", "air"], "power": {"G_W_K": 3.0, "exponent": 0.25}}
    network = ts.read_network(
        {
            "network": {"name": "motor", "boundaries": ["air"]},
            "nodes": {"winding": {"C_J_K": 900.0}, "iron": {"C_J_K": 4000.0}, "housing": {"C_J_K": 6000.0}},
            "links": {
                "slot": {"between": ["winding", "iron"], "G_W_K": 12.0},
                "fit": {"between": ["iron", "housing"], "G_W_K": 30.0},
                "film": film,
            },
            "losses": {n: {"kind": "constant", "at": n, "P_W": LOSSES[n]} for n in at},
        }
    )
    run = ts.simulate(network, ts.Record(TIME, {}, {"air": AIR}, AIR), keep_states=True)
    return run.z[:, network.column("winding")] - AIR


# %%
computed = rise(["winding", "iron"])
expected = rise(["winding"]) + rise(["iron"])
bent = rise(["winding", "iron"], True)[-1], rise(["winding"], True)[-1] + rise(["iron"], True)[-1]
print(f"together {computed[-1]:.3f} K, added {expected[-1]:.3f} K; in still air {bent[0]:.1f} K, added {bent[1]:.1f} K")
