"""The simulated null: what the score looks like when nothing of the catalogue is missing.

Data sets are drawn from a disturbed machine (see disturb.py), recalibrated with the Jacobian held, and scored as the
measurements are. From them come the threshold for the best of all effects and the factor kappa by which each
effect's formal uncertainty is too small.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geom.kept import written_whole
from lumped.network import Network
from validation.calibrate import Fit, bounded_step, normal, silent
from validation.case import Test
from validation.disturb import USUAL, Spread, disturbed, disturbed_test, reading_errors
from validation.noise import first_noise, fit_noise
from validation.predict import predict
from validation.score import gram, score, total
from validation.sheet import Segment, segments
from validation.side_by_side import side_by_side
from validation.where import Scan, scan

Array = NDArray[np.float64]
Drawn = tuple[Array, Array, Array, float]
EULER = 0.5772156649
FORM = 2  # of what a null keeps: older files are not read


@dataclass(frozen=True)
class Null:
    """Of m draws: z (m, K) scores, pulls (m, p) calibrated shifts over prior sd, rms (m, n_channel) residuals (K),
    heat (m,) evidence (nats) of a heat input at the place that wants it most."""

    z: Array
    pulls: Array
    rms: Array
    heat: Array

    @property
    def kappa(self) -> Array:
        """How much each effect's formal standard deviation is too small (K,), at least 1, shrunk to the typical."""
        return _kappa(np.sum(self.z**2, axis=0), self.z.shape[0])

    def threshold(self, alpha: float = 0.05) -> float:
        """Level that the best scaled score passes with probability alpha when nothing is missing.

        Each draw is scaled by the others, as the measurements are: scaled by itself too, few draws never look unusual.
        """
        m, square = self.z.shape[0], np.sum(self.z**2, axis=0)
        best = np.array([np.max(row / _kappa(square - row**2, m - 1)) for row in self.z])
        return _passed(best, alpha)

    @property
    def pull_scale(self) -> Array:
        return np.maximum(1.0, np.sqrt(np.mean(self.pulls**2, axis=0)))

    @property
    def floor(self) -> Array:
        """Residual (K) per channel that the calibrated model reaches in 95 % of the draws."""
        return np.asarray(np.quantile(self.rms, 0.95, axis=0))

    @property
    def heat_nats(self) -> float:
        """Evidence of missing heat that machines pass one time in twenty that lack none."""
        return _passed(self.heat, 0.05)


def _passed(most: Array, alpha: float) -> float:
    """Level that the largest of many passes with probability alpha, from a few such: Gumbel by moments."""
    scale = np.std(most, ddof=1) * np.sqrt(6.0) / np.pi
    return float(np.mean(most) - EULER * scale - scale * np.log(-np.log1p(-alpha)))


def _kappa(square: Array, m: int) -> Array:
    """From sums of squares (K,) over m draws."""
    mean = square / m
    return np.asarray(np.sqrt(np.maximum((square + 10.0 * np.median(mean)) / (m + 10.0), 1.0)))


@dataclass(frozen=True)
class Setting:
    """What a draw needs: the fit, its segments with nuisance and effect columns, and the tests."""

    fit: Fit
    network: Network
    tests: tuple[Test, ...]
    parts: tuple[Segment, ...]
    sign: NDArray[np.int64]
    spread: Spread
    seed: int


def simulated_null(
    fit: Fit,
    network: Network,
    tests: Sequence[Test],
    parts: Sequence[Segment],
    sign: NDArray[np.int64],
    draws: int = 60,
    seed: int = 0,
    workers: int = 2,
    cache: Path | None = None,
    progress: Callable[[str], None] = silent,
    spread: Spread = USUAL,
) -> Null:
    """Run `draws` data sets with nothing missing.

    network : the model's own network, without candidate effects;  parts : segments whose J holds nuisances then effects
    """
    setting = Setting(fit, network, tuple(tests), tuple(parts), sign, spread, seed)
    file = cache / f"null-{fingerprint(setting, draws)}.npz" if cache else None
    if file and file.exists():
        with np.load(file) as saved:
            return Null(saved["z"], saved["pulls"], saved["rms"], saved["heat"])
    rows = side_by_side(draw, (setting, scan(fit, tests)), draws, workers, progress, "simulated null")
    z, pulls, rms, heat = (np.array(column) for column in zip(*rows, strict=True))
    if file:
        with written_whole(file) as partial:
            np.savez(partial, z=z, pulls=pulls, rms=rms, heat=heat)
    return Null(z, pulls, rms, heat)


