"""A measured warming curve as a formula, when it has settled, and whether equal tests repeat.

eq. 8   T = a exp(b exp(c t)), t in minutes       a: end temperature (degC); b < 0: start; c < 0 (1/min): speed
eq. 9   T(t1) - T(t2) = 0 for two late readings, within the sensor's resolution

Equal tests, and equal machines, are pooled; they repeat where they differ by no more than the measurement is unsure.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermoscope import InputError, plugin as th

START_K = 2.0  # a fitted start further off the measured one than this is worth a warning


@dataclass(frozen=True)
class Warming:
    """Eq. 8 fitted.  a degC, b 1, c 1/min;  ci95 : name -> (low, high), of readings scattered independently

    rmse_K : of the fit;  warnings : what the formula says that the record does not
    """

    a: float
    b: float
    c: float
    ci95: dict[str, tuple[float, float]]
    rmse_K: float
    warnings: tuple[str, ...] = ()

    def __call__(self, minutes: Any) -> Any:
        """Temperature (degC) at a time (min)."""
        return eq8(minutes, self.a, self.b, self.c)

    @property
    def start(self) -> float:
        """T(0), degC."""
        return float(self(0.0))

    def time_to_share_min(self, share: float = 0.95) -> float:
        """tau_95: time (min) at which T reaches a share of its end, both in degC as the equation has them."""
        return float(np.log(np.log(share) / self.b) / self.c)

    def rise_min(self, share: float = 0.95) -> float:
        """Time (min) at which a share of the rise from T(0) to the end is done."""
        return float(np.log(np.log((self.start + share * (self.a - self.start)) / self.a) / self.b) / self.c)

    def document(self) -> dict[str, Any]:
        return {
            "a_degC": self.a,
            "b": self.b,
            "c_1_min": self.c,
            "ci95": {k: list(v) for k, v in self.ci95.items()},
            "rmse_K": self.rmse_K,
            "start_degC": self.start,
            "tau95_min": self.time_to_share_min(),
            "warnings": list(self.warnings),
        }


def eq8(minutes: Any, a: Any, b: Any, c: Any) -> Any:
    """T = a exp(b exp(c t)); infinite where a trial of the fit is far off."""
    with np.errstate(over="ignore"):
        return a * np.exp(b * np.exp(c * np.asarray(minutes, float)))


def fit_eq8(minutes: th.Array, T: th.Array, start_C: float | None = None, resolution_K: float = 0.5) -> Warming:
    """Least squares, with 95 % intervals from Student's t.

    start_C : measured temperature at t = 0 (default: the first reading, if it was taken then)
    """
    from scipy.optimize import curve_fit
    from scipy.stats import t as student

    minutes, T = np.asarray(minutes, float), np.asarray(T, float)
    finite = np.isfinite(T)
    minutes, T = minutes[finite], T[finite]
    if T.size < 5 or np.min(T) <= 0 or np.ptp(T) < 4 * resolution_K:
        what = f"{T.size} readings over {np.ptp(T) if T.size else 0:.2g} K"
        raise InputError(what, "eq. 8", f"5 or more above 0 degC that warm by more than {4 * resolution_K:g} K")
    end, first = float(T[-1]), float(T[0])
    guess = (end, np.log(min(first / end, 0.99)), -3.0 / (minutes[-1] - minutes[0]))
    p, covariance = curve_fit(eq8, minutes, T, guess, maxfev=5000)
    wide = student.ppf(0.975, T.size - 3) * np.sqrt(np.diag(covariance))
    ci = {n: (float(v - w), float(v + w)) for n, v, w in zip("abc", p, wide, strict=True)}
    rmse = float(np.sqrt(np.mean((eq8(minutes, *p) - T) ** 2)))
    fit = Warming(float(p[0]), float(p[1]), float(p[2]), ci, rmse)
    measured = first if start_C is None and minutes[0] < 0.5 else start_C
    return Warming(fit.a, fit.b, fit.c, ci, rmse, _doubts(fit, measured, minutes[-1]))


def _doubts(fit: Warming, measured: float | None, last_min: float) -> tuple[str, ...]:
    out = []
    if measured is not None and abs(fit.start - measured) > START_K:
        out.append(
            f"the formula starts at {fit.start:.1f} degC, the record at {measured:.1f} degC: "
            "eq. 8 does not describe the first minutes"
        )
    if fit.b < 0 and fit.c < 0 and fit.time_to_share_min() > last_min:
        out.append(
            f"95 % of the end is reached after {fit.time_to_share_min():.0f} min, after the record's end: "
            "the end temperature is extrapolated"
        )
    return tuple(out)


@dataclass(frozen=True)
class Equilibrium(th.TableRow):
    """reached : whether eq. 9 held to the end;  from_min : since when (min);  T_e : mean since then (degC)

    drift_K_h : slope over the last window (K/h);  resolution_K : of the sensor
    """

    reached: bool
    from_min: float | None
    T_e: float
    drift_K_h: float
    resolution_K: float


def spaced_window(minutes: th.Array, least_min: float = 10.0) -> float:
    """Length (min) of a window in which readings can differ: twice the time between them where they are rare."""
    return max(least_min, 2.0 * float(np.median(np.diff(minutes)))) if len(minutes) > 1 else least_min


def equilibrium(minutes: th.Array, T: th.Array, resolution_K: float, window_min: float = 10.0) -> Equilibrium:
    """Eq. 9 as a detector: from when on no two readings a window apart differ by more than the sensor resolves.

    It must have held for a window's length of such pairs, so that one lucky pair does not count.
    """
    minutes, T = np.asarray(minutes, float), np.asarray(T, float)
    finite = np.isfinite(T)
    minutes, T = minutes[finite], T[finite]
    if T.size < 4 or minutes[-1] - minutes[0] < 2 * window_min:
        right = f"a record longer than {2 * window_min:g} min"
        raise InputError(f"{T.size} readings", "equilibrium", right)
    late = minutes > minutes[-1] - window_min
    drift = 60.0 * float(np.polyfit(minutes[late], T[late], 1)[0]) if late.sum() > 1 else float("nan")
    before = minutes <= minutes[-1] - window_min + 1e-9
    change = np.abs(np.interp(minutes[before] + window_min, minutes, T) - T[before])
    wrong = np.flatnonzero(change > resolution_K + 1e-9)
    first = 0 if wrong.size == 0 else int(wrong[-1]) + 1
    if first >= before.sum() or minutes[first] > minutes[-1] - 2 * window_min + 1e-9:
        return Equilibrium(False, None, float(T[late].mean()), drift, resolution_K)
    since = minutes >= minutes[first]
    return Equilibrium(True, float(minutes[first]), float(T[since].mean()), drift, resolution_K)


LEVEL = 0.05  # significance: how often equal runs are said to differ


@dataclass(frozen=True)
class Repeats(th.TableRow):
    """mean : pooled value;  sd_mean : its standard uncertainty from the runs' scatter, never less than u / sqrt(n)

    spread : largest difference between two runs
    limit : what 95 % of pairs of runs stay below if only the measurement's random uncertainty acts (2.77 u, ISO 5725)
    p : of chi-square = sum (x - mean)^2 / u^2
    """

    properties = ("repeat",)

    n: int
    mean: float
    sd: float
    sd_mean: float
    spread: float
    limit: float
    p: float

    @property
    def repeat(self) -> bool:
        """Whether the runs differ by no more than their uncertainty lets them."""
        return self.p >= LEVEL


def repeats(values: Sequence[float], u: float) -> Repeats:
    """Runs under equal conditions; u : standard uncertainty of one run without what is common to all."""
    from scipy.stats import chi2

    x = np.asarray(values, float)
    if x.size < 2 or u <= 0:
        raise InputError(f"{x.size} runs with uncertainty {u:g}", "repeats", "2 or more runs, an uncertainty above 0")
    sd = float(x.std(ddof=1))
    chi = float(((x - x.mean()) ** 2).sum() / u**2)
    spread, limit, p = float(np.ptp(x)), th.NORMAL_95 * np.sqrt(2.0) * u, float(chi2.sf(chi, x.size - 1))
    return Repeats(x.size, float(x.mean()), sd, max(sd, u) / np.sqrt(x.size), spread, limit, p)


def pooled_curves(minutes: Sequence[th.Array], T: Sequence[th.Array]) -> tuple[th.Array, th.Array, th.Array]:
    """Repeated records on their common times: (minutes, mean, sd between runs)."""
    common = [m for m in minutes[0] if all(o[0] - 1e-9 <= m <= o[-1] + 1e-9 for o in minutes[1:])]
    if len(common) < 2:
        raise InputError("the records share no time", "repeats", "runs of one and the same test")
    grid = np.array(common)
    on_grid = np.array([np.interp(grid, m, y) for m, y in zip(minutes, T, strict=True)])
    return grid, on_grid.mean(axis=0), on_grid.std(axis=0, ddof=1)


def normalised_error(a: float, b: float, U_a: float, U_b: float) -> float:
    """E_n of two results with expanded uncertainties U (95 %); they agree when |E_n| <= 1 (ISO 13528)."""
    return (a - b) / float(np.hypot(U_a, U_b))
