"""Along which edges elements are quadratic: where a straight temperature would cost a hot spot.

Two estimates: what each edge costs the hot spots in the first order, from one field that is quadratic everywhere; and
where points near a hot spot moved once the cheapest went without a middle, which no first order sees.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from fem.matrices.assembly import FieldModel
from fem.matrices.bends import Bends
from geom.arrays import Array

Bools = NDArray[np.bool_]

ROUNDS = 3  # of fields in which points near hot spots are held against those of the quadratic one
Kelvins = Mapping[str, float]  # heated part -> K


class OperatingPoint(Protocol):
    """Films, contacts, losses and streams, all of them fixed;  watts : heated part -> W"""

    @property
    def films(self) -> Mapping[str, float]: ...

    @property
    def contacts(self) -> Mapping[str, float]: ...

    @property
    def watts(self) -> Mapping[str, float]: ...

    def of_field(self, field: FieldModel) -> Array:
        """(n,) K, steady."""
        ...

    def influence(self, field: FieldModel, rows: Callable[[Array], Array]) -> tuple[Array, Array]:
        """The same, and (n, k) K/W of a watt anywhere on each of the readings rows(T) (n, k)."""
        ...


@dataclass(frozen=True)
class BendingEdges:
    """bends : where elements are quadratic;  hot, hot_quadratic : hot spots with these edges, and with all of them

    losses : part -> (n_heated,) percent that straight edges in its plane would cost each hot spot
    """

    bends: Bends
    hot: Kelvins
    hot_quadratic: Kelvins
    losses: Mapping[str, Array]


def bending_edges(
    point: OperatingPoint,
    field: FieldModel,
    field_with: Callable[[Bends], FieldModel],
    parts: Sequence[str],
    percent: float,
    floor: float,
) -> BendingEdges:
    """The fewest edges of `parts` without which hot spots would be off by more than so much, at a point.

    field : quadratic in all of these;  field_with : the same with middles on some edges
    floor : of the largest rise: what a part of less is held against
    """

    def readings(T: Array) -> Array:
        unit = np.zeros((field.n, len(point.watts)))
        unit[list(hottest(point, field, T).values()), range(len(point.watts))] = 1.0
        return unit

    T, influence = point.influence(field, readings)
    hot = hot_spots(point, field, T)
    scale = np.maximum(list(hot.values()), floor * max(hot.values()))
    lost = 100.0 * linear_losses(field, field.stiffness(point.films, point.contacts), T, influence) / scale
    each = {part: lost[block.dofs][len(block.points) :] for part, block in field.blocks.items() if part in parts}
    edges = {part: field.blocks[part].bending for part in each}
    losses = {part: np.abs(mine[edges[part][:, 3] > 0.0].sum(axis=0)) for part, mine in each.items()}
    worth = _without_cheapest(each, percent)
    near = dict(zip(hot, 0.01 * percent * scale, strict=True))
    for left in reversed(range(ROUNDS)):
        bends = Bends({part: np.column_stack([edges[part], mine]) for part, mine in worth.items()})
        fewer = field_with(bends)
        T_fewer, more = point.of_field(fewer), False
        for part in near.keys() & worth.keys():
            touched = _edges_near_hot_spot(field, fewer, part, T, T_fewer, near[part])
            more |= bool((touched & ~worth[part]).any())
            worth[part] |= touched
        if not (more and left):
            break
    return BendingEdges(bends, hot_spots(point, fewer, T_fewer), hot, losses)


def hot_spots(point: OperatingPoint, field: FieldModel, T: Array) -> dict[str, float]:
    """Heated part -> its largest rise (K)."""
    return {part: float(T[k]) for part, k in hottest(point, field, T).items()}


def hottest(point: OperatingPoint, field: FieldModel, T: Array) -> dict[str, int]:
    """Heated part -> its hottest unknown."""
    dofs = {part: field.blocks[part].dofs for part in point.watts}
    return {part: mine.start + int(np.argmax(T[mine])) for part, mine in dofs.items()}


def _without_cheapest(each: Mapping[str, Array], percent: float) -> dict[str, Bools]:
    """Part -> whether its edges are worth a middle, from what each costs each hot spot: the cheapest are not, up to a
    sum of so much."""
    costs = np.abs(np.concatenate(list(each.values())))
    cheapest = np.argsort(costs.max(axis=1))
    worth = np.empty(len(costs), bool)
    worth[cheapest] = np.cumsum(costs[cheapest], axis=0).max(axis=1) > percent
    ends = np.cumsum([len(mine) for mine in each.values()])[:-1]
    return dict(zip(each, np.split(worth, ends), strict=True))


def _edges_near_hot_spot(
    field: FieldModel, fewer: FieldModel, part: str, T: Array, T_fewer: Array, near: float
) -> Bools:
    """Whether each edge of a part ends at a point that moved by more than `near` (K), and is as near to the hottest."""
    block, m = field.blocks[part], len(field.blocks[part].points)
    before, after = T[block.dofs], T_fewer[fewer.blocks[part].dofs][:m]
    near_it = (np.abs(after - before[:m]) > near) & (np.maximum(after, before[:m]) > before.max() - near)
    ends = block.elements.middles
    return np.asarray(near_it[ends // m] | near_it[ends % m])


def linear_losses(field: FieldModel, K: sp.csr_array, T: Array, influence: Array) -> Array:
    """(n, k) K that each reading loses by a straight line along the edge an unknown is the middle of; 0 at corners.

    What a straight line leaves out, of the temperature and of a watt's influence on a reading, times the matrix: the
    first order of the difference. Nothing is solved again.

    Source: Becker and Rannacher 2001, "An optimal control approach to a posteriori error estimation", Acta Numerica 10.

    K (n, n) W/K;  T (n,) K;  influence (n, k) K/W of a watt anywhere
    """
    return np.asarray(_bend(field, T[:, None]) * (K @ _bend(field, influence)))


def _bend(field: FieldModel, T: Array) -> Array:
    """(n, k) of T (n, k): at the middle of every edge above the mean of its ends, 0 at corners."""
    out = np.zeros_like(T)
    for block in field.blocks.values():
        corners, edges, mine = len(block.points), block.elements.middles, T[block.dofs]
        out[block.dofs][corners:] = mine[corners:] - (mine[edges // corners] + mine[edges % corners]) / 2
    return out
