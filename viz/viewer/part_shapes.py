"""Fields and network as the page holds them: every part has few shapes of its own, every field their weights.

Parts need fewer shapes than the machine, for each field is smooth there: fewer bytes, and less to mix per instant.
Arrays are short text: whole numbers, differences of neighbours without a sign, deflate, base64. Nodes of the network
are drawn in the half section, heat along the lines between.
"""

import base64
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from geom.arrays import Array, Ints
from geom.meshing.mesh import NamedMesh
from viz.machine.network import CLOSEST, SMALL, places, spread_out
from viz.rendering.nodes import SplitMesh

UNKNOWN = -1  # whole numbers of a column begin at zero: this one stands for what is not finite
LEVEL = 8  # of deflate: 9 makes a page half a percent shorter and takes two and a half times as long


def packed_integers(values: Ints) -> dict[str, Any]:
    """Rows of whole numbers (n, k), each as the difference from the row before it: meshes are regular.

    A difference n is 2 n, and -n is 2 n - 1: the upper bytes of small ones are then zero, whatever their sign.
    """
    steps = np.diff(values, axis=0, prepend=np.zeros((1, values.shape[1]), np.int64))
    unsigned = np.where(steps < 0, -2 * steps - 1, 2 * steps).astype("<u4")
    planes = np.ascontiguousarray(unsigned.T).view(np.uint8).reshape(-1, 4).T  # equal bytes side by side deflate well
    data = zlib.compress(np.ascontiguousarray(planes).tobytes(), LEVEL)
    return {"columns": values.shape[1], "data": base64.b64encode(data).decode("ascii")}


def packed_numbers(values: Array, step: Array | float | None = None) -> dict[str, Any]:
    """Rows of numbers (n, k), each column in its own step (k,), or in 65,535 steps over its range; NaN stays NaN."""
    finite = np.isfinite(values)
    low = np.where(finite, values, np.inf).min(axis=0, initial=np.inf)
    low = np.where(np.isfinite(low), low, 0.0)
    above = np.where(finite, values - low, 0.0)
    fine = np.maximum(above.max(axis=0, initial=0.0), 1e-12) / 65535
    steps = np.broadcast_to(fine if step is None else step, low.shape)
    whole = np.where(finite, np.round(above / steps), UNKNOWN).astype(np.int64)
    return {**packed_integers(whole), "low": low.tolist(), "step": steps.tolist()}


BLOCK = 1024  # nodes looked at together: with a thousand fields of each they stay in a processor's cache
ERROR_K = 0.1  # largest error of any node at any instant: a fifth of what a thermocouple tells


@dataclass(frozen=True)
class LowRank:
    """Fields as a few shapes times their amplitudes, so that a browser can mix them at any instant.

    fields = mean + amplitudes @ shapes

    mean : (n_nodes,) degC;  shapes : (r, n_nodes), largest magnitude 1;  amplitudes : (n_fields, r) K
    """

    mean: Array
    shapes: Array
    amplitudes: Array

    def steps(self, step_K: float) -> Array:
        """(r,) how finely each shape must be known, for `step_K` at its largest amplitude."""
        return step_K / np.abs(self.amplitudes).max(axis=0, initial=1e-12)

    def fields(self) -> Array:
        """(n_fields, n_nodes) degC."""
        return self.mean + self.amplitudes @ self.shapes


def low_rank(fields: Array, error_K: float = ERROR_K) -> LowRank:
    """The fewest principal shapes of fields (n_fields, n_nodes) degC that keep every value within `error_K`.

    Method of snapshots (Sirovich 1987): eigenvectors of the small matrix of inner products of the fields.
    """
    mean = fields.mean(axis=0)
    rest = fields - mean
    values, vectors = np.linalg.eigh(rest @ rest.T)
    vectors = vectors[:, np.argsort(values)[::-1]]
    rank, before = 0, -1
    while rank > before:  # one shape more may put a block off that had enough
        before = rank
        for first in range(0, rest.shape[1], BLOCK):
            rank = _rank(rest[:, first : first + BLOCK], vectors, rank, error_K)
    amplitudes = vectors[:, :rank]
    shapes = amplitudes.T @ rest
    largest = np.abs(shapes).max(axis=1, initial=1e-12)
    return LowRank(mean, shapes / largest[:, None], amplitudes * largest)


def _rank(rest: Array, vectors: Array, least: int, error_K: float) -> int:
    """How many of the vectors, `least` or more, keep every value of some nodes (n_fields, n) K within `error_K`."""
    rank, some = least, vectors[:, :least]
    left = rest - some @ (some.T @ rest)
    while rank < vectors.shape[1] and max(left.max(initial=0.0), -left.min(initial=0.0)) > error_K:
        left -= np.outer(vectors[:, rank], vectors[:, rank] @ rest)
        rank += 1
    return rank


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
                "W": packed_numbers(
                    np.reshape([r.watts[p] for p in active], (len(active), r.T[names[0]].size)).T, STEP_W
                ),
            }
            for r in runs
        ],
    }
