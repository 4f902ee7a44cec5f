"""Where and when heat is missing: a free heat input at each node in turn, as hat functions of time.

log evidence of a heat input q ~ N(0, s^2) per hat at node i, nuisances projected out; 10 nats locate it.
Source: Sarkka, Alvarez and Lawrence 2019 (latent force models); Rasmussen and Williams 2006, 5.4.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from lumped.laws import Fixed, Inputs
from lumped.network import Network, Parameter
from validation.calibrate import Fit
from validation.case import Test
from validation.effects.build import Shaped, heat, power_scale
from validation.effects.sites import solids
from validation.score import Gram, gram
from validation.sheet import segments

Array = NDArray[np.float64]
KNOT_S = 180.0
MEMORY_S = (60.0, 1200.0)


@dataclass(frozen=True)
class Latent:
    """Heat missing at one place: evidence (nats); per test its times (s), heat (W) and standard deviation (W)."""

    place: str
    evidence_nats: float
    heat_W: dict[str, tuple[Array, Array, Array]]

    def document(self) -> dict:
        series = {
            n: {"time_s": t.tolist(), "heat_W": q.tolist(), "sd_W": s.tolist()} for n, (t, q, s) in self.heat_W.items()
        }
        return {"place": self.place, "evidence_nats": self.evidence_nats, "heat": series}


@dataclass(frozen=True)
class Hat:
    """A hat function of time around one knot (s)."""

    at: float
    width: float

    def __call__(self, inputs: Inputs) -> Array:
        return np.maximum(0.0, 1.0 - np.abs(np.asarray(inputs["time_s"], float) - self.at) / self.width)


def latent_heat(fit: Fit, tests: Sequence[Test], knot_s: float = KNOT_S) -> list[Latent]:
    """The scan over all solids, most evident first, by the residual's own noise: it places heat, it tests nothing."""
    places, noise = [p.name for p in solids(fit.network)], replace(fit.noise, allow=0.0)
    p, weight = len(fit.unknowns.parameters), fit.unknowns.sd**-2.0
    knots, grams = {}, {}
    for test in tests:
        span = test.time[-1] - test.time[0]
        knots[test.name] = test.time[0] + np.linspace(0.0, span, max(2, round(span / knot_s) + 1))
        network, hats = with_hats(fit.network, places, knots[test.name])
        parts = segments(network, [test], fit.values, (*fit.unknowns.parameters, *hats))
        grams[test.name] = gram(parts, noise, p)[test.name]
    H = sum(g.JJ for g in grams.values()) + np.diag(weight)
    Jr = sum(g.Jr for g in grams.values()) - weight * fit.theta
    cov, scale = np.asarray(np.linalg.inv(H), float), power_scale(fit.network)
    out = [_at(place, i, knots, grams, cov, Jr, scale) for i, place in enumerate(places)]
    return sorted(out, key=lambda x: -x.evidence_nats)


def with_hats(network: Network, places: Sequence[str], knots: Array) -> tuple[Network, list[Parameter]]:
    """The network with a zero heat input (1 W) at every place and knot."""
    sources, hats = [], []
    for place in places:
        for at in knots:
            name = f"latent:{place}:{at:.0f}"
            law = Shaped(Fixed(1.0), Hat(float(at), float(knots[1] - knots[0])), also_reads=("time_s",))
            sources.append(heat(network, name, "latent", place, law))
            hats.append(Parameter(name, ((name, 1.0),), 0.0, "W", mapping="amplitude", neutral=0.0))
    network = network.extended(sources=sources)
    return replace(network, parameters=(*network.parameters, *hats)), hats


def _at(place: str, i: int, knots: dict, grams: dict[str, Gram], cov: Array, Jr: Array, scale: float) -> Latent:
    size = [len(k) for k in knots.values()]
    start = np.concatenate([[0], np.cumsum(size)])
    A, u = np.zeros((start[-1], start[-1])), np.zeros(start[-1])
    JZ = np.zeros((cov.shape[0], start[-1]))
    for d, g in enumerate(grams.values()):
        own, block = slice(i * size[d], (i + 1) * size[d]), slice(start[d], start[d + 1])
        A[block, block], u[block], JZ[:, block] = g.ZZ[own, own], g.Zr[own], g.JZ[:, own]
    A, u = A - JZ.T @ cov @ JZ, u - JZ.T @ cov @ Jr
    sizes = scale * 10.0 ** np.arange(-3.0, 1.5, 0.5)
    forms = [_correlation(list(knots.values()), memory) for memory in MEMORY_S]
    best, q, sd = max((_evidence(A, u, s, R) for s in sizes for R in forms), key=lambda x: x[0])
    cut = [slice(a, b) for a, b in pairwise(start)]
    heat_W = {name: (knots[name], q[c], sd[c]) for name, c in zip(knots, cut, strict=True)}
    return Latent(place, float(best), heat_W)


def _correlation(knots: Sequence[Array], memory: float) -> Array:
    """Correlation of the heat at the knots: exp(-|dt| / memory) within a test, none between tests."""
    return block_diag(*(np.exp(-np.abs(k[:, None] - k[None, :]) / memory) for k in knots))


def _evidence(A: Array, u: Array, s: float, R: Array) -> tuple[float, Array, Array]:
    """Log evidence of q ~ N(0, s^2 R), posterior mean and standard deviation."""
    K = s**2 * R
    M = np.eye(len(u)) + K @ A
    cov = np.linalg.solve(M, K)
    q = np.asarray(cov @ u, float)
    _, logdet = np.linalg.slogdet(M)
    return 0.5 * float(u @ q) - 0.5 * float(logdet), q, np.asarray(np.sqrt(np.maximum(np.diag(cov), 0.0)), float)
