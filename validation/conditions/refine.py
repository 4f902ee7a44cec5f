"""When exactly: an event's ends at the record's own samples, by the response to steps at each of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import floor, log10

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from lumped.model.multipliers import parameter_values
from measured.case import Test
from measured.doubt import SIZES, USUAL
from validation.comparison.linearisation import Segment, segments
from validation.conditions.windows import ways
from validation.effects import Effect, extended
from validation.effects.during import During
from validation.effects.time_window import Event, Span
from validation.inference.evidence import Evidence, extended_prior, projected, weighed
from validation.inference.score import Score, one_size, score, total

Array = NDArray[np.float64]
Values = Mapping[str, float]
Spans = Mapping[str, Sequence[Span]]
GRID_POINTS = 15  # instants around each end


@dataclass(frozen=True)
class TimedEvent:
    """An event with its ends at the samples.

    log_share : log evidence of all ends over that of the best ones, less the price of there being so many
    ends : per span, test by test, 95 % of its begin and of its end (s)
    """

    event: Event
    log_share: float
    ends: tuple[tuple[Span, Span], ...]


def refined(evidence: Evidence, base: Effect, event: Event, reach_s: Mapping[str, float], values: Values) -> TimedEvent:
    """Ends of every span in turn, the others where they are.  reach_s : test -> how far an end may move"""
    spans, log_share = {t: list(pairs) for t, pairs in event.spans.items()}, 0.0
    ends: list[tuple[Span, Span]] = []
    usual = float(np.mean([b - a for a, b in event.every]))
    tests = {t.name: t for t in evidence.tests}
    for test, pairs in event.spans.items():
        for i in range(len(pairs)):
            others = {t: [s for k, s in enumerate(all_) if (t, k) != (test, i)] for t, all_ in spans.items()}
            one = moved(evidence, base, tests[test], pairs[i], others, reach_s[test], values, usual if ends else None)
            spans[test][i] = one.event.spans[test][0]
            log_share += one.log_share
            ends += one.ends
    return TimedEvent(Event.of(spans), log_share, tuple(ends))


def moved(
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
    begins, ends = around(test, span[0], reach_s), around(test, span[1], reach_s)
    at = np.concatenate([begins, ends])
    u, V = steps(evidence, base, test, at, others, values)
    a, b = (x.ravel() for x in np.meshgrid(np.arange(begins.size), np.arange(begins.size, at.size), indexing="ij"))
    a, b = a[at[a] < at[b]], b[at[a] < at[b]]
    bayes = log_bayes(*pulse(u, V, a, b), evidence, base)
    best, weight = int(np.argmax(bayes)), np.exp(bayes - logsumexp(bayes))
    step = float(np.median(np.diff(test.time)))
    count = ways(test.time.size, None if usual_s is None else usual_s / step)
    event = Event.of({test.name: [(at[a[best]], at[b[best]])]})
    return TimedEvent(
        event,
        float(logsumexp(bayes - bayes[best]) - np.log(count)),
        ((between(at[a], weight), between(at[b], weight)),),
    )


def pulse(u: Array, V: Array, a: NDArray[np.int64], b: NDArray[np.int64]) -> tuple[Array, Array]:
    """Score and variance of what begins at a and ends at b, with the last column beside it."""
    rest = u.size - 1
    variance = V[a, a] + V[b, b] - 2.0 * V[a, b]
    return u[a] - u[b] + u[rest], variance + V[rest, rest] + 2.0 * (V[a, rest] - V[b, rest])


def repeats(evidence: Evidence, base: Effect, event: Event, values: Values) -> Event:
    """The event without the repeats that the others do not predict; of one that does not repeat nothing is left out.

    Each is left out in turn: at the amplitude of the others it must fit better than without. The worst goes first.
    """
    every = [(t, span) for t, pairs in event.spans.items() for span in pairs]
    if len(every) < 2:
        return event
    effects = [During.of(base, Event.of({t: [span]}).name) for t, span in every]
    theta, sd = extended_prior(evidence.fit)
    parts = columns(evidence, effects, values)
    scores = score(total(projected(evidence.fit, parts)), theta, sd, np.zeros(len(every), int))
    stays = list(range(len(every)))
    while len(stays) > 1 and min(gain := [gained(scores, i, stays) for i in stays]) <= 0.0:
        stays.remove(stays[int(np.argmin(gain))])
    spans: dict[str, list[Span]] = {}
    for i in stays:
        spans.setdefault(every[i][0], []).append(every[i][1])
    return Event.of(spans)


def gained(scores: Score, i: int, every: Sequence[int]) -> float:
    """Log likelihood that a repeat gains at the amplitude of the others."""
    others = [j for j in every if j != i]
    felt = float(np.sum(scores.V[np.ix_(others, others)]))
    if felt <= 0.0:  # the others move no reading: they predict nothing
        return 0.0
    a = float(np.sum(scores.u[others])) / felt
    return a * (float(scores.u[i]) - a * float(np.sum(scores.V[i, others]))) - 0.5 * a**2 * float(scores.V[i, i])


def log_bayes(u: Array, V: Array, evidence: Evidence, base: Effect) -> Array:
    """Log Bayes factors of an effect at many times."""
    sd = np.full(u.shape, USUAL["switched"] * base.extend(evidence.fit.network).parameters[-1].prior_sd)
    sign = np.full(u.shape, base.sign)
    sizes = [one_size(u, np.maximum(V, 0.0), f * sd, sign) for f in SIZES]
    return np.asarray(logsumexp(sizes, axis=0) - np.log(len(SIZES)))


def around(test: Test, at: float, reach_s: float) -> Array:
    """Instants near an instant, whole steps from the record's begin on and inside of it.

    To a hundredth of a step at least: names of events hold them, and no reading knows more.
    """
    t, step = test.time, float(np.median(np.diff(test.time)))
    low, high = max(at - reach_s, t[0]), min(at + reach_s, t[-1])
    count = int(min(GRID_POINTS, round((high - low) / step) + 1))
    whole = t[0] + step * np.round((np.linspace(low, high, max(count, 1)) - t[0]) / step)
    return np.unique(np.clip(np.round(whole, 2 - floor(log10(step))), t[0], t[-1]))


def between(at: Array, weight: Array) -> Span:
    """95 % of a weighted sample."""
    order = np.argsort(at)
    low, high = np.searchsorted(np.cumsum(weight[order]), [0.025, 0.975])
    return float(at[order[low]]), float(at[order[min(high, at.size - 1)]])


def steps(
    evidence: Evidence, base: Effect, test: Test, at: Array, others: Spans, values: Values
) -> tuple[Array, Array]:
    """Efficient score of an effect that begins at each of some instants of a test, and last that of the other spans."""
    last = float(test.time[-1]) + 1.0
    events = [Event.of({test.name: [(t, last)]}) for t in at]
    rest = Event.of({t: pairs for t, pairs in others.items() if pairs})
    effects = [During.of(base, e.name) for e in (*events, *([rest] if rest.spans else []))]
    parts = columns(evidence, effects, values)
    theta, sd = extended_prior(evidence.fit)
    scores = score(total(projected(evidence.fit, parts)), theta, sd, np.zeros(len(effects), int))
    missing = 0 if rest.spans else 1
    return np.pad(scores.u, (0, missing)), np.pad(scores.V, (0, missing))


def columns(evidence: Evidence, effects: Sequence[Effect], base_values: Values) -> list[Segment]:
    """The segments with the columns of calibration and of some effects; only tests are run in which one acts."""
    fit, p = evidence.fit, evidence.p
    network = extended(fit.network, effects)
    amplitudes = network.parameters[-len(effects) :]
    values = {**parameter_values(network, base_values), **fit.values}
    parts = segments(network, [t for t in evidence.tests if any(acts_in(e, t) for e in effects)], values, amplitudes)
    new = {(s.test, s.channel): s.J for s in parts}
    return [
        replace(s, J=np.column_stack([s.J[:, :p], new.get((s.test, s.channel), np.zeros((s.r.size, len(amplitudes))))]))
        for s in evidence.parts
    ]


def acts_in(effect: Effect, test: Test) -> bool:
    """Can the effect act in the test?  What an input says may be in any."""
    return not isinstance(effect, During) or test.name in effect.tests or effect.condition in test.inputs


def joined(evidence: Evidence, effects: Sequence[Effect], values: Mapping[str, float]) -> Evidence:
    """The evidence with further effects behind its own."""
    if not effects:
        return evidence
    e, fit, p = evidence, evidence.fit, evidence.p
    network = extended(e.network, effects)
    parameters = (*e.parameters, *network.parameters[-len(effects) :])
    new = columns(evidence, effects, values)
    parts = tuple(replace(s, J=np.column_stack([s.J, n.J[:, p:]])) for s, n in zip(e.parts, new, strict=True))
    return weighed(e.tests, fit, network, (*e.effects, *effects), parameters, parts, e.jumps, e.large)
