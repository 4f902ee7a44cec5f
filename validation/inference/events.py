"""When exactly: the ends of events at the record's own samples, by the response to steps at each of them.

First by tangents about nothing; once an event is in the model at its size, about that state: a large one bends the
machine, so that by tangents of a model without it the ends are off by some samples. Beginning earlier is then the same
effect for a little longer, which is linear whatever the size.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import floor, log10
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from geom.arrays import Array, sample_columns
from geom.errors import NoSolution
from lumped.model.multipliers import parameter_values
from lumped.model.network import Network
from lumped.transfer.laws import Law, Wrapped
from measured.case import Test
from measured.doubt import USUAL
from measured.sensors.blocks import groups
from validation.calibration.calibrate import Fit, Iterate, bounded_step, minimise
from validation.comparison.linearisation import segments
from validation.effects.base import Effect
from validation.effects.build import Shaped
from validation.effects.during import During
from validation.effects.registry import extended
from validation.effects.sensors.reading_fault import ReadingFault
from validation.effects.time_window import AND, Event, Span, TimeWindow, lasts
from validation.inference.columns import amplitudes, effect_columns
from validation.inference.evidence import ENOUGH, Evidence, joined
from validation.inference.hypotheses import (
    LENGTHS,
    REPORTED,
    WHEN_S,
    Weighed,
    is_rare,
    probabilities,
    repeat_price,
    sample_step,
    timing_step,
)
from validation.inference.score import Gram, Score, average_size, fit_gram, fit_prior, fit_score, score
from validation.noise import Noise
from validation.parameters.unknowns import Unknowns
from validation.threads import side_by_side

Values = Mapping[str, float]
GRID_POINTS = 15  # instants around each end
COARSEST = 4.0  # timing steps between instants that tell one stretch from another; what carries weight is timed closer
DIRECTIONS = ((1, 0), (0, 1), (1, 1))  # begin, end, both
STEERED = 10.0  # timing steps that ends may be moved by their tangents at once
STEERS, LEAST_DAMPING = 20, 0.01  # steps of all ends together, and share of the curvature from which one is damped
ELSEWHERE = 1.5  # times the size of before, beyond which ends are looked for far away again
MOVES = 8  # of the ends and refitting with them: of a size that was ten times off at first five were needed
RIVALS, HALF = 2, 0.5  # that are not likely yet: how many get their ends anew, and what they explain of the most
FITTED = 4  # of the most probable refits: an event in any of them that will be told gets its ends anew
MOST_KNOTS = 96  # instants at which a repeat may begin at first: each is a column of one run
FIRST_RUNS = 4  # stretches that tangents like best are run


@dataclass(frozen=True)
class TimedEvent:
    """An event with its ends at the samples.

    log_area : test and stretch -> log evidence of all its ends over that of the best ones, each for the time (s^2) that
    it stands for;  length_s : test -> how long its record is (s)
    """

    event: Event
    log_area: Mapping[tuple[str, Span], float]
    length_s: Mapping[str, float]

    @property
    def log_share(self) -> float:
        """Of its longest stretch, less the price of there being so many."""
        return self._log_shares[0]

    @property
    def repeats(self) -> float:
        """The same of the others."""
        return sum(self._log_shares[1:])

    @property
    def _log_shares(self) -> list[float]:
        usual = float(np.mean([b - a for a, b in self.event.every]))
        longest = sorted(((t, s) for t, pairs in self.event.spans.items() for s in pairs), key=lambda x: -np.ptp(x[1]))
        half = [(0.5 * self.length_s[t] if n == 0 else LENGTHS * usual) for n, (t, _) in enumerate(longest)]
        every = [self.length_s[t] * max(WHEN_S, h) for h, (t, _) in zip(half, longest, strict=True)]  # s^2
        return [self.log_area[x] - float(np.log(area)) for x, area in zip(longest, every, strict=True)]


def timed_event(
    evidence: Evidence, base: Effect, event: Event, reach_s: Mapping[str, float], values: Values
) -> TimedEvent:
    """The event with the ends of every span at the samples in turn, the longest first, the others where they are.

    Parameters: `base` the effect that it is taken for; `reach_s` test -> how far (s) an end may move.
    """
    spans, log_area = {t: list(pairs) for t, pairs in event.spans.items()}, dict[tuple[str, Span], float]()
    fit, tests = evidence.fit, {t.name: t for t in evidence.tests}
    grams = event_grams(fit, evidence.tests, base, event, values)
    every = [(t, i) for t, pairs in spans.items() for i in range(len(pairs))]
    order = sorted(every, key=lambda at: -float(np.ptp(spans[at[0]][at[1]])))
    for n, (test, i) in enumerate(order):
        others = [s for k, s in enumerate(spans[test]) if k != i]
        elsewhere = [g for t, g in grams.items() if t != test]
        span, area = timed_span(fit, base, tests[test], spans[test][i], others, elsewhere, reach_s[test], values)
        spans[test][i], log_area[test, span] = span, area
        if any(later != test for later, _ in order[n + 1 :]):  # whose ends these are beside
            grams |= event_grams(fit, [tests[test]], base, Event.of({test: spans[test]}), values)
    return TimedEvent(Event.of(spans), log_area, {t: float(np.ptp(tests[t].time)) for t in spans})


def event_grams(fit: Fit, tests: Sequence[Test], base: Effect, event: Event, values: Values) -> dict[str, Gram]:
    """Test -> the Gram matrix of an effect that holds while an event lasts."""
    here = one_test(fit, tests[0].name) if len(tests) == 1 else fit
    return fit_gram(here, effect_columns(here, tests, [During.of(base, event.name)], values))


def one_test(fit: Fit, test: str) -> Fit:
    """The fit with the segments of one test."""
    return replace(fit, parts=tuple(s for s in fit.parts if s.test == test))


def timed_span(
    fit: Fit,
    base: Effect,
    test: Test,
    span: Span,
    others: Sequence[Span],
    elsewhere: Sequence[Gram],
    reach_s: float,
    values: Values,
) -> tuple[Span, float]:
    """Begin and end of one span: every two instants around them, each pair a difference of two steps; again around the
    best of these, until the instants are about as close as samples. And its log area, as of `TimedEvent`: all ends have
    one density per second, whatever the rows.

    Parameters: `others` the event's other spans in the test; `elsewhere` what it does in the other tests.
    """
    usual, step = USUAL["switched"] * amplitudes(fit.network, [base])[-1].prior_sd, timing_step(test)
    while True:
        begins, ends = instants_around(test, span[0], reach_s), instants_around(test, span[1], reach_s)
        at = np.concatenate([begins, ends])
        closer, near = closer_look(fit, test, span, reach_s, values)
        step_u, step_V = step_scores(one_test(closer, test.name), base, near, at, values, others, elsewhere)
        a, b = (x.ravel() for x in np.meshgrid(np.arange(begins.size), np.arange(begins.size, at.size), indexing="ij"))
        a, b = a[at[a] < at[b]], b[at[a] < at[b]]
        u, V = pulse_scores(step_u, step_V, a, b)
        bayes = average_size(u, np.maximum(V, 0.0), np.full(u.shape, usual), np.full(u.shape, base.sign))
        best = int(np.argmax(bayes))
        span, reach_s = (float(at[a[best]]), float(at[b[best]])), next_reach(reach_s)
        if reach_s <= COARSEST * step:
            break
    area = np.log(time_around(begins))[a] + np.log(time_around(ends))[b - begins.size]
    return span, float(logsumexp(bayes - bayes[best] + area))


def time_around(instants: Array) -> Array:
    """Time (s) that each of some instants stands for."""
    return np.gradient(instants) if instants.size > 1 else np.full(1, WHEN_S)


def next_reach(reach_s: float) -> float:
    """How far (s) an end may lie from the best of the instants that were tried within a reach."""
    return 2.0 * reach_s / GRID_POINTS


def closer_look(fit: Fit, test: Test, instants: Sequence[float], reach_s: float, values: Values) -> tuple[Fit, Test]:
    """The fit and the test with readings around the ends of spans in blocks as short as the instants that are tried
    there; as they are, where the blocks of the fit are short enough.

    values : of what is not calibrated
    """
    near = finer_blocks(test, instants, reach_s)
    if near is test:
        return fit, test
    state = {**parameter_values(fit.network, values), **fit.values}
    new = {s.channel: s for s in segments(fit.network, [near], state, fit.unknowns.parameters)}
    old = {s.channel: s for s in fit.parts if s.test == test.name}
    error = fit.error
    if error:
        columns = {(test.name, c): sample_columns(s.time, old[c].time, error.of(old[c])) for c, s in new.items()}
        error = replace(error, columns={**error.columns, **columns})
    parts = tuple(new.get(s.channel, s) if s.test == test.name else s for s in fit.parts)
    return replace(fit, parts=parts, error=error), near


def finer_blocks(test: Test, instants: Sequence[float], reach_s: float) -> Test:
    """The test with its readings there in such blocks; itself, where they are short enough."""
    n, step = test.time.size, sample_step(test)
    start, fine = groups(n), max(round(next_reach(reach_s) / step), 1)
    if test.blocks is not None or 2 * fine > start[min(1, start.size - 1)]:
        return test
    first = np.zeros(n, bool)
    first[start] = True
    for at in instants:
        low, high = np.searchsorted(test.time, [at - reach_s, at + reach_s])
        first[low:high:fine] = True
    return replace(test, blocks=np.flatnonzero(first))


def pulse_scores(u: Array, V: Array, a: NDArray[np.int64], b: NDArray[np.int64]) -> tuple[Array, Array]:
    """Score and variance of what begins at a and ends at b, with the last column, that of the other spans."""
    rest = u.size - 1
    variance = V[a, a] + V[b, b] - 2.0 * V[a, b]
    return u[a] - u[b] + u[rest], variance + V[rest, rest] + 2.0 * (V[a, rest] - V[b, rest])


def step_scores(
    fit: Fit, base: Effect, test: Test, at: Array, values: Values, others: Sequence[Span], elsewhere: Sequence[Gram]
) -> tuple[Array, Array]:
    """Efficient score (n,) and its covariance of an effect that begins at each of n - 1 instants (s) of a test and
    lasts; the last is that of the other spans. Instants may be the same: each is run once.

    Parameters: `fit` with the test's segments; `others` spans in the test, `elsewhere` what they do in other tests.
    """
    last = float(test.time[-1]) + 1.0
    instants, where = np.unique(at, return_inverse=True)
    events = [Event.of({test.name: spans}) for spans in (*([(t, last)] for t in instants), others) if spans]
    effects = [During.of(base, e.name) for e in events]
    G = fit_gram(fit, effect_columns(fit, [test], effects, values))[test.name]
    G = G.padded(0, instants.size + 1 - len(effects))
    for more in elsewhere:
        G = G + more.padded(instants.size, 0)
    s, order = score(G, *fit_prior(fit), np.zeros(G.Zr.size, int)), np.append(where, instants.size)
    return s.u[order], s.V[np.ix_(order, order)]


def predicted_repeats(evidence: Evidence, base: Effect, event: Event, values: Values) -> Event:
    """The event without the repeats that the others do not predict; of one that does not repeat nothing is left out.

    Each is left out in turn: at the amplitude of the others it must fit better than without, by what it costs to say
    when it was. The worst goes first.
    """
    every = [(t, span) for t, pairs in event.spans.items() for span in pairs]
    if len(every) < 2:
        return event
    effects = [During.of(base, Event.of({t: [span]}).name) for t, span in every]
    scores = fit_score(evidence.fit, effect_columns(evidence.fit, evidence.tests, effects, values))
    stays, usual = list(range(len(every))), float(np.median([b - a for a, b in event.every]))
    price = [repeat_price(test, usual) for t, _ in every for test in evidence.tests if test.name == t]
    while len(stays) > 1 and min(gain := [repeat_gain(scores, i, stays) - price[i] for i in stays]) <= 0.0:
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


def instants_around(test: Test, at: float, reach_s: float, steps: float = 1.0) -> Array:
    """Instants (s) near an instant, whole timing steps from the record's begin on and inside of it, so many apart.

    To a hundredth of a step at least: names of events hold them, and no reading knows more.
    """
    t, step = test.time, timing_step(test)
    low, high = max(at - reach_s, t[0]), min(at + reach_s, t[-1])
    count = int(min(GRID_POINTS, round((high - low) / (steps * step)) + 1))
    return np.unique(whole_instants(test, np.linspace(low, high, max(count, 1))))


def whole_instants(test: Test, at: Array) -> Array:
    """Instants (s) moved to whole timing steps inside the record."""
    t, step = test.time, timing_step(test)
    return np.clip(np.round(t[0] + step * np.round((at - t[0]) / step), 2 - floor(log10(step))), t[0], t[-1])


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
    refits = [i for i in np.argsort(-P, kind="stable") if hypotheses[i].fit and hypotheses[i].members]
    likely = [i for i in refits if P[i] > REPORTED]
    # a large event between wrong ends explains little: those that come near stay in the race until theirs are right
    least = HALF * max((hypotheses[i].log_bayes for i in refits), default=0.0)
    near = [
        i for i in refits if i not in likely and hypotheses[i].log_bayes > least and _is_once(evidence, hypotheses[i])
    ]
    few = [hypotheses[i] for i in [*likely, *near[:RIVALS]][:FITTED]]
    fits, sizes, before = dict[int, Fit](), dict[int, float](), set[str]()
    for _ in range(MOVES):
        earlier, fits = fits, fits_of_events(evidence, few)
        due = {k: fit for k, fit in fits.items() if fit is not earlier.get(k)}  # about the same fit none moves again
        far = {k: size for k, fit in due.items() if is_far(size := fit.values[evidence.names[k]], sizes.get(k, 0.0))}
        sizes |= far
        before |= {evidence.names[k] for k in due}
        new = moved_events(evidence, due, {k: reach_s for k in far})
        new = {k: e for k, e in new.items() if e.name not in before}  # along a ridge ends go to and fro
        if not new:
            break
        priors: dict[Effect, float] = {e: evidence.causes[k].log_prior for k, e in new.items()}
        evidence = joined(evidence, priors, evidence.fit.values, list(new))
        few = [refit(evidence, h) if set(h.members) & set(new) else h for h in few]
    return evidence


def is_far(size: float, other: float) -> bool:
    """Is an event so much larger or smaller than another that its ends may be anywhere else?"""
    return not 1.0 / ELSEWHERE < size / (other or np.inf) < ELSEWHERE


def _is_once(evidence: Evidence, h: Weighed) -> bool:
    """Is it one cause, which lasted for one stretch?"""
    effect = evidence.effects[h.members[0]]
    once = isinstance(effect, During) and effect.event is not None and len(effect.event.every) == 1
    return once and len(h.members) == 1


def fits_of_events(evidence: Evidence, hypotheses: Sequence[Weighed]) -> dict[int, Fit]:
    """Events that have ends -> the first refit that each is in."""
    fits: dict[int, Fit] = {}
    for h in hypotheses:
        for k in h.members:
            effect = evidence.effects[k]
            if not isinstance(effect, During) or isinstance(effect.base, ReadingFault):
                continue
            if not effect.event or throughout(evidence, effect.event):
                continue
            if h.fit is not None and h.fit.values.get(effect.name):  # else it does nothing, or ran away with new ends
                fits.setdefault(k, h.fit)
    return fits


def moved_events(
    evidence: Evidence, fits: Mapping[int, Fit], reach_s: Mapping[int, Mapping[str, float]]
) -> dict[int, During]:
    """Events whose refits want other ends, or where none does further repeats, with these.

    reach_s : event -> test -> how far (s) an end may move; of others a few steps
    """

    def moved(k: int) -> During:
        effect = evidence.effects[k]
        assert isinstance(effect, During)
        assert effect.event is not None
        event = refit_ends(evidence, fits[k], effect, effect.event, reach_s.get(k, {}))
        if event.name == effect.event.name:  # what lasts too long takes the room of its repeats
            event = further_repeats(evidence, fits[k], effect, event)
        return During.of(effect.base, event.name)

    new = dict(zip(fits, side_by_side(moved, fits), strict=True))
    names, out = set(evidence.names), dict[int, During]()
    for k, e in new.items():
        if e.name not in names:  # of two that come to the same ends the more probable one moves
            out[k] = e
            names.add(e.name)
    return out


def further_repeats(evidence: Evidence, fit: Fit, effect: During, event: Event) -> Event:
    """The event with further repeats in all tests, which a scan of windows longer than they are did not see; as it is
    where it is not rare."""
    if not is_rare(evidence.tests, event):
        return event
    network, now = with_condition(fit.network, effect.condition, event.name), During.of(effect.base, event.name)
    values = {**parameter_values(fit.network, {}), **fit.values}
    values[now.name] = values[effect.name]
    more = side_by_side(lambda t: further_spans(network, t, values, now, fit.noise), evidence.tests)
    spans = {t.name: [*event.spans.get(t.name, ()), *x] for t, x in zip(evidence.tests, more, strict=True)}
    larger = Event.of({t: every for t, every in spans.items() if every})
    return larger if is_rare(evidence.tests, larger) else event


def throughout(evidence: Evidence, event: Event) -> bool:
    """Does it last all of its tests?  Then it has no ends."""
    return all(lasts(event.name, t) for t in evidence.tests if t.name in event.spans)


def refit_ends(evidence: Evidence, fit: Fit, effect: During, event: Event, reach_s: Mapping[str, float]) -> Event:
    """The event with the ends that fit best about a refit: where they may be far off every span in turn, the others
    where they are, then all of them together."""
    tests = {t.name: t for t in evidence.tests}
    spans = {t: list(each) for t, each in event.spans.items()}
    for t, reach in reach_s.items():
        for i, (begin, end) in enumerate(spans.get(t, ())):
            far = max(end - begin, STEERED * timing_step(tests[t]))  # tangents are not further off than it lasts
            spans[t][i] = refit_span(fit, effect, tests[t], spans[t], i, min(reach, far))
    return steered_ends(fit, effect, evidence.tests, Event.of(spans))


def refit_span(fit: Fit, effect: During, test: Test, spans: Sequence[Span], i: int, reach_s: float) -> Span:
    """Begin and end of the i-th of an event's spans in a test that fit best, to some steps."""
    others = [*spans[:i], *spans[i + 1 :]]
    amplitude = Unknowns((next(q for q in fit.unknowns.parameters if q.name == effect.name),))
    size, fixed = amplitude.coordinates(fit.values), {**parameter_values(fit.network, {}), **fit.values}

    def misfits(best: Span, reach_s: float) -> Callable[[Span], float]:
        closer, near = closer_look(fit, test, best, reach_s, fit.values)
        error = closer.error

        def of(span: Span) -> float:
            now = with_condition(fit.network, effect.condition, Event.of({test.name: [*others, span]}).name)
            try:
                return minimise(now, [near], amplitude, size, fit.noise, fixed, 2, draft=True, error=error).objective
            except NoSolution:
                return float("inf")

        return of

    return closest_span(test, spans[i], reach_s, misfits, COARSEST)


