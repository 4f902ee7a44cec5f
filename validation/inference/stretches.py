"""When was something different: stretches of time whose missing heat carries evidence, found without a further run.

With u, V the efficient score of the hats that the scan for missing heat has run, that of any course of heat w (W at the
knots) is w'u, w'V w: thousands of stretches are tried. Heat that a conductance would carry has w = -(T_i - T_j), at
both of its ends. Change points by Killick, Fearnhead and Eckley 2012 (PELT), by `ruptures` (Truong, Oudre and Vayatis
2020).
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from geom.arrays import Array
from measured.doubt import FORM, USUAL
from validation.calibration.calibrate import Fit
from validation.calibration.model_error import nodes
from validation.effects.build import conductance_scale, power_scale
from validation.effects.time_window import ALIKE, Event, Span
from validation.inference.evidence import Evidence
from validation.inference.hypotheses import stretch_count
from validation.inference.missing_heat import MissingHeat, Scan
from validation.inference.score import Score, average_size, fit_score

Pulse = tuple[Span, float]  # when, and its level (W) against what is usual in the test
PLACES = 4  # of most evidence, whose curves are searched for change points
PENALTY = 3.0  # times log(n) for a change point: BIC counts its time and its level, and a half more for either
CLEAR = 2.0  # standard deviations from which a level is a pulse
WHOLE = 0.9  # of a test: what lasts longer is a condition of that test, and no event
REPEATS = 20  # of one event


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


class Standing(NamedTuple):
    """An event that is there already, on a path.

    u, V : its score and variance;  pull : (n_hat,) covariance of every hat with it
    """

    event: Event
    u: float
    V: float
    pull: Array


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

    def evidence(self, u: Array, V: Array, path: Path) -> Array:
        """Log Bayes factors (nats) of amplitudes of either sign on a path, averaged over the usual sizes."""
        usual = FORM["heat size"] * USUAL["switched"] * (self.conductance_W_K if path.other else self.power_W)
        return average_size(u, np.maximum(V, 0.0), np.full(u.shape, usual), np.zeros(u.shape, int))

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

    @cached_property
    def _sums(self) -> dict[tuple[Path, str], tuple[Array, Array]]:
        """What `stretch_sums` has worked out: the search for repeats asks for it again and again."""
        return {}

    def stretch_sums(self, path: Path, test: str) -> tuple[Array, Array]:
        """Score and variance of a path that is open over stretches of a test's knots: every two edges i < j, one after
        the other as of `np.triu_indices`."""
        if (path, test) not in self._sums:
            ends, s = self.ends(path, test), self.score
            u = sum(heat * s.u[i] for i, heat in ends)
            V = sum(np.outer(a, b) * s.V[np.ix_(i, j)] for i, a in ends for j, b in ends)
            n = self.knots[test].size + 1
            U, P, (i, j) = np.append(0.0, np.cumsum(u)), np.zeros((n, n)), np.triu_indices(n, 1)
            P[1:, 1:] = np.cumsum(np.cumsum(V, axis=0), axis=1)
            self._sums[path, test] = U[j] - U[i], P[j, j] - P[i, j] - P[j, i] + P[i, i]
        return self._sums[path, test]

    def course(self, event: Event, path: Path) -> tuple[NDArray[np.int64], Array]:
        """Indices of the hats, and heat (W) in each, of a path of one unit that is open while an event lasts."""
        ends = [
            (i, heat * hat_overlap(self.knots[t], spans))
            for t, spans in event.spans.items()
            for i, heat in self.ends(path, t)
        ]
        return np.concatenate([i for i, _ in ends]), np.concatenate([w for _, w in ends])

    def sums(self, event: Event, path: Path) -> tuple[float, float]:
        """Score and variance of a path that is open while an event lasts, repeats with one amplitude."""
        (i, w), s = self.course(event, path), self.score
        return float(w @ s.u[i]), float(w @ s.V[np.ix_(i, i)] @ w)

    def standing(self, event: Event, path: Path) -> Standing:
        """The same, and what every hat has in common with it."""
        i, w = self.course(event, path)
        pull = self.score.V[:, i] @ w
        return Standing(event, float(w @ self.score.u[i]), float(w @ pull[i]), pull)

    def weigh(self, event: Event, path: Path) -> Interval:
        """The event with its evidence on a path."""
        u, V = self.sums(event, path)
        return Interval(event, path, float(self.evidence(np.array([u]), np.array([V]), path)[0]))


def hat_scores(evidence: Evidence, scan: Scan, values: Mapping[str, float]) -> HatScores:
    """The scan as an efficient score: calibration and model error projected out.  values : of the model's parameters"""
    fit, network = evidence.fit, evidence.fit.network
    scores = fit_score(fit, scan.segments(fit.parts), each_test=True)
    sizes = [len(scan.places) * k.size for k in scan.knots.values()]
    start = dict(zip(scan.knots, np.cumsum([0, *sizes]).tolist(), strict=False))
    T = {t.name: _temperatures(fit, evidence, t.name, scan.knots[t.name], values) for t in evidence.tests}
    return HatScores(scan.places, scan.knots, start, T, scores, power_scale(network), conductance_scale(network))


