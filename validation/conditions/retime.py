"""When exactly, once an event is in the model at its size: a large one bends the machine, so that by tangents of
a model without it the ends are off by some samples.

Beginning earlier is the same effect for a little longer: about the fitted state that is linear, whatever the size.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lumped.model.multipliers import parameter_values
from measured.case import Test
from validation.calibration.calibrate import Fit
from validation.comparison.linearisation import segments
from validation.conditions.refine import GRID_POINTS, around, joined
from validation.effects import Effect, extended
from validation.effects.during import During
from validation.effects.time_window import Event, Span, lasts
from validation.inference.evidence import Evidence, extended_prior, projected, replaced
from validation.inference.posterior import Hypothesis, probabilities
from validation.inference.refits import REPORTED, to_the_end
from validation.inference.score import score, total

Array = NDArray[np.float64]
ROUNDS = 3  # of moving the ends and refitting with them: by then they stand within a sample
FITTED = 4  # of the most probable refits: an event in any of them that will be told gets its ends anew


def retimed(evidence: Evidence, hypotheses: Sequence[Hypothesis], reach_s: Mapping[str, float]) -> Evidence:
    """The evidence with the ends of its most probable events moved to where their refits want them, again and again
    until none moves; itself where none does.  reach_s : test -> how far an end may move at once"""
    P = probabilities(hypotheses)
    order = [hypotheses[i] for i in np.argsort(-P, kind="stable") if P[i] > REPORTED]
    few = [h for h in order if h.fit and h.members][:FITTED]
    for _ in range(ROUNDS):
        new = moved(evidence, few, reach_s)
        if not new:
            break
        evidence = replaced(joined(evidence, list(new.values()), evidence.fit.values), list(new))
        few = [to_the_end(evidence, h) if set(h.members) & set(new) else h for h in few]
    return evidence


def moved(evidence: Evidence, hypotheses: Sequence[Hypothesis], reach_s: Mapping[str, float]) -> dict[int, During]:
    """Events whose refits want other ends, with these."""
    by_index: dict[int, During] = {}
    for h in hypotheses:
        for k in h.members:
            effect = evidence.effects[k]
            if (
                k in by_index
                or not isinstance(effect, During)
                or not effect.event
                or throughout(evidence, effect.event)
            ):
                continue
            if h.fit is not None and effect.name in h.fit.values:  # else the machine ran away with the new ends
                by_index[k] = with_ends(effect, ends_of(evidence, h.fit, effect, effect.event, reach_s))
    names = {e.name for i, e in enumerate(evidence.effects) if i not in by_index}
    new = {k: e for k, e in by_index.items() if e.name != evidence.names[k] and e.name not in names}
    return {k: e for k, e in new.items() if [x.name for x in new.values()].count(e.name) == 1}


def throughout(evidence: Evidence, event: Event) -> bool:
    """Does it last all of its tests?  Then it has no ends."""
    return all(lasts(event.name, t) for t in evidence.tests if t.name in event.spans)


def with_ends(effect: During, event: Event) -> During:
    return During.of(effect.base, event.name, effect.share)


def ends_of(evidence: Evidence, fit: Fit, effect: During, event: Event, reach_s: Mapping[str, float]) -> Event:
    """Every span in turn, the others where they are."""
    tests = {t.name: t for t in evidence.tests}
    return Event.of(
        {
            t: [span_of(evidence, fit, effect, tests[t], s, reach_s[t]) for s in pairs]
            for t, pairs in event.spans.items()
        }
    )


def span_of(evidence: Evidence, fit: Fit, effect: During, test: Test, span: Span, reach_s: float) -> Span:
    """Begin and end that fit best: first some instants around them, then every sample around the best of these."""
    best = span
    for reach in (reach_s, 2.0 * reach_s / GRID_POINTS):
        begins, ends = around(test, best[0], reach), around(test, best[1], reach)
        u, V = steps(fit, effect.base, test, np.concatenate([span, begins, ends]))
        a = size(fit, effect)
        i, j = np.meshgrid(2 + np.arange(begins.size), 2 + begins.size + np.arange(ends.size), indexing="ij")
        gain = moved_gain(u, V, a, i.ravel(), j.ravel())
        gain[(begins[:, None] >= ends[None, :]).ravel()] = -np.inf
        k = int(np.argmax(gain))
        if gain[k] > 0.0:
            best = float(begins[k // ends.size]), float(ends[k % ends.size])
    return best


def size(fit: Fit, effect: During) -> float:
    """Amplitude of one more piece of the effect beside what is there: factors multiply, all others add."""
    a = fit.values[effect.name]
    return a / (1.0 + a) if effect.base.mapping == "relative" else a


def moved_gain(u: Array, V: Array, a: float, i: NDArray[np.int64], j: NDArray[np.int64]) -> Array:
    """(n,) log likelihood gained by a begin at instant i and an end at j in place of the instants 0 and 1."""
    first = a * (u[i] - u[0]) - a * (u[j] - u[1])
    d = np.zeros((i.size, u.size))
    rows = np.arange(i.size)
    for at, sign in ((i, 1.0), (np.zeros_like(i), -1.0), (j, -1.0), (np.ones_like(j), 1.0)):
        np.add.at(d, (rows, at), sign * a)
    return np.asarray(first - 0.5 * np.sum((d @ V) * d, axis=1))


def steps(fit: Fit, base: Effect, test: Test, at: Array) -> tuple[Array, Array]:
    """Score and covariance of an effect that begins at some instants of a test and lasts, beside what was fitted."""
    last = float(test.time[-1]) + 1.0
    instants, where = np.unique(at, return_inverse=True)
    effects = [During.of(base, Event.of({test.name: [(t, last)]}).name) for t in instants]
    network = extended(fit.network, effects)
    amplitudes = network.parameters[-len(effects) :]
    values = {**parameter_values(network, fit.values), **fit.values}
    new = {(s.test, s.channel): s.J for s in segments(network, [test], values, amplitudes)}
    parts = [
        replace(s, J=np.column_stack([s.J, new.get((s.test, s.channel), np.zeros((s.r.size, len(amplitudes))))]))
        for s in fit.parts
    ]
    theta, sd = extended_prior(fit)
    scores = score(total(projected(fit, parts)), theta, sd, np.zeros(len(amplitudes), int))
    return scores.u[where], scores.V[np.ix_(where, where)]
