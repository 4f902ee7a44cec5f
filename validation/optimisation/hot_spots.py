"""Places whose largest temperature is limited: the hot spot of a part that was meshed, else a node."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.condensation.recovery import Shapes
from lumped.model.network import Network, Row

Array = NDArray[np.float64]


@dataclass(frozen=True)
class HotSpots:
    """name, limit (degC);  states (k,);  V (m, k) temperatures of points as sums over the states"""

    name: str
    limit: float
    states: NDArray[np.int64]
    V: Array

    def hottest(self, z: Array) -> tuple[float, Row]:
        """degC, and the point's row."""
        T = self.V @ z[self.states]
        k = int(np.argmax(T))
        return float(T[k]), Row(self.states, self.V[k])


def hot_spots(network: Network, rows: Mapping[str, Row], limits: Mapping[str, float]) -> tuple[HotSpots, ...]:
    """One per limited place; a part's mean becomes its field."""
    parts = network.recovery.parts if isinstance(network.recovery, Shapes) else {}
    out = []
    for name, limit in limits.items():
        if name in parts:
            out.append(HotSpots(name, limit, parts[name].states, np.unique(parts[name].V, axis=0)))
        else:
            out.append(HotSpots(name, limit, rows[name].index, rows[name].weights[None, :]))
    return tuple(out)