def _temperatures(
    fit: Fit, evidence: Evidence, name: str, times: Array, values: Mapping[str, float]
) -> dict[str, Array]:
    """Place or boundary -> degC at some times (s) of a test, by the fitted model."""
    test, network = next(t for t in evidence.tests if t.name == name), fit.network
    places = [p for p in network.places.values() if p.kind in ("part", "node", "fluid")]
    y = nodes(network, test, values, places)
    around = {b: np.broadcast_to(np.asarray(test.boundaries[b], float), test.time.shape) for b in network.boundaries}
    courses = {**{p.name: y[:, i] for i, p in enumerate(places)}, **around}
    return {place: np.interp(times, test.time, course) for place, course in courses.items()}


def hat_overlap(knots: Array, spans: Sequence[Span]) -> Array:
    """Share of each hat's reach (half a spacing to either side) that lies in a span."""
    half = 0.5 * (knots[1] - knots[0])
    inside = sum(np.clip(np.minimum(knots + half, b) - np.maximum(knots - half, a), 0.0, None) for a, b in spans)
    return np.clip((np.zeros_like(knots) + inside) / (2.0 * half), 0.0, 1.0)


def stretches(scores: HatScores, heat: Sequence[MissingHeat], near: Mapping[str, set[str]]) -> list[Interval]:
    """Candidate events, the most evident first; each keeps the path that explains it best."""
    paths = scores.paths(near)
    singles = sorted(
        (best_stretch(scores, p, test) for p in paths for test in scores.knots), key=lambda s: -s.log_bayes
    )
    first = singles[: PLACES * len(scores.knots)]
    again = [repeated(scores, s).event for s in first if s.log_bayes > 0.0]
    events = [*(s.event for s in first), *again, *(e for h in heat[:PLACES] for e in turning_events(h))]
    unique = {e.name: e for e in events if not lasts_throughout(scores, e)}.values()
    best = [max((scores.weigh(e, p) for p in paths), key=lambda s: s.log_bayes) for e in unique]
    return sorted(best, key=lambda s: -worth(scores, s))


def best_stretch(scores: HatScores, path: Path, test: str, others: Standing | None = None) -> Interval:
    """The stretch of knots with most evidence; all are tried, each a difference of cumulated sums.

    others : stretches that are there already, with the same amplitude; log_bayes is then that of all
    """
    (U, P), knots = scores.stretch_sums(path, test), scores.knots[test]
    i, j = np.triu_indices(knots.size + 1, 1)
    if others:
        cross = np.cumsum(sum(heat * others.pull[n] for n, heat in scores.ends(path, test)))
        cross = np.concatenate([[0.0], cross])
        U, P = U + others.u, P + others.V + 2.0 * (cross[j] - cross[i])
    bayes = scores.evidence(U, P, path)
    if others:
        covered = np.concatenate([[0.0], np.cumsum(hat_overlap(knots, others.event.spans.get(test, ())) > 0)])
        bayes = np.where(covered[j] > covered[i], -np.inf, bayes)
    best = int(np.argmax(bayes))
    return Interval(Event.of({test: [knot_span(knots, int(i[best]), int(j[best]))]}), path, float(bayes[best]))


