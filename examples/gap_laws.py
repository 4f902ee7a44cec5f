"""The air gap by five laws: at rest all of them conduct, and they part where vortices start.

Taylor's film and Romanazzi's are of one wall, so two of them are the gap; Becker and Kaye's is of the whole gap.
Kosterin and Finat'ev's is Taylor's where no air is blown through; Gazley's factor is of slots.

    python examples/gap_laws.py
"""

# %%
import warnings

import numpy as np

from thermoscope.lumped.correlations import RangeWarning
from thermoscope.lumped.correlations.air_gap import (
    becker_kaye,
    gazley_slotting,
    kosterin_finatev,
    romanazzi_howey,
    taylor_film,
)
from thermoscope.lumped.transfer.properties import air

RADIUS, GAP, SLOT = 0.1, 0.001, 0.02  # m
AIR = air(80.0)
warnings.simplefilter("ignore", RangeWarning)  # nothing is blown through: there Kosterin's law is Taylor's


# %%
def whole_gap(omega):
    """h (W/m2/K) from wall to wall at a speed (rad/s)."""
    taylor, info = taylor_film(omega, RADIUS, GAP, AIR)
    slots = gazley_slotting(SLOT, GAP, info.numbers["Ta"])[0]
    blown = kosterin_finatev(omega, 0.0, RADIUS, GAP, AIR)[0]
    poles = romanazzi_howey(omega, RADIUS, GAP, AIR)[0]
    return np.array([taylor / 2, becker_kaye(omega, RADIUS, GAP, AIR)[0], blown / 2, poles / 2, slots * taylor / 2])


# %%
computed = whole_gap(0.0)
expected = np.full(5, AIR.k / GAP)
for rpm in (0, 1500, 6000, 15000):
    print(f"{rpm:6d} 1/min:", *(f"{h:7.1f}" for h in whole_gap(rpm * np.pi / 30.0)), "W/m2/K")
