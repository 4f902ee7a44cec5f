"""The old way: turn one knob until the curves agree. Shown beside a diagnosis to see what it costs on other tests."""

from dataclasses import dataclass, replace

import numpy as np

from geom.errors import InputError
from measured.case import Case
from validation.comparison.compare import Comparison, errors, pooled

RANGE = (0.25, 4.0)  # of a factor: beyond, the model has another fault than this one


@dataclass(frozen=True)
class OneFactorFit:
    """One parameter moved, all others as they were: its factor, and the errors that result."""

    parameter: str
    factor: float
    errors: Comparison


def one_factor_fit(case: Case, parameter: str, channel: str | None = None) -> OneFactorFit:
    """The factor on one parameter of the network that brings the validation tests closest (to one channel, or to all).

    Nothing tells this fit what is physically right: no prior, no other test.
    """
    from scipy.optimize import minimize_scalar

    nominal = {p.name: p.value for p in case.model.network.parameters}
    if parameter not in nominal:
        raise InputError(f"unknown parameter '{parameter}'", case.name, f"known: {', '.join(sorted(nominal))}")
    now = dict(case.model.values)
    start = now.get(parameter, nominal[parameter])

    def moved(log_factor: float) -> dict[str, float]:
        return {**now, parameter: start * float(np.exp(log_factor))}

    validation_case = replace(case, tests=tuple(t for t in case.tests if t.role == "validate"))

    def error(log_factor: float) -> float:
        tests = errors(validation_case, moved(log_factor)).tests
        return pooled([c for t in tests for c in t.channels if channel in (None, c.channel)])

    best = minimize_scalar(error, bounds=tuple(np.log(RANGE)), method="bounded", options={"xatol": 0.01})
    return OneFactorFit(parameter, float(np.exp(best.x)), errors(case, moved(float(best.x))))
