"""Surfaces of a mesh, cut open exactly: every point drawn is a fixed linear mix of mesh nodes.

So the geometry is cut once, and each new temperature field costs one sparse product.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix, identity, vstack

from geom.arrays import Array, Ints, Mask
from geom.errors import InputError
from viz.rendering.nodes import SplitMesh, repeated


@dataclass(frozen=True)
class Wedge:
    """The sector around the axis (z) that is taken away: from `start` over `span` degrees, counted from x towards y."""

    start: float
    span: float

    def __post_init__(self) -> None:
        if not 0 < self.span <= 180:
            raise InputError(f"wedge span {self.span} degrees", "cut-away", "more than 0, at most 180")

    def edges(self) -> tuple[Array, Array]:
        """Unit vectors along both edges of the wedge."""
        angles = np.deg2rad([self.start, self.start + self.span])
        first, last = np.stack([np.cos(angles), np.sin(angles), np.zeros(2)], axis=1)
        return first, last


NEAR = 1.3  # of the machine's size: further away a base may leave the picture
QUARTER = Wedge(90.0, 90.0)  # the upper quadrant that faces the default camera
HALF = Wedge(90.0, 180.0)


@dataclass(frozen=True)
class Surface:
    """Triangles whose points are linear mixes of mesh nodes.

    weights : (n_points, n_nodes) rows summing to 1;  triangles : (n, 3);  part : (n,) index into nodes.parts
    """

    nodes: SplitMesh
    weights: csr_matrix
    triangles: Ints
    part: Ints

    @cached_property
    def points(self) -> Array:
        return self.weights @ self.nodes.points

    @cached_property
    def framed(self) -> Array:
        """(n, 3) m that a picture of the machine must hold."""
        base = np.array([part in self.nodes.bases for part in self.nodes.parts], bool)[self.owner]
        return framed(self.points[~base], self.points[base])

    @cached_property
    def owner(self) -> Ints:
        """(n_points,) index of the part each point belongs to."""
        out = np.zeros(self.weights.shape[0], np.int64)
        out[self.triangles] = self.part[:, None]
        return out

    def values(self, T: Array) -> Array:
        """(n_points,) or (n_points, n) values from (n_nodes,) or (n_nodes, n) nodal ones."""
        return self.weights @ T

    def only(self, mask: Mask) -> "Surface":
        """Some of the triangles, (n,)."""
        return Surface(self.nodes, self.weights, self.triangles[mask], self.part[mask])

    def clipped(self, direction: Array, offset: float = 0.0) -> "Surface":
        """The side of a plane on which `direction @ point >= offset` (m); through the axis without an offset."""
        d = _snapped(self.points @ direction - offset)
        above = (d >= 0)[self.triangles]
        count = above.sum(axis=1)
        one, two = count == 1, count == 2
        apex_one, apex_two = _turned(self.triangles[one], above[one]), _turned(self.triangles[two], ~above[two])
        combined = _Combinations(d, len(d))
        a, b, c = apex_one.T
        single = np.stack([a, combined.edge(a, b), combined.edge(a, c)], axis=1)
        a, b, c = apex_two.T
        ab, ac = combined.edge(a, b), combined.edge(a, c)
        triangles = np.concatenate(
            [self.triangles[count == 3], single, np.stack([ab, b, c], axis=1), np.stack([ab, c, ac], axis=1)]
        )
        part = np.concatenate([self.part[count == 3], self.part[one], self.part[two], self.part[two]])
        weights = vstack([self.weights, combined.matrix() @ self.weights], format="csr")
        return Surface(self.nodes, weights, triangles, part).compact()

    def compact(self) -> "Surface":
        """Without unused points and empty triangles; points of one part that coincide are joined."""
        nodes, flat = np.unique(self.triangles, return_inverse=True)
        owner = np.zeros(len(nodes), np.int64)
        owner[flat.reshape(-1)] = np.repeat(self.part, 3)
        weights = self.weights[nodes]
        where = np.column_stack([np.round(weights @ self.nodes.points * 1e9).astype(np.int64), owner])
        _, first, merger = np.unique(where, axis=0, return_index=True, return_inverse=True)
        triangles = merger.reshape(-1)[flat.reshape(-1, 3)]
        solid = (np.diff(np.sort(triangles, axis=1), axis=1) > 0).all(axis=1)
        return Surface(self.nodes, weights[first], triangles[solid], self.part[solid])


def framed(machine: Array, bases: Array) -> Array:
    """Points (n, 3) m that a picture must hold: of the machine all, of a very long base only what is near it."""
    low, high = machine.min(axis=0), machine.max(axis=0)
    more = NEAR * (high - low)
    return np.concatenate([machine, np.clip(bases, low - more, high + more)])


def exposed(nodes: SplitMesh, contacts: bool = False) -> Surface:
    """The surface that touches a fluid; faces between two parts only if `contacts` are wanted."""
    triangles, part = nodes.boundary()
    if contacts:
        return Surface(nodes, identity(nodes.size, format="csr"), triangles, part).compact()
    contact = repeated(nodes.original[triangles])
    return Surface(nodes, identity(nodes.size, format="csr"), triangles[~contact], part[~contact]).compact()


def section(nodes: SplitMesh, normal: Array, offset: float = 0.0) -> Surface:
    """The solid parts in the plane `normal @ point == offset` (m), which runs through the axis without an offset."""
    d = _snapped(nodes.points @ normal - offset)
    above = (d >= 0)[nodes.tets]
    count = above.sum(axis=1)
    combined = _Combinations(d, 0)
    triangles, part = [], []
    for sign, crossing in ((above, count == 1), (~above, count == 3)):
        a, b, c, e = _first(nodes.tets[crossing], sign[crossing], 1).T
        triangles.append(np.stack([combined.edge(a, b), combined.edge(a, c), combined.edge(a, e)], axis=1))
        part.append(nodes.region[crossing])
    two = count == 2
    a, b, c, e = _first(nodes.tets[two], above[two], 2).T
    ac, ae, be, bc = combined.edge(a, c), combined.edge(a, e), combined.edge(b, e), combined.edge(b, c)
    triangles += [np.stack([ac, ae, be], axis=1), np.stack([ac, be, bc], axis=1)]
    part += [nodes.region[two]] * 2
    flat = Surface(nodes, combined.matrix(), np.concatenate(triangles), np.concatenate(part)).compact()
    a, b, c = flat.points[flat.triangles].transpose(1, 0, 2)
    away = np.cross(b - a, c - a) @ normal < 0  # all are turned towards the normal
    return replace(flat, triangles=np.where(away[:, None], flat.triangles[:, ::-1], flat.triangles))


def cut_away(nodes: SplitMesh, wedge: Wedge | None = QUARTER) -> Surface:
    """The machine without a wedge: outer surface and both sections; all of the outside without a wedge."""
    outside = exposed(nodes)
    if wedge is None:
        return outside
    first, last = wedge.edges()
    above_first, below_last = np.cross([0, 0, 1.0], first), np.cross(last, [0, 0, 1.0])
    pieces = [outside.clipped(-above_first), outside.clipped(above_first).clipped(-below_last)]
    pieces += [section(nodes, above_first).clipped(first), section(nodes, below_last).clipped(last)]
    return joined(pieces)


def joined(pieces: list[Surface]) -> Surface:
    """Several surfaces of one mesh as one."""
    starts = np.cumsum([0, *(p.weights.shape[0] for p in pieces)])
    triangles = np.concatenate([p.triangles + s for p, s in zip(pieces, starts, strict=False)])
    weights = vstack([p.weights for p in pieces], format="csr")
    return Surface(pieces[0].nodes, weights, triangles, np.concatenate([p.part for p in pieces])).compact()


def _snapped(distance: Array) -> Array:
    """Distances with those below a nanometre set to 0: a mesh line that lies in the plane must not leave slivers."""
    return np.where(np.abs(distance) < 1e-9, 0.0, distance)


class _Combinations:
    """Collects the points at which edges cross the plane; numbers start at `offset`."""

    def __init__(self, distance: Array, offset: int) -> None:
        self.distance, self.offset = distance, offset
        self.pairs: list[Ints] = []

    def edge(self, i: Ints, j: Ints) -> Ints:
        start = self.offset + sum(map(len, self.pairs))
        self.pairs.append(np.stack([i, j], axis=1))
        return np.arange(start, start + len(i))

    def matrix(self) -> csr_matrix:
        i, j = np.concatenate(self.pairs).T
        share = self.distance[i] / (self.distance[i] - self.distance[j])
        rows, n = np.arange(len(i)), len(i)
        return csr_matrix(
            (np.concatenate([1 - share, share]), (np.concatenate([rows, rows]), np.concatenate([i, j]))),
            shape=(n, len(self.distance)),
        )


def _first(cells: Ints, flag: Mask, count: int) -> Ints:
    """Corners of each cell with the `count` flagged ones first."""
    order = np.argsort(~flag, axis=1, kind="stable")
    assert flag.sum(axis=1).max(initial=count) == count
    return np.take_along_axis(cells, order, axis=1)


def _turned(triangles: Ints, flag: Mask) -> Ints:
    """Triangles turned (orientation kept) so that their single flagged corner comes first."""
    turn = (np.argmax(flag, axis=1)[:, None] + np.arange(3)) % 3
    return np.take_along_axis(triangles, turn, axis=1)
