"""When exactly: the ends of events at the record's own samples, by the response to steps at each of them.

First by tangents about nothing; once an event is in the model at its size, about that state: a large one bends the
machine, so that by tangents of a model without it the ends are off by some samples. Beginning earlier is then the same
effect for a little longer, which is linear whatever the size.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import floor, log10

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from measured.case import Test
from measured.doubt import USUAL
from validation.calibration.calibrate import Fit
from validation.effects.base import Effect
from validation.effects.during import During
from validation.effects.time_window import Event, Span, lasts
from validation.inference.columns import amplitudes, effect_columns
from validation.inference.evidence import Evidence, joined
from validation.inference.hypotheses import REPORTED, Weighed, probabilities, stretch_count
from validation.inference.score import Score, average_size, fit_score

Array = NDArray[np.float64]
Values = Mapping[str, float]
Spans = Mapping[str, Sequence[Span]]
GRID_POINTS = 15  # instants around each end
MOVES = 3  # of the ends and refitting with them: by then they stand within a sample
FITTED = 4  # of the most probable refits: an event in any of them that will be told gets its ends anew


@dataclass(frozen=True)
class TimedEvent:
    """An event with its ends at the samples.

    log_share : log evidence of all ends over that of the best ones, less the price of there being so many
    ends : per span, test by test, 95 % of its begin and of its end (s)
    """

    event: Event
    log_share: float
    ends: tuple[tuple[Span, Span], ...]


def timed_event(
    evidence: Evidence, base: Effect, event: Event, reach_s: Mapping[str, float], values: Values
) -> TimedEvent:
    """The event with the ends of every span at the samples in turn, the others where they are.

    Parameters: `base` the effect that it is taken for; `reach_s` test -> how far (s) an end may move.
    """
    spans, log_share = {t: list(pairs) for t, pairs in event.spans.items()}, 0.0
    ends: list[tuple[Span, Span]] = []
    usual = float(np.mean([b - a for a, b in event.every]))
    tests = {t.name: t for t in evidence.tests}
    for test, pairs in event.spans.items():
        for i in range(len(pairs)):
            others = {t: [s for k, s in enumerate(all_) if (t, k) != (test, i)] for t, all_ in spans.items()}
            length = usual if ends else None
            one = timed_span(evidence, base, tests[test], pairs[i], others, reach_s[test], values, length)
            spans[test][i] = one.event.spans[test][0]
            log_share += one.log_share
            ends += one.ends
    return TimedEvent(Event.of(spans), log_share, tuple(ends))


def timed_span(
    evidence: Evidence,
    base: Effect,
    test: Test,
    span: Span,
    others: Spans,
    reach_s: float,
    values: Values,
    usual_s: float | None = None,
) -> TimedEvent:
    """Begin and end of one span: every two instants around them, each pair a difference of two steps.

    usual_s : how long its repeats last, None for the first of them
    """
    begins, ends = instants_around(test, span[0], reach_s), instants_around(test, span[1], reach_s)
    at = np.concatenate([begins, ends])
    step_u, step_V = step_scores(evidence.fit, evidence.tests, base, test, at, values, others)
    a, b = (x.ravel() for x in np.meshgrid(np.arange(begins.size), np.arange(begins.size, at.size), indexing="ij"))
    a, b = a[at[a] < at[b]], b[at[a] < at[b]]
    u, V = pulse_scores(step_u, step_V, a, b)
    usual = USUAL["switched"] * amplitudes(evidence.fit.network, [base])[-1].prior_sd
    bayes = average_size(u, np.maximum(V, 0.0), np.full(u.shape, usual), np.full(u.shape, base.sign))
    best, weight = int(np.argmax(bayes)), np.exp(bayes - logsumexp(bayes))
    step = float(np.median(np.diff(test.time)))
    count = stretch_count(test.time.size, None if usual_s is None else usual_s / step)
    event = Event.of({test.name: [(at[a[best]], at[b[best]])]})
    share = float(logsumexp(bayes - bayes[best]) - np.log(count))
    return TimedEvent(event, share, ((central_span(at[a], weight), central_span(at[b], weight)),))


def pulse_scores(u: Array, V: Array, a: NDArray[np.int64], b: NDArray[np.int64]) -> tuple[Array, Array]:
    """Score and variance of what begins at a and ends at b, with the last column, that of the other spans."""
    rest = u.size - 1
    variance = V[a, a] + V[b, b] - 2.0 * V[a, b]
    return u[a] - u[b] + u[rest], variance + V[rest, rest] + 2.0 * (V[a, rest] - V[b, rest])


def step_scores(
    fit: Fit, tests: Sequence[Test], base: Effect, test: Test, at: Array, values: Values, others: Spans
) -> tuple[Array, Array]:
    """Efficient score (n,) and its covariance of an effect that begins at each of n - 1 instants (s) of a test and
    lasts; the last is that of the other spans, 0 without any. Instants may be the same: each is run once."""
    last = float(test.time[-1]) + 1.0
    instants, where = np.unique(at, return_inverse=True)
    events = [Event.of({test.name: [(t, last)]}) for t in instants]
    rest = Event.of({t: pairs for t, pairs in others.items() if pairs})
    effects = [During.of(base, e.name) for e in (*events, *([rest] if rest.spans else []))]
    s = fit_score(fit, effect_columns(fit, tests, effects, values))
    missing, order = 0 if rest.spans else 1, np.append(where, instants.size)
    return np.pad(s.u, (0, missing))[order], np.pad(s.V, (0, missing))[np.ix_(order, order)]


def predicted_repeats(evidence: Evidence, base: Effect, event: Event, values: Values) -> Event:
    """The event without the repeats that the others do not predict; of one that does not repeat nothing is left out.

    Each is left out in turn: at the amplitude of the others it must fit better than without. The worst goes first.
    """
    every = [(t, span) for t, pairs in event.spans.items() for span in pairs]
    if len(every) < 2:
        return event
    effects = [During.of(base, Event.of({t: [span]}).name) for t, span in every]
    scores = fit_score(evidence.fit, effect_columns(evidence.fit, evidence.tests, effects, values))
    stays = list(range(len(every)))
    while len(stays) > 1 and min(gain := [repeat_gain(scores, i, stays) for i in stays]) <= 0.0:
        stays.remove(stays[int(np.argmin(gain))])
    spans: dict[str, list[Span]] = {}
    for i in stays:
        spans.setdefault(every[i][0], []).append(every[i][1])
    return Event.of(spans)


def repeat_gain(scores: Score, i: int, every: Sequence[int]) -> float:
    """Log likelihood that a repeat gains at the amplitude of the others."""
    others = [j for j in every if j != i]
    felt = float(np.sum(scores.V[np.ix_(others, others)]))
    if felt <= 0.0:  # the others move no reading: they predict nothing
        return 0.0
    a = float(np.sum(scores.u[others])) / felt
    return a * (float(scores.u[i]) - a * float(np.sum(scores.V[i, others]))) - 0.5 * a**2 * float(scores.V[i, i])


def instants_around(test: Test, at: float, reach_s: float) -> Array:
    """Instants (s) near an instant, whole steps from the record's begin on and inside of it.

    To a hundredth of a step at least: names of events hold them, and no reading knows more.
    """
    t, step = test.time, float(np.median(np.diff(test.time)))
    low, high = max(at - reach_s, t[0]), min(at + reach_s, t[-1])
    count = int(min(GRID_POINTS, round((high - low) / step) + 1))
    whole = t[0] + step * np.round((np.linspace(low, high, max(count, 1)) - t[0]) / step)
    return np.unique(np.clip(np.round(whole, 2 - floor(log10(step))), t[0], t[-1]))


def central_span(at: Array, weight: Array) -> Span:
    """95 % of a weighted sample."""
    order = np.argsort(at)
    low, high = np.searchsorted(np.cumsum(weight[order]), [0.025, 0.975])
    return float(at[order[low]]), float(at[order[min(high, at.size - 1)]])


def retimed(
    evidence: Evidence,
    hypotheses: Sequence[Weighed],
    reach_s: Mapping[str, float],
    refit: Callable[[Evidence, Weighed], Weighed],
) -> Evidence:
    """The evidence with the ends of its most probable events moved to where their refits want them, again and again
    until none moves; itself where none does.

    Parameters: `reach_s` test -> how far (s) an end may move at once; `refit` fits a hypothesis anew, to its end.
    """
    P = probabilities(hypotheses, 1.0)
    order = [hypotheses[i] for i in np.argsort(-P, kind="stable") if P[i] > REPORTED]
    few = [h for h in order if h.fit and h.members][:FITTED]
    for _ in range(MOVES):
        new = moved_events(evidence, few, reach_s)
        if not new:
            break
        priors: dict[Effect, float] = {e: evidence.causes[k].log_prior for k, e in new.items()}
        evidence = joined(evidence, priors, evidence.fit.values, list(new))
        few = [refit(evidence, h) if set(h.members) & set(new) else h for h in few]
    return evidence


def moved_events(evidence: Evidence, hypotheses: Sequence[Weighed], reach_s: Mapping[str, float]) -> dict[int, During]:
    """Events whose refits want other ends, with these."""
    new: dict[int, During] = {}
    for h in hypotheses:
        for k in h.members:
            effect = evidence.effects[k]
            if k in new or not isinstance(effect, During) or not effect.event or throughout(evidence, effect.event):
                continue
            if h.fit is not None and effect.name in h.fit.values:  # else the machine ran away with the new ends
                event = refit_ends(evidence, h.fit, effect, effect.event, reach_s)
                new[k] = During.of(effect.base, event.name)
    others = {e.name for k, e in enumerate(evidence.effects) if k not in new}
    new = {k: e for k, e in new.items() if e.name != evidence.names[k] and e.name not in others}
    names = [e.name for e in new.values()]
    return {k: e for k, e in new.items() if names.count(e.name) == 1}


def throughout(evidence: Evidence, event: Event) -> bool:
    """Does it last all of its tests?  Then it has no ends."""
    return all(lasts(event.name, t) for t in evidence.tests if t.name in event.spans)


def refit_ends(evidence: Evidence, fit: Fit, effect: During, event: Event, reach_s: Mapping[str, float]) -> Event:
    """The event with the ends that fit best about a refit, every span in turn, the others where they are."""
    tests = {t.name: t for t in evidence.tests}
    spans = {t: [refit_span(fit, effect, tests[t], s, reach_s[t]) for s in each] for t, each in event.spans.items()}
    return Event.of(spans)


def refit_span(fit: Fit, effect: During, test: Test, span: Span, reach_s: float) -> Span:
    """Begin and end that fit best: first some instants around them, then every sample around the best of these."""
    best, a = span, fit.values[effect.name]
    a = a / (1.0 + a) if effect.base.mapping == "relative" else a  # one more piece of it: factors multiply, others add
    for reach in (reach_s, 2.0 * reach_s / GRID_POINTS):
        begins, ends = instants_around(test, best[0], reach), instants_around(test, best[1], reach)
        at = np.concatenate([span, begins, ends])
        u, V = step_scores(fit, [test], effect.base, test, at, fit.values, {})
        i, j = np.meshgrid(2 + np.arange(begins.size), 2 + begins.size + np.arange(ends.size), indexing="ij")
        gain = moved_gain(u, V, a, i.ravel(), j.ravel())
        gain[(begins[:, None] >= ends[None, :]).ravel()] = -np.inf
        k = int(np.argmax(gain))
        if gain[k] > 0.0:
            best = float(begins[k // ends.size]), float(ends[k % ends.size])
    return best


def moved_gain(u: Array, V: Array, a: float, i: NDArray[np.int64], j: NDArray[np.int64]) -> Array:
    """(n,) log likelihood gained by a begin at instant i and an end at j in place of the instants 0 and 1."""
    first = a * (u[i] - u[0]) - a * (u[j] - u[1])
    d, rows = np.zeros((i.size, u.size)), np.arange(i.size)
    for at, sign in ((i, 1.0), (np.zeros_like(i), -1.0), (j, -1.0), (np.ones_like(j), 1.0)):
        np.add.at(d, (rows, at), sign * a)
    return np.asarray(first - 0.5 * np.sum((d @ V) * d, axis=1))
