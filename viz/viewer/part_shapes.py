"""Fields over the machine as the page holds them: every part has few shapes of its own, every field their weights.

Parts need fewer shapes than the machine, for each part's field is smooth: fewer bytes, and less to mix per instant.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from viz.rendering.nodes import SplitMesh
from viz.viewer.low_rank import low_rank
from viz.viewer.packing import packed_numbers, unpacked

Array = NDArray[np.float64]


def packed_fields(fields: Array, nodes: SplitMesh, error: float, step: float) -> dict[str, Any]:
    """Fields (n_fields, n_nodes), each within `error` and rounding to `step`.

    blocks : per part (its nodes, 1 + its shapes), the mean field first;  weights : (n_fields, columns of all blocks)
    """
    blocks, weights = [], []
    for part in range(len(nodes.parts)):
        reduced = low_rank(fields[:, nodes.owner == part], error)
        columns = np.column_stack([reduced.mean, reduced.shapes.T])
        blocks.append(packed_numbers(columns, np.array([step, *reduced.steps(step)])))
        weights += [np.ones((len(fields), 1)), reduced.amplitudes]
    return {"blocks": blocks, "weights": packed_numbers(np.hstack(weights), step)}


def mixed(packed: dict[str, Any]) -> Array:
    """What the page mixes: (n_fields, n_nodes)."""
    weights, first, out = unpacked(packed["weights"]), 0, []
    for block in map(unpacked, packed["blocks"]):
        out.append(weights[:, first : first + block.shape[1]] @ block.T)
        first += block.shape[1]
    return np.hstack(out)
