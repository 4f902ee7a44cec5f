"""How sure a computed number is: worst case, GUM to first order, and GUM by Monte Carlo, side by side.

found = spread(rise, (Reading("R0", 0.5, 0.00325), Reading("R", 0.657, 0.00364), Reading("beta", 0.003925, 5e-6)))
found.worst, found.sd, found.interval, found.budget

A data sheet's limit +-a says that every error within it is as likely as another: standard uncertainty a / sqrt(3).
Sources: JCGM 100:2008 (4.3.7, 5.1.2) and JCGM 101:2008; first-order arithmetic by the package `uncertainties`.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, Literal

import numpy as np

from geom.arrays import Array
from geom.constants import NORMAL_95

DRAWS = 20_000  # hold a 95 % interval within 1 % (GUM supplement 1 asks for more where tails matter)
CORNERS = 12  # inputs up to which all corners are visited


@dataclass(frozen=True)
class Reading:
    """A number that is not exactly known.

    limit : half-width of what is possible ("even") or standard uncertainty ("normal", worst case at 2 limit)
    """

    name: str
    value: float
    limit: float
    shape: Literal["even", "normal"] = "even"

    @property
    def sd(self) -> float:
        return self.limit / np.sqrt(3.0) if self.shape == "even" else self.limit

    @property
    def reach(self) -> float:
        """How far the worst case goes."""
        return self.limit if self.shape == "even" else 2.0 * self.limit

    def draw(self, random: np.random.Generator, n: int) -> Array:
        if self.shape == "even":
            return np.asarray(random.uniform(self.value - self.limit, self.value + self.limit, n))
        return np.asarray(random.normal(self.value, self.limit, n))


@dataclass(frozen=True)
class PropagatedUncertainty:
    """A result with its uncertainty in the unit of the result.

    worst : (low, high) over all corners of the inputs;  sd : first order;  monte_carlo_sd, interval : Monte Carlo, 95 %
    budget : input -> standard uncertainty it alone would cause, first order
    """

    value: float
    worst: tuple[float, float]
    sd: float
    monte_carlo_sd: float
    interval: tuple[float, float]
    budget: Mapping[str, float]

    @property
    def first_order(self) -> tuple[float, float]:
        """95 % interval to first order."""
        return self.value - NORMAL_95 * self.sd, self.value + NORMAL_95 * self.sd

    def document(self) -> dict[str, Any]:
        return {
            "value": self.value,
            "sd": self.sd,
            "worst": list(self.worst),
            "gum95": list(self.first_order),
            "monte_carlo_sd": self.monte_carlo_sd,
            "monte_carlo95": list(self.interval),
            "budget": dict(self.budget),
        }


def propagate(
    result: Callable[..., Any], readings: Sequence[Reading], draws: int = DRAWS, seed: int = 0
) -> PropagatedUncertainty:
    """The three uncertainties of result(*readings); `result` works on numbers and on arrays alike."""
    sd, budget = _first_order(result, readings)
    random = np.random.default_rng(seed)
    outcomes = np.asarray(result(*(r.draw(random, draws) for r in readings)), float)
    low, high = np.percentile(outcomes, [2.5, 97.5])
    value = float(result(*(r.value for r in readings)))
    return PropagatedUncertainty(
        value, _worst(result, readings), sd, float(outcomes.std(ddof=1)), (float(low), float(high)), budget
    )


def _first_order(result: Callable[..., Any], readings: Sequence[Reading]) -> tuple[float, dict[str, float]]:
    from uncertainties import ufloat, wrap

    variables = [ufloat(r.value, r.sd) for r in readings]
    linear = wrap(lambda *x: float(result(*x)))(*variables)
    parts = linear.error_components()
    return float(linear.std_dev), {r.name: float(parts.get(v, 0.0)) for r, v in zip(readings, variables, strict=True)}


def _worst(result: Callable[..., Any], readings: Sequence[Reading]) -> tuple[float, float]:
    """Lowest and highest result over the corners of the box of inputs: exact for results monotone in each."""
    if len(readings) > CORNERS:
        raise ValueError(f"{len(readings)} inputs: the worst case visits at most 2^{CORNERS} corners")
    signs = np.array(list(product((-1.0, 1.0), repeat=len(readings)))).T
    corners = [r.value + s * r.reach for r, s in zip(readings, signs, strict=True)]
    outcomes = np.asarray(result(*corners), float)
    return float(outcomes.min()), float(outcomes.max())
