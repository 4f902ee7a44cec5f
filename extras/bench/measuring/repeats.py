"""Equal tests repeated, and equal machines: pooled, and whether they repeat within the measurement's uncertainty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermoscope import InputError, plugin as th

LEVEL = 0.05  # significance: how often equal runs are said to differ


@dataclass(frozen=True)
class Repeats:
    """mean : pooled value;  sd_mean : its standard uncertainty from the runs' scatter, never less than u / sqrt(n)

    spread : largest difference between two runs
    limit : what 95 % of pairs of runs stay below if only the measurement's random uncertainty acts (2.77 u, ISO 5725)
    p : of chi-square = sum (x - mean)^2 / u^2
    """

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

    def document(self) -> dict[str, Any]:
        return {**vars(self), "repeat": self.repeat}


def repeats(values: Sequence[float], u: float) -> Repeats:
    """Runs under equal conditions; u : standard uncertainty of one run without what is common to all."""
    from scipy.stats import chi2

    x = np.asarray(values, float)
    if x.size < 2 or u <= 0:
        raise InputError(f"{x.size} runs with uncertainty {u:g}", "repeats", "2 or more runs, an uncertainty above 0")
    sd = float(x.std(ddof=1))
    chi = float(((x - x.mean()) ** 2).sum() / u**2)
    return Repeats(
        x.size,
        float(x.mean()),
        sd,
        max(sd, u) / np.sqrt(x.size),
        float(np.ptp(x)),
        th.NORMAL_95 * np.sqrt(2.0) * u,
        float(chi2.sf(chi, x.size - 1)),
    )


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