def steered_ends(fit: Fit, effect: During, tests: Sequence[Test], now: Event) -> Event:
    """An event with all its ends moved where their tangents point, its size and all else with them, by damped steps
    (Levenberg-Marquardt) until nothing is gained any more."""
    closer, near = fit, list(tests)
    for i, t in enumerate(tests):
        if t.name in now.spans:
            ends = np.ravel(now.spans[t.name]).tolist()
            closer, near[i] = closer_look(closer, t, ends, STEERED * timing_step(t), fit.values)

    def state(e: Event, theta: Array) -> Iterate | None:
        """Where the fit stands with such ends: behind its own parameters each end by a step, in parts of the size."""
        if not (size := abs(fit.unknowns.values(theta)[effect.name])):  # nothing that could last longer
            return None
        pieces = [During.of(effect.base, piece.name) for piece in end_pieces(tests, e)]
        network, far = extended(with_condition(fit.network, effect.condition, e.name), pieces), STEERED * size
        new = network.parameters[-len(pieces) :]
        longer = [replace(q, prior_sd=far, low=q.neutral - far, high=q.neutral + far) for q in new]
        unknowns, begin = Unknowns((*fit.unknowns.parameters, *longer)), np.append(theta, np.zeros(len(pieces)))
        try:
            return Iterate(network, near, unknowns, parameter_values(network, {}), begin, fit.noise, error=closer.error)
        except NoSolution:
            return None

    def left(it: Iterate) -> float:
        """Objective once all but the ends has moved, by tangents."""
        H, g = it.slope()
        return it.objective - 0.5 * float(g[:p] @ np.linalg.solve(H[:p, :p], g[:p]))

    p, damping, at = len(fit.unknowns.parameters), 0.0, state(now, fit.theta)
    for _ in range(STEERS):
        if at is None or damping > 1.0:
            break
        (H, g), size = at.slope(), fit.unknowns.values(at.theta[:p])[effect.name]
        H += damping * np.diag(np.diag(H))
        longer = (bounded_step(H, g, at.theta, at.low, at.high) - at.theta)[p:] / size
        one = longer / max(float(np.abs(longer).max()), 1e-9)  # along a ridge steps are not whole, and would get lost
        for some in (longer, one):
            new, steps = moved_ends(tests, now, some)
            rest = g[:p] - H[:p, p:] @ (size * steps)
            there = state(new, bounded_step(H[:p, :p], rest, at.theta[:p], at.low[:p], at.high[:p]))
            if there is not None and left(there) < left(at) - ENOUGH:
                now, at, damping = new, there, 0.1 * damping if damping > LEAST_DAMPING else 0.0
                break
        else:
            damping = max(10.0 * damping, LEAST_DAMPING)
    return now


