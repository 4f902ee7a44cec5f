"""What one recording of one motor says of its parameters, in a few numbers however long it is.

A Gauss-Newton fit of parameters, sensors and start; the sensors' share is integrated out and the prior of the
parameters taken off again. What is left is a normal likelihood of the parameters alone,

    log p(y | theta) = -theta' H theta / 2 + theta' eta + constant

so that recordings of one motor add up, and no recording has to be kept.
"""

from dataclasses import dataclass, replace

import numpy as np

from thermoscope import Network, Parameter, plugin as th

CAPACITY_YEAR, LOSS_YEAR = 0.005, 0.03  # masses stay, magnets and sheets age by per cents (of the logarithm)
PATH_YEAR = 0.3  # a film or joint that loses a quarter in a year is fouling or loosening badly
ITERATIONS = 5  # of Gauss and Newton: a film at a third of its value takes four


@dataclass(frozen=True)
class Statistics:
    """names (p,) of the parameters;  H (p, p), eta (p,) : see above, in fitting coordinates (log of a ratio)

    sd (p,) : of the parameters' priors, by which one motor alone was fitted;  drift_sd (p,) per year
    rmse_K : what the fit leaves;  samples : that it saw
    """

    names: tuple[str, ...]
    sd: th.Array
    drift_sd: th.Array
    H: th.Array
    eta: th.Array
    rmse_K: float
    samples: int

    def __add__(self, other: "Statistics") -> "Statistics":
        n = self.samples + other.samples
        square = (self.samples * self.rmse_K**2 + other.samples * other.rmse_K**2) / n
        return Statistics(
            self.names, self.sd, self.drift_sd, self.H + other.H, self.eta + other.eta, float(np.sqrt(square)), n
        )


@dataclass(frozen=True)
class UnitHistory:
    """One motor: its recordings' statistics, each with its date (years)."""

    name: str
    years: tuple[float, ...]
    parts: tuple[Statistics, ...]


def statistics(case: th.MeasuredCase, test: th.Test) -> Statistics:
    """Of a recording, for the parameters that the case leaves free, and its effects, from the model as it stands."""
    model = replace(case.model, reference=th.standing_reference(case))  # one for all recordings of a fleet
    one = replace(case, model=model, tests=(replace(test, role="calibrate"),))
    network, unknowns = th.working(one)
    free = {p.name for p in (case.nuisances or case.model.network.parameters)} | {e.name for e in case.model.effects}
    values = th.parameter_values(network, case.model.values)
    start = np.array([th.to_coordinate(p, values[p.name]) for p in unknowns.parameters])
    fit = th.minimise(network, one.tests, unknowns, start, None, values, ITERATIONS)
    # an effect's size is fitted as it is: here what it is more by, in shares of the model's; of none there is no share
    plain = np.array([p.mapping != "log" for p in unknowns.parameters], bool)
    unit = np.array([p.name in free for p in unknowns.parameters], bool) & ~(plain & (start == 0.0))
    origin, scale = np.where(plain & unit, start, 0.0), np.where(plain & unit, np.abs(start), 1.0)
    information, eta = fit.H * np.outer(scale, scale), scale * (fit.H @ (fit.theta - origin))
    prior = (unknowns.sd / scale) ** -2.0
    information[unit, unit] -= prior[unit]
    eta[unit] += (origin / scale * prior)[unit]
    share = np.linalg.solve(information[np.ix_(~unit, ~unit)], information[np.ix_(~unit, unit)]).T
    H = information[np.ix_(unit, unit)] - share @ information[np.ix_(~unit, unit)]
    names = tuple(p.name for p, flag in zip(unknowns.parameters, unit, strict=True) if flag)
    r = np.concatenate([s.r for s in fit.parts])
    ages = np.array([_drift_sd(network, p) for p in unknowns.parameters])[unit]
    rmse = float(np.sqrt(np.mean(r**2)))
    sd, eta = (unknowns.sd / scale)[unit], eta[unit] - share @ eta[~unit]
    return Statistics(names, sd, ages, 0.5 * (H + H.T), eta, rmse, r.size)


def _drift_sd(network: Network, p: Parameter) -> float:
    """What a parameter of this kind may drift by in a year."""
    targets = {target for target, _ in p.targets}
    if targets <= {f"capacity:{g}" for g in network.capacity_group}:
        return CAPACITY_YEAR
    return LOSS_YEAR if targets <= {s.name for s in network.sources} else PATH_YEAR
