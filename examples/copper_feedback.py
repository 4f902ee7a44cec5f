"""Copper that gets warmer resists more: where a winding settles, and from which current it no longer does.

R = R20 (1 + alpha (T - 20)) and one conductance G to the air give T = T_air + P20 (1 + alpha (T_air - 20)) / (G - alpha
P20); from P20 = G / alpha on there is no rest.

    python examples/copper_feedback.py
"""

# %%
import thermoscope as ts

G, R20, ALPHA, AIR, CURRENT = 4.0, 0.02, 0.00393, 40.0, 150.0  # W/K, ohm, 1/K, degC, A

# %%
network = ts.read_network(
    {
        "network": {"name": "winding", "boundaries": ["air"]},
        "nodes": {"winding": {"C_J_K": 2000.0}},
        "links": {"film": {"between": ["winding", "air"], "G_W_K": G}},
        "losses": {
            "copper": {"kind": "copper", "at": "winding", "currents": ["current_A"], "R20_ohm": R20, "alpha_1_K": ALPHA}
        },
    }
)
P20 = R20 * CURRENT**2
computed = ts.steady(network, {"current_A": CURRENT}, {"air": AIR})["winding"]
expected = AIR + P20 * (1 + ALPHA * (AIR - 20.0)) / (G - ALPHA * P20)
print(f"winding: computed {computed:.4f} degC, exact {expected:.4f} degC")

# %% One per cent above the critical current there is no rest, and the tool says so.
critical = (G / ALPHA / R20) ** 0.5
try:
    ts.steady(network, {"current_A": 1.01 * critical}, {"air": AIR})
    runaway = False
except ts.ThermoscopeError as fault:
    runaway = True
    print(f"at {1.01 * critical:.0f} A: {fault}")
