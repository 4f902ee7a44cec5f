"""Places whose largest temperature is limited: the hot spot of a part that was meshed, else a node; or its mean."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from thermoscope import Network, plugin as th

MEAN = ".mean"  # after the name of a place: its mean instead of its hottest point
CHUNK = 64  # instants that are looked at together: a part of 10,000 points then takes 5 MB


@dataclass(frozen=True)
class HotSpots:
    """name, limit (degC);  states (k,);  V (m, k) temperatures of points as sums over the states"""

    name: str
    limit: float
    states: th.Ints
    V: th.Array

    def along(self, z: th.Array) -> th.Array:
        """(nt,) degC of the hottest point at every instant.  z : (nt, n_states + n_boundaries)"""
        x = z[:, self.states]
        return np.concatenate([(x[k : k + CHUNK] @ self.V.T).max(axis=1) for k in range(0, len(x), CHUNK)])

    def hottest(self, z: th.Array) -> tuple[float, th.Row]:
        """degC, and the point's row."""
        T = self.V @ z[self.states]
        k = int(np.argmax(T))
        return float(T[k]), th.Row(self.states, self.V[k])


def hot_spots(network: Network, rows: Mapping[str, th.Row], limits: Mapping[str, float]) -> tuple[HotSpots, ...]:
    """One per limited place, by its hottest point; "NAME.mean" is the mean of a place.  rows : place -> its mean"""
    parts = network.recovery.parts if isinstance(network.recovery, th.Shapes) else {}
    out = []
    for name, limit in limits.items():
        if name in parts:
            out.append(HotSpots(name, limit, parts[name].states, np.unique(parts[name].V, axis=0)))
        else:
            mean = rows[name if name in rows else name.removesuffix(MEAN)]
            out.append(HotSpots(name, limit, mean.index, mean.weights[None, :]))
    return tuple(out)
