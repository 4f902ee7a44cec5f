"""Which of many factors move a response: two-level designs, and indices of Morris and Sobol by SALib.

design = full([...]) or fractional([...], {"G": "ABCDEF"});  found = effects(design, responses)

An effect is the mean response at the high level minus that at the low one. Which effects are more than noise is judged
by Lenth's pseudo standard error, as published with the half-normal plot.
Sources: Box, Hunter and Hunter 2005; Daniel 1959; Lenth 1989, Technometrics 31, 469.

Morris (1991; mu* after Campolongo et al. 2007): mean and spread of elementary effects, a few runs per factor.
Sobol (Saltelli et al. 2010): shares of the response's variance, alone (S1) and with all interactions (ST).
Correlated factors have no shares of their own: put them into one group (Jacques et al. 2006).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import combinations, product
from typing import Any

import numpy as np

from thermoscope import InputError, plugin as th


@dataclass(frozen=True)
class Factor:
    """A factor with its two levels; letter as in the paper's table."""

    letter: str
    name: str
    low: Any
    high: Any


@dataclass(frozen=True)
class Design:
    """signs (n_run, n_factor) -1 or 1;  words : generators and what follows from them, () for a full design"""

    factors: tuple[Factor, ...]
    signs: th.Array
    words: tuple[str, ...] = ()

    def settings(self) -> list[dict[str, Any]]:
        """Name -> level of every run."""
        levels = [(f.name, f.low, f.high) for f in self.factors]
        return [
            {n: high if s > 0 else low for (n, low, high), s in zip(levels, row, strict=True)} for row in self.signs
        ]

    def column(self, letters: str) -> th.Array:
        """The product of some factors' columns: the contrast of an effect."""
        index = [next(i for i, f in enumerate(self.factors) if f.letter == c) for c in letters]
        return np.asarray(np.prod(self.signs[:, index], axis=1))

    @property
    def resolution(self) -> int:
        """Length of the shortest defining word; 0 for a full design, which confounds nothing."""
        return min((len(w) for w in self.words), default=0)

    def aliases(self, letters: str, order: int = 2) -> tuple[str, ...]:
        """Effects up to an order that this design cannot tell from the given one."""
        same = {_times(letters, word) for word in self.words}
        return tuple(sorted((w for w in same if 0 < len(w) <= order), key=lambda w: (len(w), w)))


def full(factors: Sequence[Factor]) -> Design:
    """All 2^k runs, the first factor varying fastest."""
    signs = np.array([row[::-1] for row in product((-1.0, 1.0), repeat=len(factors))])
    return Design(tuple(factors), signs)


def fractional(factors: Sequence[Factor], generators: Mapping[str, str]) -> Design:
    """2^(k-p) runs: every generated factor is the product of others, e.g. {"G": "ABCDEF"}."""
    letters = "".join(f.letter for f in factors)
    free = [f for f in factors if f.letter not in generators]
    for letter, word in generators.items():
        if letter not in letters or not word or any(c not in {f.letter for f in free} for c in word):
            raise InputError(f"{letter} = {word}", "generators", f"products of {''.join(f.letter for f in free)}")
    base = full(free)
    columns = {f.letter: base.column(f.letter) for f in free} | {g: base.column(w) for g, w in generators.items()}
    signs = np.column_stack([columns[f.letter] for f in factors])
    words = [_times(g, w) for g, w in generators.items()]
    subsets = (subset for n in range(1, len(words) + 1) for subset in combinations(words, n))
    return Design(tuple(factors), signs, tuple(reduce(_times, subset) for subset in subsets))


def _times(a: str, b: str) -> str:
    """Product of two words: letters that occur twice cancel."""
    return "".join(sorted(set(a) ^ set(b)))


@dataclass(frozen=True)
class Effects:
    """letters -> effect, in the response's unit;  PSE, margin, simultaneous : Lenth's standard error and 95 % limits"""

    response: str
    effects: Mapping[str, float]
    names: Mapping[str, str]
    PSE: float
    margin: float
    simultaneous: float

    @property
    def ranked(self) -> list[tuple[str, float]]:
        """Largest first: the Pareto chart's order."""
        return sorted(self.effects.items(), key=lambda e: -abs(e[1]))

    @property
    def active(self) -> tuple[str, ...]:
        """Effects beyond the simultaneous limit."""
        return tuple(letters for letters, e in self.ranked if abs(e) > self.simultaneous)

    def document(self) -> dict[str, Any]:
        rows = [{"effect": e, "words": self.words(e), "value": v, "active": e in self.active} for e, v in self.ranked]
        limits = {"PSE": self.PSE, "margin": self.margin, "simultaneous": self.simultaneous}
        return {"response": self.response, **limits, "effects": rows}

    def words(self, letters: str) -> str:
        return " x ".join(self.names[c] for c in letters)


def effects(design: Design, values: th.Array, response: str = "", order: int = 2) -> Effects:
    """Main effects and interactions up to an order; of aliased ones the shortest stands for all."""
    values = np.asarray(values, float)
    letters = [f.letter for f in design.factors]
    words = ["".join(w) for n in range(1, order + 1) for w in combinations(letters, n)]
    leading = [w for w in words if not any((len(a), a) < (len(w), w) for a in design.aliases(w, order))]
    by_word = {w: float(2.0 * design.column(w) @ values / values.size) for w in leading}
    PSE, margin, simultaneous = lenth(np.array(list(by_word.values())))
    return Effects(response, by_word, {f.letter: f.name for f in design.factors}, PSE, margin, simultaneous)


def lenth(contrasts: th.Array) -> tuple[float, float, float]:
    """Lenth's pseudo standard error, margin of error (95 %) and simultaneous margin of error."""
    from scipy.stats import t as student

    size = np.abs(contrasts)
    first = 1.5 * float(np.median(size))
    PSE = 1.5 * float(np.median(size[size < 2.5 * first])) if first > 0 else 0.0
    m, free = size.size, size.size / 3.0
    gamma = 0.5 * (1.0 + 0.95 ** (1.0 / m))
    return PSE, PSE * float(student.ppf(0.975, free)), PSE * float(student.ppf(gamma, free))


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
        columns = {"measure": self.measure, "conf95": self.conf, "spread": self.spread}
        ranking = [{"factor": n, **{key: of[n] for key, of in columns.items()}} for n in self.ranked]
        return {"method": self.method, "runs": self.runs, "ranking": ranking}


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
