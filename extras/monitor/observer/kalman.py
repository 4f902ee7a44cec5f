"""Square-root Kalman filter on the reduced model: no covariance ever loses its sign to rounding.

Time update by QR, measurement update one reading at a time by Potter's method.
Sources: Kaminski, Bryson and Schmidt 1971; Bierman 1977, chapters II and V; Simon 2006, chapter 6.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from extras.monitor.observer.process import Driven, Process
from extras.monitor.observer.process_noise import ProcessNoise
from thermoscope import plugin as th


@dataclass
class Filter:
    """x (n,) degC, q (m,) W;  S (N, N) with S S' the covariance of slow states and heats

    error (N, h) : how far each of some hypotheses, were it true, would have led the estimate astray, per unit of it
    heats (m, h) : the constant heat that a unit of each brings;  along (n, n_slow) : fast states that follow slow ones
    """

    process: Process
    noise: ProcessNoise
    x: th.Array
    q: th.Array
    S: th.Array
    error: th.Array
    heats: th.Array
    along: th.Array

    def predict(self, by: Driven, k: int) -> None:
        """To sample k of the record from the one before."""
        self.x, path = self.process.steps(by, k, self.x, self.q)
        n, root = self.process.slow.size, self.noise.root
        wide = len(self.S)
        for step in path:
            keeps = float(np.exp(-step.h / self.noise.time_s))
            both = np.hstack([self.S, self.error])
            pushed = np.hstack([self.S[n:], self.error[n:] + self.heats])
            both[:n] = self.process.propagated(by.core, step, both[:n], pushed)
            both[n:] *= keeps
            self.error = both[:, wide:]
            new = np.vstack([np.zeros((n, wide - n)), np.sqrt(1.0 - keeps**2) * root])
            self.S = np.asarray(np.linalg.qr(np.hstack([both[:, :wide], new]).T, mode="r")).T
            self.q = keeps * self.q
        if path and self.process.fast.size:
            self.along = self.process.balance(path[-1].G)

    def gain(self, h: th.Array, variance: float) -> tuple[th.Array, float]:
        """Gain (N,) for a reading that sees h (N,), and the variance of its innovation; the covariance is updated."""
        phi = self.S.T @ h
        total = float(phi @ phi) + variance
        through = self.S @ phi
        self.S = self.S - np.outer(through, phi) / (total + np.sqrt(variance * total))
        return through / total, total

    def correct(self, change: th.Array) -> None:
        """Move the estimate by (N,) K and W."""
        n = self.process.slow.size
        self.x = self.x + self.along @ change[:n]
        self.q = self.q + change[n:]

    def restart(self, sd: float) -> None:
        """As at the start, with temperatures as they are, each uncertain by sd (K)."""
        n = self.process.slow.size
        self.q, self.S, self.error = np.zeros(self.q.size), np.zeros_like(self.S), np.zeros_like(self.error)
        self.S[:n, :n], self.S[n:, n:] = sd * np.eye(n), self.noise.root


def begun(
    process: Process, noise: ProcessNoise, x: th.Array, sd: Mapping[int, float], usual_sd: float, heats: th.Array
) -> Filter:
    """A filter at its start.  sd : column of a state -> its deviation (K), else the usual one;  heats (m, h)"""
    n, m = process.slow.size, len(process.bodies)
    S = np.zeros((n + m, n + m))
    S[:n, :n] = np.diag([sd.get(int(column), usual_sd) for column in process.slow])
    S[n:, n:] = noise.root
    return Filter(process, noise, x, np.zeros(m), S, np.zeros((n + m, heats.shape[1])), heats, process.slow_only)
