"""Morris and Sobol over the same factors as the factorial, by SALib; factors that vary together count as one group.

Morris (1991; mu* after Campolongo et al. 2007): mean and spread of elementary effects, a few runs per factor.
Sobol (Saltelli et al. 2010): shares of the response's variance, alone (S1) and with all interactions (ST).
Correlated factors have no shares of their own: put them into one group (Jacques et al. 2006).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermoscope import InputError, plugin as th

Response = Callable[[Mapping[str, float]], float]


@dataclass(frozen=True)
class Varied:
    """A factor that varies evenly between low and high; factors of one `group` are varied and judged together."""

    name: str
    low: float
    high: float
    group: str = ""


@dataclass(frozen=True)
class Ranking:
    """name of factor or group -> measure with its 95 % half-width.  spread : Morris' sigma, or ST - S1 of Sobol"""

    method: str
    measure: Mapping[str, float]
    conf: Mapping[str, float]
    spread: Mapping[str, float]
    runs: int

    @property
    def ranked(self) -> list[str]:
        return sorted(self.measure, key=lambda n: -self.measure[n])

    def document(self) -> dict[str, Any]:
        return {
            "method": self.method,
            "runs": self.runs,
            "ranking": [
                {"factor": n, "measure": self.measure[n], "conf95": self.conf[n], "spread": self.spread[n]}
                for n in self.ranked
            ],
        }


def morris(factors: Sequence[Varied], response: Response, trajectories: int = 10, seed: int = 0) -> Ranking:
    """mu* (in the response's unit per half range of the levels) of every factor or group."""
    from SALib.analyze import morris as analyse
    from SALib.sample import morris as sample

    problem = _problem(factors)
    X = sample.sample(problem, trajectories, num_levels=4, seed=seed)
    Y = _answers(problem, X, response)
    indices = analyse.analyze(problem, X, Y, num_levels=4, seed=seed)
    names = [str(n) for n in indices["names"]]
    mean, conf, spread = (_named(names, indices[key]) for key in ("mu_star", "mu_star_conf", "sigma"))
    return Ranking("Morris mu*", mean, conf, spread, len(X))


def sobol(factors: Sequence[Varied], response: Response, base: int = 64, seed: int = 0) -> Ranking:
    """Total shares ST of the response's variance; base * (n + 2) runs, base a power of two."""
    from SALib.analyze import sobol as analyse
    from SALib.sample import sobol as sample

    problem = _problem(factors)
    X = sample.sample(problem, base, calc_second_order=False, seed=seed)
    Y = _answers(problem, X, response)
    indices = analyse.analyze(problem, Y, calc_second_order=False, seed=seed + 1)  # SALib takes 0 for no seed
    names = list(dict.fromkeys(problem["groups"])) if "groups" in problem else problem["names"]
    share, conf = _named(names, indices["ST"]), _named(names, indices["ST_conf"])
    return Ranking("Sobol ST", share, conf, _named(names, indices["ST"] - indices["S1"]), len(X))


def _problem(factors: Sequence[Varied]) -> dict[str, Any]:
    for f in factors:
        if not f.low < f.high:
            raise InputError(f"{f.name} varies from {f.low:g} to {f.high:g}", "factors", "low below high")
    bounds = [[f.low, f.high] for f in factors]
    problem: dict[str, Any] = {"num_vars": len(factors), "names": [f.name for f in factors], "bounds": bounds}
    if any(f.group for f in factors):
        problem["groups"] = [f.group or f.name for f in factors]
    return problem


def _answers(problem: Mapping[str, Any], X: th.Array, response: Response) -> th.Array:
    return np.array([response(dict(zip(problem["names"], (float(v) for v in x), strict=True))) for x in X])


def _named(names: Sequence[str], values: Any) -> dict[str, float]:
    return {n: float(v) for n, v in zip(names, np.ravel(np.ma.filled(values, np.nan)), strict=True)}
