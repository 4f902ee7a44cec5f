"""What separates the halves of a mesh: complete, and as thin as a matching proves it can be."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.csgraph import maximum_bipartite_matching
from scipy.spatial import Delaunay

from fem.solvers.dissection import _least_cover, _split


@pytest.mark.parametrize("seed", range(5))
def test_the_least_cover_meets_every_edge_with_as_many_ends_as_a_matching_has_edges(seed):
    rng = np.random.default_rng(seed)
    edges = sp.random_array((40, 30), density=0.06, rng=rng).tocoo()
    low, high = _least_cover(*edges.coords)
    assert np.all(np.isin(edges.coords[0], low) | np.isin(edges.coords[1], high))
    assert len(low) + len(high) == np.sum(maximum_bipartite_matching(edges.tocsr(), perm_type="column") >= 0)


def test_no_edge_joins_the_halves_of_a_cloud_of_points():
    points = np.random.default_rng(1).random((400, 2))
    first, second = Delaunay(points).simplices[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2).T
    graph = sp.csr_array((np.ones(len(first)), (first, second)), shape=(400, 400))
    graph = sp.csr_array(graph + graph.T)
    left, right, middle = _split(graph, points)
    assert sorted([*left, *right, *middle]) == list(range(400))
    assert min(len(left), len(right)) > 100
    assert len(middle) < 40
    assert graph[left][:, right].nnz == 0
