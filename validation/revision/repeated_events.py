"""An event of the model that happened again in a held-out test: when is read off that test, and nothing else.

Its law and size are those that other tests gave it, and it lasts about as long as there. Since its ends are fitted, the
stretch itself is not counted any more; what the event leaves behind is, and has to be predicted much better with it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from geom.errors import NoSolution
from lumped.model.multipliers import parameter_values
from lumped.model.network import Network
from measured.case import Case, Test
from validation.comparison.compare import physical, test_error
from validation.comparison.linearisation import segments
from validation.effects import extended
from validation.effects.during import During
from validation.effects.time_window import AND, Event, Span, share
from validation.inference.events import closest_span, finer_blocks, sample_step, with_condition
from validation.inference.hypotheses import LENGTHS, stretch_count
from validation.noise import first_noise
from validation.parameters.unknowns import effects_of, standing

MOST_KNOTS = 96  # instants at which it may begin at first: each is a column of one run
FIRST_RUNS = 4  # stretches that tangents like best are run
LESS = 0.7  # of the error outside the stretch: what the event must bring it to, to be the explanation


@dataclass(frozen=True)
class RepeatedEvent:
    """What happened again in a held-out test.

    words : what and when;  event : when
    rmse_K : error (K rms) of the test as it is predicted;  elsewhere_K : with the event, its stretch not counted
    """

    test: str
    words: str
    event: Event
    rmse_K: float
    elsewhere_K: float

    @property
    def sentence(self) -> str:
        return (
            f"{self.words}: {self.test} is predicted within {self.rmse_K:.2f} K without it, and within "
            f"{self.elsewhere_K:.2f} K with it where that stretch, fitted in time, is not counted"
        )

    def document(self) -> dict:
        errors = {"rmse_K": self.rmse_K, "elsewhere_rmse_K": self.elsewhere_K}
        return {"test": self.test, **self.event.document(), "words": self.sentence, **errors}


def repeated_events(case: Case) -> tuple[RepeatedEvent, ...]:
    """Every event of a case's model that is found in a held-out test, one effect after the other."""
    return tuple(x for test in case.tests if test.role == "hold-out" for x in _in_test(case, test))


def _in_test(case: Case, test: Test) -> Iterator[RepeatedEvent]:
    network, now = standing(case), physical(case)
    for effect in effects_of(case):
        if isinstance(effect, During) and effect.name in case.model.values and _can_repeat(effect, test):
            spans = _located(network, test, {**case.model.values, **now}, effect)
            if spans:
                event, inside = Event.of({test.name: spans}), share(test.time, spans) > 0.0
                rest = tuple(replace(c, y=np.where(inside, np.nan, c.y)) for c in test.channels)
                larger, elsewhere = _with_spans(network, effect, test, spans), replace(test, channels=rest)
                before, after = (test_error(x, elsewhere, now).rmse_K for x in (network, larger))
                if after < LESS * before:
                    words, whole = f"{effect.base.statement} {event.words}", test_error(network, test, now).rmse_K
                    yield RepeatedEvent(test.name, words, event, whole, after)
                    network = larger


def _can_repeat(effect: During, test: Test) -> bool:
    """Could an event that other tests had have held in this one?  A boundary is off in whole tests alone."""
    lengths = [end - begin for begin, end in effect.event.every] if effect.event else []
    elsewhere = effect.mapping != "offset" and test.name not in effect.tests
    return bool(lengths) and elsewhere and float(np.ptp(test.time)) > max(lengths)


def _with_spans(network: Network, effect: During, test: Test, spans: Sequence[Span]) -> Network:
    """The network in which an effect holds in these spans of the test, too."""
    here = Event.of({test.name: spans}).name
    return with_condition(network, effect.condition, f"{effect.condition}{AND}{here}") if spans else network


