"""The network beside the machine, as the page draws it: nodes in the half section, heat along the lines between."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from geom.arrays import Array
from geom.meshing.mesh import NamedMesh
from viz.machine.network import CLOSEST, SMALL, places, spread_out
from viz.rendering.nodes import SplitMesh
from viz.viewer.packing import packed_numbers

STEP_K, STEP_W = 0.1, 0.1  # a tenth of what is printed; the page's words have whole degrees and watts
OFF_AXIS = 0.25  # of the largest radius: feet and base are drawn so far below the axis, one below the other


@dataclass(frozen=True)
class NetworkRun:
    """A test with the model as it stands, at n instants.

    T : node -> (n,) degC;  watts : (start, end) -> (n,) W;  conductance : (start, end) -> W/K
    """

    T: Mapping[str, Array]
    watts: Mapping[tuple[str, str], Array]
    conductance: Mapping[tuple[str, str], float]


def _side_by_side(columns: Sequence[Array], rows: int) -> Array:
    """(rows, k), also where there are no columns."""
    return np.reshape(columns, (len(columns), rows)).T


def network_document(mesh: NamedMesh, nodes: SplitMesh, runs: Sequence[NetworkRun]) -> dict[str, Any]:
    """Nodes with their place along the axis and off it (m); flows of 1 % of the largest and more, with their widths."""
    at = {name: xyz for name, xyz in places(mesh, nodes).items() if all(name in r.T for r in runs)}
    if not at:
        return {}
    at = spread_out(at, CLOSEST * nodes.length)
    below = sorted((name for name, xyz in at.items() if xyz[1] < 0), key=lambda name: -at[name][1])
    reach = max((float(xyz[1]) for xyz in at.values()), default=1.0)
    at |= {name: np.array([0.0, -OFF_AXIS * reach * k, at[name][2]]) for k, name in enumerate(below, 1)}
    names = list(at)
    pairs = sorted({pair for r in runs for pair in r.watts if pair[0] in at and pair[1] in at})
    largest = {pair: max(float(np.abs(r.watts[pair]).max()) for r in runs if pair in r.watts) for pair in pairs}
    most = max(largest.values(), default=1.0)
    active = [pair for pair in pairs if largest[pair] >= SMALL * most]
    widest = max((runs[0].conductance.get(pair, 0.0) for pair in active), default=1.0) or 1.0
    return {
        "nodes": [{"name": name, "z": round(float(z), 4), "y": round(float(y), 4)} for name, (_, y, z) in at.items()],
        "links": [[names.index(a), names.index(b), round(runs[0].conductance.get((a, b), 0.0), 2)] for a, b in active],
        "widest": widest,
        "most": most,
        "tests": [
            {
                "T": packed_numbers(np.transpose([r.T[name] for name in names]), STEP_K),
                "W": packed_numbers(_side_by_side([r.watts[pair] for pair in active], len(r.T[names[0]])), STEP_W),
            }
            for r in runs
        ],
    }
