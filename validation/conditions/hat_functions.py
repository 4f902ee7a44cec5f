"""Heat that went missing for a while, as a sum of hats that the scan for missing heat has run already.

With u, V the efficient score of all hats, that of any course of heat w (W at the knots) is w'u, w'V w: thousands of
stretches cost no further run. Heat that a conductance would carry has w = -(T_i - T_j), at both of its ends.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from measured.case import Test
from measured.doubt import FORM, SIZES, USUAL
from validation.calibration.model_error import nodes
from validation.effects.build import conductance_scale, power_scale
from validation.effects.time_window import Event, Span
from validation.inference.evidence import Evidence, extended_prior, projected
from validation.inference.missing_heat import Scan
from validation.inference.score import Score, one_size, per_test, score

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Path:
    """How heat goes missing: into nothing (`other` is ""), or from a node to another or to a boundary."""

    place: str
    other: str = ""


@dataclass(frozen=True)
class Interval:
    """An event and the path that explains it best.  log_bayes : against nothing, the price of when not yet paid"""

    event: Event
    path: Path
    log_bayes: float


@dataclass(frozen=True)
class HatScores:
    """All hats of a scan with their efficient score.

    knots : test -> (m,) s;  start : test -> index of its first hat;  T : test -> place or boundary -> (m,) degC
    power_W, conductance_W_K : of this machine's size
    """

    places: tuple[str, ...]
    knots: Mapping[str, Array]
    start: Mapping[str, int]
    T: Mapping[str, Mapping[str, Array]]
    score: Score
    power_W: float
    conductance_W_K: float

    def usual(self, path: Path) -> float:
        """Standard deviation of what a path usually carries, W or W/K."""
        return FORM["heat size"] * USUAL["switched"] * (self.conductance_W_K if path.other else self.power_W)

    def paths(self, near: Mapping[str, set[str]]) -> list[Path]:
        """Heat at every place, and conduction from there to everything near it."""
        places = next(iter(self.T.values()))
        return [Path(a, b) for a in self.places for b in ("", *sorted(near.get(a, set()))) if not b or b in places]

    def ends(self, path: Path, test: str) -> list[tuple[NDArray[np.int64], Array]]:
        """Of either end of a path that has hats: their indices, and the heat (m,) that one unit brings there."""
        m, T = self.knots[test].size, self.T[test]
        away = T[path.place] - T[path.other] if path.other else -np.ones(m)
        signs = [(p, s * away) for p, s in ((path.place, -1.0), (path.other, 1.0)) if p in self.places]
        return [(self.start[test] + self.places.index(p) * m + np.arange(m), heat) for p, heat in signs]

    def at_knots(self, path: Path, test: str) -> tuple[Array, Array]:
        """Score (m,) and covariance (m, m) of a path that is open at single knots."""
        ends, s = self.ends(path, test), self.score
        u = sum(heat * s.u[i] for i, heat in ends)
        V = sum(np.outer(a, b) * s.V[np.ix_(i, j)] for i, a in ends for j, b in ends)
        return np.asarray(u), np.asarray(V)

    def course(self, event: Event, path: Path) -> tuple[NDArray[np.int64], Array]:
        """Indices of the hats, and heat (W) in each, of a path of one unit that is open while an event lasts."""
        ends = [
            (i, heat * overlap(self.knots[t], spans))
            for t, spans in event.spans.items()
            for i, heat in self.ends(path, t)
        ]
        return np.concatenate([i for i, _ in ends]), np.concatenate([w for _, w in ends])

    def sums(self, event: Event, path: Path, test: str) -> tuple[float, float, Array]:
        """Score and variance of an event, and its covariance (m,) with the path at single knots of a test."""
        (i, w), s = self.course(event, path), self.score
        cross = sum(heat * (s.V[np.ix_(j, i)] @ w) for j, heat in self.ends(path, test))
        return float(w @ s.u[i]), float(w @ s.V[np.ix_(i, i)] @ w), np.asarray(cross)

    def weigh(self, event: Event, path: Path) -> Interval:
        """Evidence of a path that is open while an event lasts, repeats with one amplitude."""
        i, w = self.course(event, path)
        u, V = float(w @ self.score.u[i]), float(w @ self.score.V[np.ix_(i, i)] @ w)
        return Interval(event, path, float(log_bayes(np.array([u]), np.array([V]), self.usual(path))[0]))


def hat_scores(evidence: Evidence, heat_scan: Scan, values: Mapping[str, float]) -> HatScores:
    """The scan as an efficient score: calibration and model error projected out."""
    fit, network = evidence.fit, evidence.fit.network
    left = {(s.test, s.channel): s.r for s in fit.parts}
    grams = projected(fit, [replace(s, r=left[s.test, s.channel]) for s in heat_scan.parts])
    start, count = {}, 0
    for name, g in grams.items():
        start[name], count = count, count + g.Zr.size
    theta, sd = extended_prior(fit)
    scores = score(per_test(grams), theta, sd, np.zeros(count, int))
    T = {t.name: temperatures(evidence, t, heat_scan.knots[t.name], values) for t in evidence.tests}
    return HatScores(
        heat_scan.places, heat_scan.knots, start, T, scores, power_scale(network), conductance_scale(network)
    )


def temperatures(evidence: Evidence, test: Test, at: Array, values: Mapping[str, float]) -> dict[str, Array]:
    """Place or boundary -> degC at some times of a test, by the fitted model."""
    network = evidence.fit.network
    places = [p for p in network.places.values() if p.kind in ("part", "node", "fluid")]
    y = nodes(network, test, values, places)
    around = {b: np.broadcast_to(np.asarray(test.boundaries[b], float), test.time.shape) for b in network.boundaries}
    courses = {**{p.name: y[:, i] for i, p in enumerate(places)}, **around}
    return {name: np.interp(at, test.time, course) for name, course in courses.items()}


def overlap(knots: Array, spans: Sequence[Span]) -> Array:
    """Share of each hat's reach (half a spacing to either side) that lies in a span."""
    half = 0.5 * (knots[1] - knots[0])
    inside = sum(np.clip(np.minimum(knots + half, b) - np.maximum(knots - half, a), 0.0, None) for a, b in spans)
    return np.clip((np.zeros_like(knots) + inside) / (2.0 * half), 0.0, 1.0)


def log_bayes(u: Array, V: Array, usual: float) -> Array:
    """Log Bayes factors of amplitudes of either sign, averaged over the usual sizes."""
    sd, either = np.full(u.shape, usual), np.zeros(u.shape, int)
    sizes = [one_size(u, np.maximum(V, 0.0), f * sd, either) for f in SIZES]
    return np.asarray(np.logaddexp.reduce(sizes, axis=0) - np.log(len(SIZES)))