def _located(network: Network, test: Test, values: Mapping[str, float], effect: During) -> list[Span]:
    """When an effect held in a test, one stretch after the other, as long as each gains more than the price of saying
    when."""
    assert effect.event is not None
    lengths, step = [end - begin for begin, end in effect.event.every], sample_step(test)
    usual, spans = float(np.median(lengths)), list[Span]()
    price = float(np.log(stretch_count(test.time.size, usual / step)))

    def misfits(near: Test) -> Callable[[Sequence[Span]], float]:
        noise = first_noise(segments(network, [near], values))

        def of(every: Sequence[Span]) -> float:
            try:
                parts = segments(_with_spans(network, effect, test, every), [near], values)
            except NoSolution:
                return float("inf")
            return 0.5 * sum(float(np.sum(noise.whiten(s, s.r[:, None]) ** 2)) for s in parts)

        return of

    while True:
        reach, first = _first_spans(network, test, values, effect, usual, spans)
        if not first:
            return spans
        misfit = misfits(finer_blocks(test, first[0], reach))
        best = min(first, key=lambda span: misfit([*spans, span]))

        def closer(best: Span, reach_s: float) -> Callable[[Span], float]:
            of = misfits(finer_blocks(test, best, reach_s))
            return lambda span: of([*spans, span]) if _alike(span, lengths, step) else float("inf")

        best = closest_span(test, best, reach, closer)
        misfit = misfits(finer_blocks(test, best, step))
        if not misfit(spans) - misfit([*spans, best]) > price:
            return spans
        gap = LENGTHS * usual
        if any(best[0] < b + gap and a - gap < best[1] for a, b in spans):
            return []  # no repeats, but something that lasted longer
        spans.append(best)


def _alike(span: Span, lengths: Sequence[float], slack: float) -> bool:
    """Does a span last about as long as others (s)?"""
    length = span[1] - span[0]
    return (1.0 - LENGTHS) * min(lengths) - slack <= length <= (1.0 + LENGTHS) * max(lengths) + slack


def _first_spans(
    network: Network, test: Test, values: Mapping[str, float], effect: During, usual: float, others: Sequence[Span]
) -> tuple[float, list[Span]]:
    """Stretches that tangents about the others promise most of, and how far (s) their ends may be off."""
    begin, end = float(test.time[0]), float(test.time[-1])
    count = int(np.clip(np.ceil((end - begin) / (0.5 * usual)), 2, MOST_KNOTS))
    knots = np.linspace(begin, end, count + 1)
    now = _with_spans(network, effect, test, others)
    steps = [During.of(effect.base, Event.of({test.name: [(float(t), end + 1.0)]}).name) for t in knots[:-1]]
    larger = extended(now, steps)
    parts = segments(larger, [test], parameter_values(larger, values), larger.parameters[-len(steps) :])
    noise, u, V = first_noise(parts), np.zeros(count + 1), np.zeros((count + 1, count + 1))
    for s in parts:
        X = values[effect.name] * noise.whiten(s, s.J)
        u[:-1] += X.T @ noise.whiten(s, s.r[:, None])[:, 0]
        V[:-1, :-1] += X.T @ X
    spacing = knots[1] - knots[0]
    i, j = (k.ravel() for k in np.meshgrid(np.arange(count), np.arange(1, count + 1), indexing="ij"))
    length = knots[j] - knots[i]
    short = (j == i + 1) & (length > usual)  # a stretch between two knots that are further apart
    pull, felt = u[i] - u[j], V[i, i] + V[j, j] - 2.0 * V[i, j]
    part = np.clip(pull / np.maximum(felt, 1e-12), 0.0, 1.0)  # a large one does less than tangents say
    gain = part * pull - 0.5 * part**2 * felt
    free = (j > i) & np.array([not any(a < knots[y] and knots[x] < b for a, b in others) for x, y in zip(i, j)])
    free &= short | (np.abs(length - usual) < LENGTHS * usual + spacing)
    order = [k for k in np.argsort(-np.where(free, gain, -np.inf)) if free[k] and gain[k] > 0.0][:FIRST_RUNS]
    middle, half = 0.5 * (knots[i] + knots[j]), 0.5 * np.where(short, usual, length)
    return float(spacing), [(float(middle[k] - half[k]), float(middle[k] + half[k])) for k in order]
