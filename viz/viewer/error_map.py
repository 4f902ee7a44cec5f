"""Measured minus modelled everywhere, as the page mixes it: what each sensor's residual tells at every node."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from geom.arrays import Array
from viz.data import short
from viz.rendering.nodes import SplitMesh
from viz.viewer.part_shapes import packed_fields

ERROR = 0.02  # of a residual: far below what a sensor can tell
STEP = 0.008  # of a residual, of the shapes at their largest amplitude
SHARE = 0.02  # in which steps the explained share is kept
PEAK = 0.99  # of the instants whose largest error the colours reach: the first seconds of a start are left out


@dataclass(frozen=True)
class ErrorMap:
    """sensors : names of m channels;  gain : (n_nodes, m) K/K;  explained : (n_nodes,) share of the variance, see
    validation.comparison.interpolation"""

    sensors: tuple[str, ...]
    gain: Array
    explained: Array

    def at(self, residual_K: Mapping[str, Array]) -> Array:
        """(n_nodes, n) K from residuals (n,) K; what was not read tells nothing."""
        return np.asarray(self.gain @ np.nan_to_num(np.stack([residual_K[name] for name in self.sensors])))


def packed_maps(maps: Sequence[ErrorMap], nodes: SplitMesh) -> dict[str, Any]:
    """gains : of every test and sensor, in the order of their names;  told : of every test, the explained share."""
    return {
        "gains": packed_fields(np.concatenate([m.gain.T for m in maps]), nodes, ERROR, STEP),
        "sensors": [[short(name) for name in m.sensors] for m in maps],
        "told": packed_fields(np.stack([m.explained for m in maps]), nodes, SHARE, SHARE),
    }