def end_pieces(tests: Sequence[Test], e: Event) -> list[Event]:
    """For each end in turn, begin and end of each span, a step that the event would last longer if it moved."""
    steps = {t.name: timing_step(t) for t in tests}
    return [
        Event.of({t: [piece]})
        for t, step in steps.items()
        for a, b in e.spans.get(t, ())
        for piece in ((a - step, a), (b, b + step))
    ]


def moved_ends(tests: Sequence[Test], e: Event, longer: Array) -> tuple[Event, Array]:
    """The event with each end moved outwards by so many steps, some at most, and by how many it is; a span that would
    vanish or meet another stays.

    longer : as of `end_pieces`
    """
    out, moves = dict[str, list[Span]](), iter(np.clip(longer, -STEERED, STEERED).reshape(-1, 2))
    steps: list[float] = []
    for t in [t for t in tests if t.name in e.spans]:
        spans, step = list(e.spans[t.name]), timing_step(t)
        for i, (begin, end) in enumerate(spans):
            x, y = next(moves) * step
            new, last = whole_instants(t, np.array([begin - x, end + y])).tolist(), spans[i - 1][1] if i else -np.inf
            if last < new[0] < new[1] < (spans[i + 1][0] if i + 1 < len(spans) else np.inf):
                spans[i] = new[0], new[1]
            steps += [(begin - spans[i][0]) / step, (spans[i][1] - end) / step]
        out[t.name] = spans
    return Event.of(out), np.array(steps)