def fingerprint(setting: Setting, draws: int) -> str:
    """Hash of what the null depends on."""
    h = hashlib.sha256(repr((FORM, draws, setting.seed, setting.spread, setting.fit.unknowns.names)).encode())
    h.update(np.round(setting.fit.theta, 3).tobytes())
    for s in setting.parts:
        h.update(f"{s.test}/{s.channel}".encode() + np.float32(s.J[:: max(1, len(s.J) // 8)]).tobytes())
    return h.hexdigest()[:20]


def draw(of: tuple[Setting, Scan], i: int) -> Drawn:
    """One data set: simulate, calibrate with the Jacobian held, score, and look where heat would be missing.

    The truth stays at the calibrated state and the prior is drawn around it: the same tension between prior and data as
    with a drawn truth, and the Jacobian stays valid.
    """
    setting, heat = of
    fit, p = setting.fit, len(setting.fit.unknowns.parameters)
    rng = np.random.default_rng([setting.seed, i])
    tests = data(setting, rng)
    weight, (low, high) = fit.unknowns.sd**-2.0, fit.unknowns.bounds
    low, high = low - fit.theta, high - fit.theta
    centre = np.clip(fit.unknowns.sd * rng.standard_normal(p), low, high)
    delta, parts = np.zeros(p), _residuals(setting, tests, np.zeros(p))
    noise = first_noise(parts)
    for round_ in range(3):
        A, b, _ = normal([replace(s, J=s.J[:, :p]) for s in parts], noise)
        new = bounded_step(A + np.diag(weight), b - weight * (delta - centre), delta, low, high)
        if round_ < 2:
            parts = _residuals(setting, tests, new)
        else:
            parts = [replace(s, r=s.r - s.J[:, :p] @ (new - delta)) for s in parts]
        delta, noise = new, fit_noise(parts)
    S = score(total(gram(parts, noise, p)), delta - centre, fit.unknowns.sd, setting.sign)
    rms = [np.sqrt(np.mean(np.concatenate([s.r for s in parts if s.channel == c]) ** 2)) for c in noise.levels]
    most = heat.read(parts, noise, delta - centre)[0].evidence_nats
    return S.z, (delta - centre) / fit.unknowns.sd, np.array(rms), most


def data(setting: Setting, rng: np.random.Generator) -> list[Test]:
    """The tests with readings of a disturbed machine near the calibrated state."""
    fit, spread = setting.fit, setting.spread
    values = fit.values
    real = disturbed(setting.network, rng, spread)
    out = []
    for test in setting.tests:
        seen = disturbed_test(test, setting.network, real, rng, spread)
        level = {s.channel: fit.noise.at(s).white for s in setting.parts if s.test == test.name}
        white = [min(level.get(c.name, c.sigma_K), c.sigma_K) for c in test.channels]
        y = reading_errors(test, predict(real, seen, values).y, rng, spread, white)
        out.append(replace(test, channels=tuple(replace(c, y=y[:, j]) for j, c in enumerate(test.channels))))
    return out


def _residuals(setting: Setting, tests: Sequence[Test], delta: Array) -> list[Segment]:
    """Residuals of the model at theta + delta with the columns of the fit."""
    values = setting.fit.unknowns.values(setting.fit.theta + delta)
    fresh = segments(setting.network, tests, values)
    return [replace(new, J=old.J) for new, old in zip(fresh, setting.parts, strict=True)]
