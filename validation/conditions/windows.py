"""When was heat missing: change points of the missing-heat curves, and the stretch with most evidence of each path.

Source: Killick, Fearnhead and Eckley 2012 (PELT), by `ruptures` (Truong, Oudre and Vayatis 2020).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from validation.conditions.hat_functions import HatScores, Interval, Path, log_bayes, overlap
from validation.effects.time_window import Event, Span
from validation.inference.missing_heat import MissingHeat

Array = NDArray[np.float64]
Pulse = tuple[Span, float]  # when, and its level (W) against what is usual in the test
PLACES = 4  # of most evidence, whose curves are searched for change points
PENALTY = 3.0  # times log(n) for a change point: BIC counts its time and its level, and a half more for either
CLEAR = 2.0  # standard deviations from which a level is a pulse
WHOLE = 0.9  # of a test: what lasts longer is a condition of that test, and no event
REPEATS = 20  # of one event
LENGTHS = 0.5  # of its length, within which repeats of one event differ: a lid is opened for the same work
ALIKE = 0.5  # of the time in either of two events is in both: such are one


def stretches(scores: HatScores, heat: Sequence[MissingHeat], near: Mapping[str, set[str]]) -> list[Interval]:
    """Candidate events, the most evident first; each keeps the path that explains it best."""
    paths = scores.paths(near)
    singles = sorted(
        (best_stretch(scores, p, test) for p in paths for test in scores.knots), key=lambda s: -s.log_bayes
    )
    first = singles[: PLACES * len(scores.knots)]
    repeats = [repeated(scores, s).event for s in first if s.log_bayes > 0.0]
    events = [*(s.event for s in first), *repeats, *(e for h in heat[:PLACES] for e in turns(h))]
    unique = {e.name: e for e in events if not throughout(scores, e)}.values()
    best = [max((scores.weigh(e, p) for p in paths), key=lambda s: s.log_bayes) for e in unique]
    return sorted(best, key=lambda s: -worth(scores, s))


def best_stretch(scores: HatScores, path: Path, test: str, beside: Event | None = None) -> Interval:
    """The stretch of knots with most evidence; all are tried, each a difference of cumulated sums.

    beside : stretches that are there already, with the same amplitude; log_bayes is then that of all
    """
    (u, V), knots = scores.at_knots(path, test), scores.knots[test]
    U, P = np.concatenate([[0.0], np.cumsum(u)]), np.zeros((u.size + 1, u.size + 1))
    P[1:, 1:] = np.cumsum(np.cumsum(V, axis=0), axis=1)
    i, j = np.triu_indices(u.size + 1, 1)
    U, P = U[j] - U[i], P[j, j] - P[i, j] - P[j, i] + P[i, i]
    if beside:
        linear, square, cross = scores.sums(beside, path, test)
        cross = np.concatenate([[0.0], np.cumsum(cross)])
        U, P = U + linear, P + square + 2.0 * (cross[j] - cross[i])
    bayes = log_bayes(U, P, scores.usual(path))
    if beside:
        covered = np.concatenate([[0.0], np.cumsum(overlap(knots, beside.spans.get(test, ())) > 0)])
        bayes = np.where(covered[j] > covered[i], -np.inf, bayes)
    k = int(np.argmax(bayes))
    return Interval(Event.of({test: [span_of(knots, int(i[k]), int(j[k]))]}), path, float(bayes[k]))


def repeated(scores: HatScores, first: Interval) -> Interval:
    """A stretch and its repeats of one amplitude, one after another as long as each is worth saying when."""
    best = first
    for _ in range(REPEATS):
        more = max((best_stretch(scores, first.path, t, best.event) for t in scores.knots), key=lambda s: s.log_bayes)
        spans = {t: [*best.event.spans.get(t, ()), *more.event.spans.get(t, ())] for t in scores.knots}
        both = Interval(Event.of({t: pairs for t, pairs in spans.items() if pairs}), first.path, more.log_bayes)
        if not np.isfinite(more.log_bayes) or worth(scores, both) <= worth(scores, best):
            break
        best = both
    return best


def span_of(knots: Array, first: int, stop: int) -> Span:
    """From half a spacing before a knot to half a spacing behind the last one before `stop`, inside the record."""
    half = 0.5 * (knots[1] - knots[0])
    return float(max(knots[first] - half, knots[0])), float(min(knots[stop - 1] + half, knots[-1]))


def turns(one: MissingHeat) -> list[Event]:
    """Each pulse of a place's curves, and those of one sign together, test by test and in all."""
    pulses_of = {test: pulses(*curve) for test, curve in one.heat_W.items()}
    events = [Event.of({test: [span]}) for test, every in pulses_of.items() for span, _ in every]
    for sign in (1.0, -1.0):
        alike = {t: [span for span, level in every if level * sign > 0] for t, every in pulses_of.items()}
        events += [Event.of({t: spans}) for t, spans in alike.items() if len(spans) > 1]
        if sum(len(spans) > 0 for spans in alike.values()) > 1:
            events.append(Event.of({t: spans for t, spans in alike.items() if spans}))
    return events


def pulses(knots: Array, q: Array, sd: Array) -> list[Pulse]:
    """Stretches in which a missing-heat curve stands on another level than most of the time."""
    import ruptures

    if q.size < 4:
        return []
    noise = float(np.median(sd))
    ends = ruptures.Pelt(model="l2", min_size=1, jump=1).fit(q[:, None] / noise).predict(PENALTY * np.log(q.size))
    pieces = list(pairwise([0, *ends]))
    level = [float(np.mean(q[a:b])) for a, b in pieces]
    usual = float(np.median(np.repeat(level, [b - a for a, b in pieces])))
    clear = [(p, x - usual) for p, x in zip(pieces, level, strict=True) if abs(x - usual) > CLEAR * noise]
    return joined((span_of(knots, a, b), x) for (a, b), x in clear)


def joined(pulses: Iterable[Pulse]) -> list[Pulse]:
    """Neighbouring pulses of one sign as one."""
    out: list[Pulse] = []
    for (a, b), x in pulses:
        if out and out[-1][0][1] >= a - 1e-6 and out[-1][1] * x > 0:
            (c, d), y = out[-1]
            out[-1] = ((c, b), (y * (d - c) + x * (b - a)) / (b - c))
        else:
            out.append(((a, b), x))
    return out


def throughout(scores: HatScores, event: Event) -> bool:
    """Does it last nearly all of its only test?"""
    test, *others = event.tests
    return not others and sum(b - a for a, b in event.every) > WHOLE * float(np.ptp(scores.knots[test]))


def worth(scores: HatScores, s: Interval) -> float:
    """Evidence less the price of when: the log of how many stretches there are among the knots."""
    first, price = True, 0.0
    usual = float(np.mean([b - a for a, b in s.event.every]))
    for test, pairs in s.event.spans.items():
        knots = scores.knots[test]
        for _ in pairs:
            price += float(np.log(ways(knots.size, None if first else usual / float(knots[1] - knots[0]))))
            first = False
    return s.log_bayes - price


def ways(n: int, usual: float | None) -> float:
    """How many stretches there are among n instants; repeats of one that is as long as `usual` (in instants) last about
    as long, and begin anywhere."""
    return 0.5 * n * (n + 1) if usual is None else n * max(1.0, LENGTHS * usual)


def distinct(by_worth: Sequence[Interval], most: int) -> list[Interval]:
    """The first of those that overlap."""
    out: list[Interval] = []
    for s in by_worth:
        if len(out) < most and all(s.event.overlap(t.event) < ALIKE for t in out):
            out.append(s)
    return out