def closest_span(
    test: Test, best: Span, reach_s: float, misfits: Callable[[Span, float], Callable[[Span], float]], steps: float
) -> Span:
    """Begin and end that fit best to so many timing steps: first some instants around them, then others around the best
    of these, and so on.

    misfits : of the best so far and a reach, what says how badly a span fits; each is run: what is open and has cooled
        a part down to the room shows no tangent of being open longer
    """
    while reach_s >= 0.5 * steps * timing_step(test):
        misfit, results = misfits(best, reach_s), dict[Span, float]()

        def misfit_of(
            span: Span, results: dict[Span, float] = results, misfit: Callable[[Span], float] = misfit
        ) -> float:
            if span not in results:
                results[span] = misfit(span) if span[0] < span[1] else np.inf
            return results[span]

        for moves in DIRECTIONS * 2:
            around = [instants_around(test, end, reach_s, steps) - end for end in best]
            first, last = float(test.time[0]), float(test.time[-1])
            new = [(best[0] + d * moves[0], best[1] + d * moves[1]) for d in around[moves[0] == 0]]
            best = min([best, *(x for x in new if first <= x[0] and x[1] <= last)], key=misfit_of)
        reach_s = next_reach(reach_s)
    return best


def with_condition(network: Network, old: str, new: str) -> Network:
    """The network with what held while one condition holds while another does in its place."""

    def changed(law: Law) -> Law:
        if isinstance(law, Shaped) and isinstance(law.shape, TimeWindow) and law.shape.name == old:
            return replace(law, shape=replace(law.shape, name=new))
        return replace(law, base=changed(law.base)) if isinstance(law, Wrapped) else law

    def instead(x: Any) -> Any:
        return x if (law := changed(x.law)) == x.law else replace(x, law=law)

    return replace(network, links=tuple(map(instead, network.links)), sources=tuple(map(instead, network.sources)))


