"""A running machine of three nodes, by an integrator of its own: heat that the model lacks, and sensors that fail."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from lumped.integration.record import Record

SECONDS, NOISE_K = 6000.0, 0.1


@dataclass(frozen=True)
class Truth:
    """time (n,) s;  current (n,) A;  T (n, 3) degC of winding, yoke and flange;  y (n, 3) as read"""

    time: np.ndarray
    current: np.ndarray
    T: np.ndarray
    y: np.ndarray

    @property
    def record(self) -> Record:
        return Record(self.time, {"current_A": self.current}, {"ambient": np.full(self.time.size, 20.0)})


def run(heat: Callable[[float], float] = lambda t: 0.0, seed: int = 1, step: float = 1.0) -> Truth:
    """heat : W into the flange that nobody wrote down, over time (s)"""
    rng, time = np.random.default_rng(seed), np.arange(0.0, SECONDS, step)
    current = 100.0 * rng.uniform(0.5, 1.2, 21)[(time / 300).astype(int)]

    def slope(t: float, T: np.ndarray) -> list[float]:
        w, y, f = T
        P = 0.02 * np.interp(t, time, current) ** 2 * (1 + 0.00393 * (w - 20))
        return [
            (P - 8 * (w - y)) / 2000,
            (8 * (w - y) - 6 * (y - f) - 3 * (y - 20)) / 6000,
            (6 * (y - f) - 1.5 * (f - 20) + heat(t)) / 3000,
        ]

    T = solve_ivp(slope, (0, time[-1]), [20.0] * 3, t_eval=time, max_step=10, rtol=1e-7).y.T
    return Truth(time, current, T, T + NOISE_K * rng.standard_normal(T.shape))
