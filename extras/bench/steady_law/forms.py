"""Forms that a cooling law may have, and the temperatures they give.

    heat = G (T - T_in) + G0 (T - T_ambient),   G^m = G1^m + G2^m,   Gi = c * product of (input / highest)^a * r^v

r : how much thinner the coolant is than at the usual inlet. Where the coolant's mean counts and not its inlet,
1 / G has 1 / (2 m cp) more.  Sums with an exponent: Churchill and Usagi 1972, AIChE Journal 18, 1121.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from extras.bench.steady_law.steady_tests import TINY, SteadyTests
from thermoscope import plugin as th

LEVELS = 4  # of an input that may have a limit: two on each side
STEEPEST = 12.0  # ln of a conductance over the usual one: beyond lies no machine
Label = tuple[str | int, ...]  # kind of a number, and the term and input it belongs to
# Mean and sd of what is plausible before any reading: ln of conductances, exponents, ln m, share of an input's range.
PRIORS = {"G": (0.0, 2.0), "a": (1.0, 1.0), "v": (0.0, 1.0), "at": (0.5, 0.29), "m": (0.0, 0.5), "G0": (-3.0, 1.5)}


@dataclass(frozen=True)
class Form:
    """terms : inputs of each;  proportional : (term, input) whose exponent is one;  fluid : 0, 1 or an exponent a term

    limit : an input, and whether it counts up to a value or from there on;  blend : m is free;  ambient : there is a G0
    warming : the coolant's mean temperature counts
    """

    terms: tuple[tuple[int, ...], ...]
    proportional: frozenset[tuple[int, int]] = frozenset()
    fluid: int = 0
    limit: tuple[int, str] | None = None
    blend: bool = False
    ambient: bool = False
    warming: bool = False

    @property
    def inputs(self) -> frozenset[int]:
        return frozenset(i for term in self.terms for i in term)

    @property
    def powers(self) -> list[tuple[int, int]]:
        """(term, input) with an exponent, free or one."""
        return [(t, i) for t, term in enumerate(self.terms) for i in term]

    @property
    def labels(self) -> list[Label]:
        """What each number is, alike in all forms."""
        out: list[Label] = [("G", t) for t in range(len(self.terms))]
        out += [("a", *power) for power in self.powers if power not in self.proportional]
        out += [("v", n) for n in range(self.fluid)]
        more = (("at",), self.limit is not None), (("m",), self.blend), (("G0",), self.ambient)
        return out + [label for label, there in more if there]

    def larger(self, tests: SteadyTests) -> "Iterator[Form]":
        """Forms that have one thing more."""
        for power in self.powers:
            if power not in self.proportional:
                yield replace(self, proportional=self.proportional | {power})
        if np.ptp(tests.thinner) > 0.0 and self.fluid < len(self.terms):
            yield replace(self, fluid=self.fluid + 1)
        if (tests.ambient != tests.coolant).any():
            yield replace(self, ambient=True)
        if np.isfinite(tests.mcp).all():
            yield replace(self, warming=True)
        if len(self.terms) > 1:
            yield replace(self, blend=True)
        for i in self.inputs if self.limit is None else ():
            if len(tests.levels(i)) >= LEVELS:
                yield from (replace(self, limit=(i, kind)) for kind in ("up to", "from"))


def simplest(tests: SteadyTests) -> list[Form]:
    """One term, or two, each of any inputs or none; one of them cools where nothing turns."""
    inputs = range(tests.inputs.shape[1])
    terms = [s for n in range(len(inputs) + 1) for s in combinations(inputs, n)]
    resting = set(np.flatnonzero((tests.inputs == 0.0).any(axis=0)).tolist())
    forms = [Form((s,)) for s in terms] + [Form(pair) for pair in combinations(terms, 2)]
    return [f for f in forms if not all(resting & set(term) for term in f.terms)]


def edge(form: Form, share: float, tests: SteadyTests) -> tuple[float, float]:
    """Where the input of a limit lies over its highest value, and the slope of that by its share of the range."""
    assert form.limit
    low = float(tests.scales.lowest[form.limit[0]] / tests.scales.highest[form.limit[0]])
    return low + (1.0 - low) * min(max(share, 0.01), 0.99), 1.0 - low


def conductances(form: Form, x: th.Array, tests: SteadyTests) -> tuple[th.Array, th.Array, th.Array, th.Array]:
    """(n,) ln G and G0 (W/K), each with its (n, p) slopes, of G0 those of its logarithm;  x : numbers by `labels`"""
    at = {label: n for n, label in enumerate(form.labels)}
    n, p = len(tests.heat), x.size
    u = tests.inputs / tests.scales.highest
    bend = np.zeros(n)
    if form.limit:
        i, kind = form.limit
        value, slope_of_edge = edge(form, float(x[at["at",]]), tests)
        over = u[:, i] > value
        u[:, i] = np.minimum(u[:, i], value) if kind == "up to" else np.maximum(u[:, i] - value, 0.0)
        bend[over] = slope_of_edge * (1.0 if kind == "up to" else -1.0) / u[over, i]
    log_u = np.log(np.maximum(u, TINY))
    logs, slopes = np.empty((len(form.terms), n)), np.zeros((len(form.terms), n, p))
    for t, term in enumerate(form.terms):
        logs[t], slopes[t, :, at["G", t]] = x[at["G", t]] + tests.scales.log_G, 1.0
        for i in term:
            k = at.get(("a", t, i))
            exponent = 1.0 if k is None else x[k]
            logs[t] += exponent * log_u[:, i]
            if k is not None:
                slopes[t, :, k] = log_u[:, i]
            if form.limit and form.limit[0] == i:
                slopes[t, :, at["at",]] += exponent * bend
        if form.fluid:
            k = at["v", min(t, form.fluid - 1)]
            logs[t] += x[k] * tests.thinner
            slopes[t, :, k] = tests.thinner
    m = float(np.exp(x[at["m",]])) if form.blend else 1.0
    top = logs.max(axis=0)
    parts = np.exp(m * (logs - top))
    share = parts / parts.sum(axis=0)
    log_G, slope = top + np.log(parts.sum(axis=0)) / m, np.einsum("tn,tnp->np", share, slopes)
    if form.blend:
        slope[:, at["m",]] = (share * logs).sum(axis=0) - log_G
    if form.warming:
        ratio = np.exp(log_G) / (2.0 * tests.mcp)
        log_G, slope = log_G - np.log1p(ratio), slope / (1.0 + ratio)[:, None]
    G0, slope0 = np.zeros(n), np.zeros((n, p))
    if form.ambient:
        G0[:], slope0[:, -1] = np.exp(x[-1] + tests.scales.log_G), 1.0
    return np.clip(log_G, tests.scales.log_G - STEEPEST, tests.scales.log_G + STEEPEST), slope, G0, slope0


def temperature(form: Form, x: th.Array, tests: SteadyTests) -> tuple[th.Array, th.Array]:
    """(n,) mean temperature (degC) of the sensors, and its (n, p) slopes."""
    log_G, slope, G0, slope0 = conductances(form, x, tests)
    G = np.exp(log_G)
    T = (tests.heat + G * tests.coolant + G0 * tests.ambient) / (G + G0)
    by_G, by_G0 = G * (tests.coolant - T) / (G + G0), G0 * (tests.ambient - T) / (G + G0)
    return T, by_G[:, None] * slope + by_G0[:, None] * slope0
