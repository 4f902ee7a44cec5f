"""Air in the end space, stirred by the rotor."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from lumped.correlations.info import Info, checked

Number = TypeVar("Number", float, NDArray[np.float64])

# Published sets k1 (W/m2/K), k2 ((s/m)^k3), k3.
SCHUBERT, MELLOR, BOGLIETTI = (15.0, 0.4, 0.9), (15.5, 0.29, 1.0), (41.4, 6.22 / 41.4, 1.0)
STOKUM, DI_GERLANDO, HAMDI = (33.2, 0.0445, 1.0), (40.0, 0.1, 1.0), (10.0, 0.3, 1.0)  # published sets


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


def schubert(v: Number) -> tuple[Number, Info]:
    """15 (1 + 0.4 v^0.9)."""
    return end_space(v, *SCHUBERT)


def mellor(v: Number) -> tuple[Number, Info]:
    """15.5 (1 + 0.29 v): Mellor, Roberts, Turner 1991, IEE Proc. B 138, 205."""
    return end_space(v, *MELLOR)


def boglietti(v: Number) -> tuple[Number, Info]:
    """41.4 (1 + 0.15 v): Boglietti, Cavagnino, Lazzari, Pastorelli 2003, IEEE Trans. Ind. Appl. 39, 780."""
    return end_space(v, *BOGLIETTI)


def stokum(v: Number) -> tuple[Number, Info]:
    """33.2 (1 + 0.0445 v), as listed by Staton et al. 2005."""
    return end_space(v, *STOKUM)


def di_gerlando(v: Number) -> tuple[Number, Info]:
    """40 (1 + 0.1 v), as listed by Staton et al. 2005."""
    return end_space(v, *DI_GERLANDO)


def hamdi(v: Number) -> tuple[Number, Info]:
    """10 (1 + 0.3 v), as listed by Staton et al. 2005."""
    return end_space(v, *HAMDI)
