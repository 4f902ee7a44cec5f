"""Fitted values with their intervals: what the data fixed, what they could not, and with whom it trades."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geom.arrays import Array
from geom.constants import NORMAL_95
from geom.table import TableRow
from measured.sensors.operators import of_measurement
from validation.calibration.calibrate import Fit
from validation.parameters.unknowns import to_value

UNINFORMED = 0.9  # of its prior sd: a parameter that data narrow by less than a tenth was not seen
TRADES = 0.7  # correlation: half of the one's variance is the other's


@dataclass(frozen=True)
class Profile:
    """Central 95 % by profile likelihood; `open` says which ends are only the parameter's bounds."""

    low: float
    high: float
    open: tuple[bool, bool]

    def document(self) -> dict:
        return {"ci95": [self.low, self.high], "open": list(self.open)}


@dataclass(frozen=True)
class Estimate(TableRow):
    """A fitted parameter. prior : (median, low, high) of its central 95 %; identified: the data narrowed the prior.

    partner : the parameter it trades with, where their correlation exceeds 0.7;  at_bound : it sticks to a bound
    of_measurement : a sensor's, a boundary's, a start's or a clock's, not the machine's
    """

    name: str
    value: float
    unit: str
    ci95: tuple[float, float]
    prior: tuple[float, float, float]
    identified: bool
    partner: str | None = None
    at_bound: bool = False
    profile: Profile | None = None
    of_measurement: bool = False


def estimates(fit: Fit, profiles: Mapping[str, Profile] | None = None) -> tuple[Estimate, ...]:
    """Values with intervals from the covariance, model error in it, never wider than the prior's."""
    correlation = correlations(fit)
    partner = np.argmax(np.abs(correlation), axis=1)
    profile_of = profiles or {}
    out = []
    for i, p in enumerate(fit.unknowns.parameters):
        trades = abs(correlation[i, partner[i]]) > TRADES
        # Median and central 95 % of the prior inside the bounds
        median, low, high = (
            float(np.clip(to_value(p, s * NORMAL_95 * p.prior_sd), p.low, p.high)) for s in (0.0, -1.0, 1.0)
        )
        out.append(
            Estimate(
                p.name,
                to_value(p, float(fit.theta[i])),
                p.unit,
                interval(fit, i),
                (median, low, high),
                bool(fit.sd[i] <= UNINFORMED * p.prior_sd),
                fit.unknowns.names[partner[i]] if trades else None,
                bool(fit.at_bound[i]),
                profile_of.get(p.name),
                of_measurement(p),
            )
        )
    return tuple(out)


def correlations(fit: Fit) -> Array:
    """Posterior correlations with an empty diagonal, (p, p)."""
    sd = fit.sd
    out = fit.covariance / np.outer(sd, sd)
    np.fill_diagonal(out, 0.0)
    return np.asarray(out, float)


def interval(fit: Fit, i: int) -> tuple[float, float]:
    """Central 95 % of a parameter inside its bounds."""
    p = fit.unknowns.parameters[i]
    half = NORMAL_95 * min(float(fit.sd[i]), p.prior_sd)
    low, high = (to_value(p, float(fit.theta[i] + s * half)) for s in (-1.0, 1.0))
    return max(low, p.low), min(high, p.high)
