"""The LU of the kernel against NumPy: sizes that fill groups of rows and do not, zeros, columns to be swapped."""

import numpy as np
import pytest
from numba import njit
from numpy.testing import assert_allclose, assert_array_equal

from lumped.numerics.dense import GROUP, factored, least_fill, lu, shifted, solve, solve_many

BEST_CONDITIONED = 1e6  # of the matrices asked about: ten digits are left


@njit
def solved(G, c, d, L, x, X):
    """Whether there is a solution; both kinds of right-hand side in place."""
    shifted(G, c, d, L, 0)
    if not lu(L, 0):
        return False
    solve(L, 0, x)
    solve_many(L, 0, X)
    return True


def matrices(n, dominant):
    """Random, a third of the entries not zero; the diagonal dominates or is zero."""
    rng = np.random.default_rng(n)
    while True:
        G = rng.standard_normal((n, n)) * (rng.random((n, n)) < 0.34)
        d = np.full(n, 2.0 * n) if dominant else -2.0 * np.diag(G)
        if np.linalg.cond(2.0 * G + np.diag(d)) < BEST_CONDITIONED:
            return G, d


@pytest.mark.parametrize("dominant", [True, False], ids=["strong diagonal", "columns are swapped"])
@pytest.mark.parametrize("n", [2, 5, 13, 64])
def test_solutions_are_numpys(n, dominant):
    G, d = matrices(n, dominant)
    order, structure = least_fill(G != 0.0)
    G, L, rng = G[np.ix_(order, order)], factored(1, structure), np.random.default_rng(1)
    d, x, X = d[order], rng.standard_normal(n), np.zeros((n + -n % GROUP, 2 * GROUP))
    X[:n] = rng.standard_normal((n, 2 * GROUP))
    W = 2.0 * G + np.diag(d)
    exact, several = np.linalg.solve(W, x), np.linalg.solve(W, X[:n])
    assert solved(G, 2.0, d, L, x, X)
    assert_allclose(x, exact, atol=1e-9 * np.abs(exact).max())
    assert_allclose(X[:n], several, atol=1e-9 * np.abs(several).max())
    assert np.all(L.pivot[0, :n] == np.arange(n)) == dominant


def test_a_singular_matrix_is_told():
    G = np.array([[1.0, 2.0, 0.0], [2.0, 4.0, 0.0], [0.0, 0.0, 1.0]])
    L = factored(1, least_fill(G != 0.0)[1])
    assert not solved(G, 1.0, np.zeros(3), L, np.ones(3), np.ones((GROUP, GROUP)))


def test_an_arrow_does_not_fill_in():
    """Every unknown touches the first alone: that one is among the last two, and nothing fills in."""
    n = 12
    G = np.eye(n)
    G[0], G[:, 0] = 1.0, 1.0
    order, structure = least_fill(G != 0.0)
    assert_array_equal(np.sort(order), np.arange(n))
    assert 0 in order[-2:]
    G, L = G[np.ix_(order, order)], factored(1, structure)
    assert solved(G, 1.0, np.full(n, float(n)), L, np.ones(n), np.ones((n, GROUP)))
    assert np.count_nonzero(L.A[0]) == np.count_nonzero(G)
    assert structure.begin[0, -1] < structure.begin[1, -1] - structure.begin[0, -1]
