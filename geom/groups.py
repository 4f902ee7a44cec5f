"""What hangs together."""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from geom.arrays import Array, Ints


def joined_groups(count: int, pairs: Ints) -> Ints:
    """For each of many things the number of its group: those of a pair (n, 2) are in one."""
    graph = coo_matrix((np.ones(len(pairs)), tuple(np.reshape(pairs, (-1, 2)).T)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], np.int64)


def near_groups(points: Array, distance: float) -> Ints:
    """For each point the number of its group: of those nearer to each other than this, one by one."""
    return joined_groups(len(points), KDTree(points).query_pairs(distance, output_type="ndarray"))