def with_spans(network: Network, effect: During, test: Test, spans: Sequence[Span]) -> Network:
    """The network in which an effect holds in these spans of the test, too."""
    here = Event.of({test.name: spans}).name
    return with_condition(network, effect.condition, f"{effect.condition}{AND}{here}") if spans else network


def further_spans(network: Network, test: Test, values: Values, effect: During, noise: Noise) -> list[Span]:
    """When else an effect held in a test, law and size as they are, one stretch after the other, as long as each gains
    more than the price of saying when; none where one only makes another longer."""
    assert effect.event is not None
    lengths, step = [end - begin for begin, end in effect.event.every], timing_step(test)
    usual, spans = float(np.median(lengths)), list(effect.event.spans.get(test.name, ()))
    price, first_new = repeat_price(test, usual), len(spans)

    def misfits(near: Test) -> Callable[[Sequence[Span]], float]:
        def of(every: Sequence[Span]) -> float:
            try:
                parts = segments(with_spans(network, effect, test, every), [near], values)
            except NoSolution:
                return float("inf")
            return 0.5 * sum(float(np.sum(noise.whiten(s, s.r[:, None]) ** 2)) for s in parts)

        return of

    while True:
        reach, first = _first_spans(network, test, values, effect, noise, usual, spans)
        if not first:
            return spans[first_new:]
        misfit = misfits(finer_blocks(test, first[0], reach))
        best = min(first, key=lambda span: misfit([*spans, span]))

        def closer(best: Span, reach_s: float) -> Callable[[Span], float]:
            of = misfits(finer_blocks(test, best, reach_s))
            return lambda span: of([*spans, span]) if _alike(span, lengths, step) else float("inf")

        best = closest_span(test, best, reach, closer, 1.0)
        misfit = misfits(finer_blocks(test, best, step))
        if not misfit(spans) - misfit([*spans, best]) > price:
            return spans[first_new:]
        if any(best[0] < b + LENGTHS * usual and a - LENGTHS * usual < best[1] for a, b in spans):
            return []
        spans.append(best)


