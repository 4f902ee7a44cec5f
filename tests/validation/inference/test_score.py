"""The projected score against closed forms of linear regression."""

import numpy as np
import pytest

from validation.calibration.calibrate import bounded_step
from validation.inference.score import Gram, score


@pytest.fixture
def data():
    rng = np.random.default_rng(1)
    J, Z, r = rng.standard_normal((80, 4)), rng.standard_normal((80, 3)), rng.standard_normal(80)
    return J, Z, r


def block(J, Z, r):
    return Gram(J.T @ J, J.T @ Z, Z.T @ Z, J.T @ r, Z.T @ r, float(r @ r))


def test_equals_the_marginal_likelihood_score(data):
    """V = Z'(I + J Lambda^-1 J')^-1 Z, the Woodbury identity."""
    J, Z, r = data
    sd = np.array([0.5, 1.0, 2.0, 0.1])
    S = score(block(J, Z, r), np.zeros(4), sd, np.ones(3, int))
    W = np.linalg.inv(np.eye(80) + J @ np.diag(sd**2) @ J.T)
    np.testing.assert_allclose(S.V, Z.T @ W @ Z)
    np.testing.assert_allclose(S.u, Z.T @ W @ r)


def test_does_not_depend_on_where_the_calibration_stopped(data):
    """The correction term: any theta of a linear model gives the same score."""
    J, Z, r = data
    sd = np.ones(4)
    stopped = np.array([0.3, -1.0, 0.5, 0.2])
    at_start = score(block(J, Z, r), np.zeros(4), sd, np.ones(3, int))
    elsewhere = score(block(J, Z, r - J @ stopped), stopped, sd, np.ones(3, int))
    np.testing.assert_allclose(elsewhere.u, at_start.u)


def test_amplitude_is_that_of_the_full_fit(data):
    """u / V is the joint least-squares estimate with one effect added."""
    J, Z, r = data
    S = score(block(J, Z, r), np.zeros(4), np.full(4, 1e6), np.ones(3, int))
    full = np.linalg.lstsq(np.column_stack([J, Z[:, 0]]), r, rcond=None)[0]
    assert S.amplitude[0] == pytest.approx(full[-1])


def test_effect_in_the_span_of_the_calibration_is_invisible(data):
    J, _, r = data
    S = score(block(J, J[:, :1] * 3.0, r), np.zeros(4), np.full(4, 1e9), np.ones(1, int))
    assert not S.visible[0]
    assert S.absorbed[0] == pytest.approx(1.0)


def test_wrong_sign_is_no_explanation(data):
    J, Z, _ = data
    S = score(block(J, Z, -5.0 * Z[:, 0]), np.zeros(4), np.ones(4), np.array([1, -1, 0]))
    assert S.z[0] < -10


def test_bounded_step_is_the_constrained_minimum():
    """Two coupled unknowns, one stopped by its bound: the other moves to its own conditional optimum."""
    H, g = np.array([[2.0, 1.0], [1.0, 2.0]]), np.array([5.0, 1.0])
    new = bounded_step(H, g, np.zeros(2), np.full(2, -9.0), np.array([1.0, 9.0]))
    np.testing.assert_allclose(new, [1.0, 0.0])
