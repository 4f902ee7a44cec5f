"""Where a comparison fails: whiteness, inputs the error follows, and the heat that would mend it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import gammaincc, kolmogorov

from geom.arrays import Array
from geom.constants import NORMAL_95
from geom.one_thread import one_blas_thread
from geom.table import TableRow
from measured.case import Case, Test
from measured.sensors.blocks import groups
from validation.calibration.calibrate import no_progress
from validation.comparison.compare import physical
from validation.comparison.linearisation import Segment, segments
from validation.inference.contradiction import Contradiction, contradiction
from validation.inference.evidence import calibrated_case, quiet_fit
from validation.inference.low_fidelity import low_fidelity_case
from validation.inference.missing_heat import MissingHeat, missing_heat
from validation.inference.stretches import pulses
from validation.parameters.unknowns import standing

LAGS = 20  # usual for the test of Ljung and Box; more lose power


@dataclass(frozen=True)
class Pattern(TableRow):
    """What is left in one sensor's residual.

    ljung_box_p, periodogram_p : probability of as much structure in white noise
    follows : input -> largest cross-correlation over the level that chance reaches in 5 % of cases; above 1 it follows
    """

    test: str
    channel: str
    ljung_box_p: float
    periodogram_p: float
    follows: Mapping[str, float]


def pattern(segment: Segment, test: Test) -> Pattern:
    """Whiteness of a segment's residual, and its dependence on the inputs of its test."""
    inputs = {name: averaged(segment, test, u) for name, u in {**test.inputs, **test.boundaries}.items()}
    follows = {name: dependence(segment.r, u) for name, u in inputs.items() if np.ptp(u) > 1e-9}
    return Pattern(segment.test, segment.channel, ljung_box(segment.r), periodogram(segment.r), follows)


def averaged(segment: Segment, test: Test, u: Array) -> Array:
    """An input over the same instants as the residual."""
    start = groups(len(test.time))
    size = np.diff(np.append(start, len(test.time)))
    full = np.broadcast_to(np.asarray(u, float), test.time.shape)
    time = np.add.reduceat(test.time, start) / size
    return np.asarray(np.interp(segment.time, time, np.add.reduceat(full, start) / size), float)


def autocorrelation(x: Array, lags: int) -> Array:
    """(lags + 1,) of a centred series, 1 at lag 0."""
    x = x - np.mean(x)
    square = float(x @ x)
    return np.array([float(x[k:] @ x[: x.size - k]) for k in range(lags + 1)]) / max(square, 1e-300)


def ljung_box(r: Array) -> float:
    """Probability of autocorrelations as large in white noise: n (n + 2) sum rho_k^2 / (n - k) against chi squared.

    Source: Ljung and Box 1978, Biometrika 65, 297.
    """
    n, lags = r.size, np.arange(1, min(LAGS, r.size // 4) + 1)
    rho = autocorrelation(r, lags.size)[1:]
    Q = n * (n + 2) * float(np.sum(rho**2 / (n - lags)))
    return float(gammaincc(lags.size / 2, Q / 2))


def periodogram(r: Array) -> float:
    """Probability that the cumulated periodogram of white noise strays as far from the diagonal."""
    power = np.abs(np.fft.rfft(r - np.mean(r)))[1:] ** 2
    share = np.cumsum(power) / max(float(np.sum(power)), 1e-300)
    line = np.arange(1, power.size + 1) / power.size
    return float(kolmogorov(np.sqrt(power.size) * np.max(np.abs(share - line))))


def dependence(r: Array, u: Array) -> float:
    """Largest |R_eu(k)| over lags 0 to 20, over 1.96 sqrt(P / n), P = sum of R_e R_u over all lags."""
    e, v, n = r - np.mean(r), u - np.mean(u), r.size
    lags = min(LAGS, n // 4)
    scale = np.sqrt(float(e @ e) * float(v @ v))
    cross = [abs(float(e[k:] @ v[: n - k])) / max(scale, 1e-300) for k in range(lags + 1)]
    together = autocorrelation(e, lags) * autocorrelation(v, lags)
    spread = max(float(together[0] + 2.0 * np.sum(together[1:])), 1.0)
    return max(cross) / (NORMAL_95 * np.sqrt(spread / n))


def patterns(parts: Sequence[Segment], tests: Sequence[Test]) -> list[Pattern]:
    """One per sensor and test."""
    by_name = {t.name: t for t in tests}
    return [pattern(s, by_name[s.test]) for s in parts]


@dataclass(frozen=True)
class Discrepancy:
    """All rows of all tests, held-out ones too; heat : what would have to enter where, most evident first.

    contradiction : what would have to differ between the tests that are fitted
    """

    patterns: tuple[Pattern, ...]
    heat: tuple[MissingHeat, ...]
    contradiction: Contradiction

    def document(self) -> dict:
        return {
            "patterns": [p.document() for p in self.patterns],
            "where": [{**h.document(), "pulses": pulse_rows(h)} for h in self.heat],
            "contradiction": self.contradiction.document(),
        }


@one_blas_thread
def discrepancies(case: Case, progress: Callable[[str], None] = no_progress) -> Discrepancy:
    """The model as it stands; the scan for heat is made after calibration, or it would find what calibration mends."""
    network = standing(case)
    now = physical(case)
    left = patterns(segments(network, case.tests, now), case.tests)
    case = low_fidelity_case(case, progress)
    tests = case.usable
    fit = quiet_fit(calibrated_case(case, progress), tests)
    progress("looking for where heat is missing")
    return Discrepancy(tuple(left), tuple(missing_heat(fit, tests)), contradiction(fit, tests))


def pulse_rows(heat: MissingHeat) -> list[dict]:
    """Every stretch in which a missing-heat curve stands on another level: test, begin and end (s), W."""
    by_test = {test: pulses(*curve) for test, curve in heat.heat_W.items()}
    return [
        {"test": test, "begin_s": a, "end_s": b, "heat_W": level}
        for test, levels in by_test.items()
        for (a, b), level in levels
    ]