def repeated(scores: HatScores, first: Interval) -> Interval:
    """A stretch and its repeats of one amplitude, one after another as long as each is worth saying when."""
    best = first
    for _ in range(REPEATS):
        there = scores.standing(best.event, first.path)
        more = max((best_stretch(scores, first.path, t, there) for t in scores.knots), key=lambda s: s.log_bayes)
        spans = {t: [*best.event.spans.get(t, ()), *more.event.spans.get(t, ())] for t in scores.knots}
        both = Interval(Event.of({t: pairs for t, pairs in spans.items() if pairs}), first.path, more.log_bayes)
        if not np.isfinite(more.log_bayes) or worth(scores, both) <= worth(scores, best):
            break
        best = both
    return best


def knot_span(knots: Array, first: int, stop: int) -> Span:
    """From half a spacing before a knot to half a spacing behind the last one before `stop`, inside the record."""
    half = 0.5 * (knots[1] - knots[0])
    return float(max(knots[first] - half, knots[0])), float(min(knots[stop - 1] + half, knots[-1]))


def turning_events(one: MissingHeat) -> list[Event]:
    """Each pulse of a place's curves, and those of one sign together, test by test and in all."""
    every = {test: pulses(*curve) for test, curve in one.heat_W.items()}
    events = [Event.of({test: [span]}) for test, each in every.items() for span, _ in each]
    for sign in (1.0, -1.0):
        alike = {t: [span for span, level in each if level * sign > 0] for t, each in every.items()}
        events += [Event.of({t: spans}) for t, spans in alike.items() if len(spans) > 1]
        if sum(len(spans) > 0 for spans in alike.values()) > 1:
            events.append(Event.of({t: spans for t, spans in alike.items() if spans}))
    return events


def pulses(knots: Array, q: Array, sd: Array) -> list[Pulse]:
    """Stretches in which a missing-heat curve stands on another level than most of the time.

    Parameters: `knots` (m,) s; `q`, `sd` (m,) heat and its standard deviation (W).
    """
    import ruptures

    if q.size < 4:
        return []
    noise = float(np.median(sd))
    ends = ruptures.Pelt(model="l2", min_size=1, jump=1).fit(q[:, None] / noise).predict(PENALTY * np.log(q.size))
    pieces = list(pairwise([0, *ends]))
    level = [float(np.mean(q[a:b])) for a, b in pieces]
    usual = float(np.median(np.repeat(level, [b - a for a, b in pieces])))
    clear = [(p, x - usual) for p, x in zip(pieces, level, strict=True) if abs(x - usual) > CLEAR * noise]
    return merged_pulses((knot_span(knots, a, b), x) for (a, b), x in clear)


def merged_pulses(pulses: Iterable[Pulse]) -> list[Pulse]:
    """Neighbouring pulses of one sign as one."""
    out: list[Pulse] = []
    for (a, b), x in pulses:
        if out and out[-1][0][1] >= a - 1e-6 and out[-1][1] * x > 0:
            (c, d), y = out[-1]
            out[-1] = ((c, b), (y * (d - c) + x * (b - a)) / (b - c))
        else:
            out.append(((a, b), x))
    return out


def lasts_throughout(scores: HatScores, event: Event) -> bool:
    """Does it last nearly all of its only test?"""
    test, *others = event.tests
    return not others and sum(b - a for a, b in event.every) > WHOLE * float(np.ptp(scores.knots[test]))


def worth(scores: HatScores, s: Interval) -> float:
    """Evidence less the price of when: the log of how many stretches there are among the knots, of the first in the
    test that has most of them."""
    usual = float(np.mean([b - a for a, b in s.event.every]))
    knots = sorted((scores.knots[t] for t, spans in s.event.spans.items() for _ in spans), key=lambda k: -k.size)
    counts = [stretch_count(k.size, usual / float(k[1] - k[0]) if n else None) for n, k in enumerate(knots)]
    return s.log_bayes - float(np.sum(np.log(counts)))


def distinct(by_worth: Sequence[Interval], most: int) -> list[Interval]:
    """The first of those that overlap."""
    out: list[Interval] = []
    for s in by_worth:
        if len(out) < most and all(s.event.overlap(t.event) < ALIKE for t in out):
            out.append(s)
    return out