def _alike(span: Span, lengths: Sequence[float], slack: float) -> bool:
    """Does a span last about as long as others (s)?"""
    length = span[1] - span[0]
    return (1.0 - LENGTHS) * min(lengths) - slack <= length <= (1.0 + LENGTHS) * max(lengths) + slack


def _first_spans(
    network: Network, test: Test, values: Values, effect: During, noise: Noise, usual: float, others: Sequence[Span]
) -> tuple[float, list[Span]]:
    """Stretches that tangents about the others promise most of, and how far (s) their ends may be off: first anywhere,
    then closer in the best of these."""
    begin, end = float(test.time[0]), float(test.time[-1])
    count = int(np.clip(np.ceil((end - begin) / (0.5 * usual)), 2, MOST_KNOTS))
    knots, network = np.linspace(begin, end, count + 1), with_spans(network, effect, test, others)
    gains = _promised_gains(network, test, values, effect, noise, usual, others, knots)
    if not (first := sorted(gains, key=lambda x: -gains[x][0])[:FIRST_RUNS]):
        return 0.0, []
    near = [np.linspace(a - 0.5 * usual, b + 0.5 * usual, MOST_KNOTS // len(first)) for a, b in first]
    spacing, knots = float(max(x[1] - x[0] for x in near)), np.unique(whole_instants(test, np.concatenate(near)))
    gains = _promised_gains(network, test, values, effect, noise, usual, others, knots)
    best: list[Span] = []
    for order in (0, 1):
        disjoint: list[Span] = []
        for a, b in sorted(gains, key=lambda x: -gains[x][order]):
            if _alike((a, b), [usual], spacing) and all(b <= c or d <= a for c, d in disjoint):
                disjoint.append((a, b))
        best += disjoint[:FIRST_RUNS]
    return max(spacing, LENGTHS * usual), best


def _promised_gains(
    network: Network,
    test: Test,
    values: Values,
    effect: During,
    noise: Noise,
    usual: float,
    others: Sequence[Span],
    knots: Array,
) -> dict[Span, tuple[float, float]]:
    """Stretches between knots about as long as the others, or from knot to knot where these are further apart -> what
    tangents promise (nats) of the size there is or less, and of all of it; none that promises nothing."""
    end, steps = float(test.time[-1]) + 1.0, knots[:-1].tolist()
    effects = [During.of(effect.base, Event.of({test.name: [(t, end)]}).name) for t in steps]
    larger = extended(network, effects)
    parts = segments(larger, [test], parameter_values(larger, values), larger.parameters[-len(effects) :])
    u, V = np.zeros(knots.size), np.zeros((knots.size, knots.size))
    for s in parts:
        X = values[effect.name] * noise.whiten(s, s.J)
        u[:-1] += X.T @ noise.whiten(s, s.r[:, None])[:, 0]
        V[:-1, :-1] += X.T @ X
    i, j = np.triu_indices(knots.size, 1)
    length = knots[j] - knots[i]
    pull, felt = u[i] - u[j], V[i, i] + V[j, j] - 2.0 * V[i, j]
    part = np.clip(pull / np.maximum(felt, 1e-12), 0.0, 1.0)  # a large one does less than tangents say
    gain = part * pull - 0.5 * part**2 * felt
    free = np.array([not any(a < knots[y] and knots[x] < b for a, b in others) for x, y in zip(i, j)])
    short = (j == i + 1) & (length > usual)  # a stretch between two knots that are further apart
    free &= (short | (np.abs(length - usual) < LENGTHS * usual + knots[1] - knots[0])) & (gain > 0.0)
    every = zip(knots[i[free]], knots[j[free]], gain[free], (pull - 0.5 * felt)[free], strict=True)
    return {(float(a), float(b)): (float(some), float(whole)) for a, b, some, whole in every}
