"""Measured minus model everywhere, from the few places where it was measured: by the model's own covariance.

A model y of uncertain parameters is wrong by D d with d ~ N(0, 1), alike everywhere along the same column of D.
Readings with noise then tell the error at any other place: simple kriging (Matheron 1963), or Gaussian-process
regression with the covariance D D' (Rasmussen and Williams 2006, eq. 2.22 to 2.24).
"""

from dataclasses import dataclass

import numpy as np

from geom.arrays import Array


@dataclass(frozen=True)
class Interpolated:
    """mean : (n,) K;  explained : (n,) share of the variance there that the readings explain, 0 (a guess) to 1"""

    mean: Array
    explained: Array


def interpolated(there: Array, here: Array, residual_K: Array, sigma_K: Array) -> Interpolated:
    """The error of a model at n places from its residuals at m sensors.

    there : (n, d) K, change at the places by one deviation of each doubt;  here : (m, d) K, the same at the sensors
    residual_K : (m,) measured - modelled;  sigma_K : (m,) one-sigma noise of the readings
    """
    covariance = here @ here.T + np.diag(sigma_K**2)
    across = there @ here.T
    gain = np.linalg.solve(covariance, across.T).T
    prior = (there**2).sum(axis=1)
    explained = (gain * across).sum(axis=1) / np.maximum(prior, 1e-12)
    return Interpolated(gain @ residual_K, np.clip(explained, 0.0, 1.0))
