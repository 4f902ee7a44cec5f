"""Fields over the machine as the page holds them: every part has few shapes of its own, every field their weights.

Parts need fewer shapes than the machine, for each part's field is smooth: fewer bytes, and less to mix per instant.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from geom.arrays import Array
from viz.rendering.nodes import SplitMesh
from viz.viewer.packing import packed_numbers

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
