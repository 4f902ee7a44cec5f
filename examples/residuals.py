"""Where a published network disagrees with a measured motor.

Opens the measured traction motor that comes along (Liu et al. 2024), runs the published three-node network on a
profile that was never used, and draws measured against modelled, the residuals, and the rotor's residual against speed.

    python examples/residuals.py [FOLDER]
"""

# %%
import sys
from pathlib import Path

import numpy as np

import thermoscope as ts
from thermoscope.case_folder.runs import comparison_of
from thermoscope.viz import measured_and_model, residuals
from thermoscope.viz.live import against_input, parity, save

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out/examples")

# %% The case and one of its held-out profiles.
case = ts.open("hust-ipmsm")
test = next(t for t in case.tests.values() if t.role == "hold-out")
comparison = comparison_of(case.folder, test)

# %% On paper.
measured_and_model(comparison, png=out / "residuals-1.png")
residuals(comparison, png=out / "residuals-2.png")

# %% To move about in.
rotor = next(c.name for c in comparison.channels if c.place == "rotor")
speed = next(name for name in test.inputs if "speed" in name)
save(against_input(comparison, rotor, speed), out / "against-speed.html")
save(parity(comparison), out / "parity.html")

# %% The error as the tool computes it, and from the curves that were drawn.
computed = next(t for t in case.compare().tests if t.name == test.name).rmse_K
every = np.concatenate([comparison.residual(c) for c in comparison.channels])
exact = float(np.sqrt(np.nanmean(every**2)))
error_K = abs(computed - exact)
print(f"{test.name}: computed {computed:.4f} K, from the curves {exact:.4f} K")
