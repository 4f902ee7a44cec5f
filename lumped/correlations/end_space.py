"""Air in the end space, stirred by the rotor."""

from typing import TypeVar

import numpy as np

from geom.arrays import Array
from lumped.correlations.info import Info, checked

Number = TypeVar("Number", float, Array)

# k1 (W/m2/K), k2 ((s/m)^k3), k3, as listed by Staton et al. 2005: end spaces differ by a factor 2 to 3 at standstill.
PUBLISHED = {
    "Schubert": (15.0, 0.4, 0.9),
    "Mellor 1991": (15.5, 0.29, 1.0),
    "Boglietti 2003": (41.4, 6.22 / 41.4, 1.0),
    "Stokum": (33.2, 0.0445, 1.0),
    "Di Gerlando": (40.0, 0.1, 1.0),
    "Hamdi": (10.0, 0.3, 1.0),
}
SCHUBERT = PUBLISHED["Schubert"]


def end_space(
    v: Number, k1: float = SCHUBERT[0], k2: float = SCHUBERT[1], k3: float = SCHUBERT[2]
) -> tuple[Number, Info]:
    """h = k1 (1 + k2 v^k3) (W/m2/K), v: air speed at the wall (m/s) = local share of the rotor's tip speed.

    The default set is Schubert's, the one Motor-CAD starts from; the published sets differ by a factor 2 to 3 at
    standstill, so k1 is a parameter to calibrate (log-sd about 0.4).
    Range: v < 50 m/s. Source: Staton, Boglietti, Cavagnino 2005, IEEE Trans. Energy Convers. 20, 620.
    """
    h = k1 * (1.0 + k2 * abs(v) ** k3)
    top = float(np.max(np.abs(v)))
    return h, checked("end_space", "Staton et al. 2005", {"v": top}, {"v": (0, 50)})
