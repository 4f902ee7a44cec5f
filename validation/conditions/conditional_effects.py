"""Conditions nobody wrote down, as hypotheses of the posterior: what may have held in one test, or for a while.

All are scored by tangents; those that could carry weight join the evidence, where they are paired and refitted like
all others. Their prior is a share of PRIOR["condition"]: half for whole tests, half for stretches, evenly over what, in
which test, and when.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from lumped.model.sites import neighbours
from measured.case import Case, Test
from measured.doubt import FORM, PRIOR, USUAL
from validation.calibration.calibrate import no_progress
from validation.conditions.candidate_conditions import single_test_effects, temporary_effects
from validation.conditions.hat_functions import Interval, hat_scores
from validation.conditions.refine import TimedEvent, columns, refined, repeats
from validation.conditions.windows import ALIKE, distinct, stretches, worth
from validation.effects import Effect, extended
from validation.effects.during import During
from validation.effects.time_window import Event, event
from validation.inference.evidence import Evidence, extended_prior, projected
from validation.inference.missing_heat import MissingHeat, Scan
from validation.inference.posterior import log_bayes_of
from validation.inference.score import Score, per_test, score, total
from validation.parameters.unknowns import scene_of
from validation.threads import side_by_side

Array = NDArray[np.float64]
TESTS, EVENTS, EACH = 16, 4, 6  # conditions of whole tests, events, and explanations of each that join the others
FEW = 3  # of these have ends of their own: a film that changes bends a record later than heat does
SPANS = 4  # of an event, beyond which its explanations share their ends: each span costs thirty runs
FEW_TESTS = 6  # whose sets are all tried: of more each must stand for itself
HOPELESS = 5.0  # nats below nothing, prior included: what has less cannot carry weight


@dataclass(frozen=True)
class Condition:
    """A condition before it joins.  worth : log posterior odds against nothing"""

    effect: During
    worth: float


def conditions(
    evidence: Evidence,
    case: Case,
    heat_scan: Scan,
    heat: Sequence[MissingHeat],
    only: Sequence[str] | None = None,
    progress: Callable[[str], None] = no_progress,
) -> list[During]:
    """The conditions that could carry weight, most probable first.  only : kinds, None for all"""
    values = {**case.model.values, **evidence.fit.values}
    scene = replace(scene_of(case), network=evidence.fit.network)
    bases = [e for e in temporary_effects(scene) if only is None or e.kind in only]
    if not bases:
        return []
    progress("looking for what held in one test or for a while")
    whole = [e for e in single_test_effects(scene) if only is None or e.kind in only]
    selection, events = best(single_test_conditions(evidence, whole, values), TESTS), []
    intervals = likely_intervals(evidence, heat_scan, heat, values, len(bases))
    for occurrence, candidates in side_by_side(lambda s: explained(evidence, bases, s, heat_scan, values), intervals):
        events.append(occurrence)
        selection += best(candidates, EACH)
    for name, share in declared_conditions(case, evidence, events):
        effects = [During.of(base, name, share / len(bases)) for base in bases]
        selection += best(scored_in(evidence, effects, values, odds_against_nothing(share / len(bases))), EACH)
    by_worth = sorted(selection, key=lambda c: -c.worth)
    once = {c.effect.name: c.effect for c in reversed(by_worth)}  # two stretches may come to the same ends
    return list(reversed(once.values()))


def declared_conditions(case: Case, evidence: Evidence, events: Sequence[Event]) -> list[tuple[str, float]]:
    """What the user says was different: inputs of 0 and 1 that no law reads, and events he confirmed, each with its
    share of the prior."""
    laws = [*(x.law for x in evidence.network.links), *(x.law for x in evidence.network.sources)]
    read = {name for law in laws for name in law.reads}
    inputs = {
        n: np.concatenate([t.inputs[n] for t in evidence.tests if n in t.inputs])
        for t in evidence.tests
        for n in t.inputs
    }
    switches = [n for n, u in inputs.items() if n not in read and set(np.unique(u)) == {0.0, 1.0}]
    events_confirmed = [e for name, yes in case.answers.items() if yes and (e := event(name))]
    new = [e.name for e in events_confirmed if all(e.overlap(x) < ALIKE for x in events)]
    return [(n, 0.5 / len(switches)) for n in switches] + [(n, 0.5 / len(evidence.tests)) for n in new]


def best(conditions: Sequence[Condition], most: int) -> list[Condition]:
    hopeful = [c for c in conditions if c.worth > -HOPELESS]
    return sorted(hopeful, key=lambda c: -c.worth)[:most]


def odds_against_nothing(share: float) -> float:
    """log prior odds of a condition with a share of their prior."""
    return float(np.log(PRIOR["condition"].share * share / PRIOR["nothing"].share))


def single_test_conditions(evidence: Evidence, bases: Sequence[Effect], values: Mapping[str, float]) -> list[Condition]:
    """Everything that may have held in one test alone, or in some of them; none where there is only one test."""
    names = [t.name for t in evidence.tests]
    if len(names) < 2 or not bases:
        return []
    parts = columns(evidence, bases, values)
    parameters = extended(evidence.fit.network, bases).parameters[-len(bases) :]
    theta, sd = extended_prior(evidence.fit)
    sign = np.tile([q.sign for q in parameters], len(names)).astype(int)
    scores = score(per_test(projected(evidence.fit, parts)), theta, sd, sign)
    usual = np.array([q.prior_sd for q in parameters])
    every, out = sets_of(len(names)), []
    for subset in every:
        joint, visibility = together(scores, len(bases), subset)
        one = len(subset) == 1
        form = FORM["one whole test" if one else "several whole tests"]
        share = form / (len(bases) * (len(names) if one else len(every) - len(names)))
        name = condition_of([evidence.tests[t] for t in subset])
        out += [
            Condition(During.of(base, name, share), float(b) + odds_against_nothing(share))
            for base, b, visible in zip(bases, log_bayes_of(joint, usual), visibility, strict=True)
            if visible
        ]
    return out


def sets_of(tests: int) -> list[tuple[int, ...]]:
    """Each test alone, and where there are not too many every set of some but not all of them."""
    most = tests - 1 if tests <= FEW_TESTS else 1
    return [c for n in range(1, most + 1) for c in combinations(range(tests), n)]


def together(scores: Score, bases: int, subset: Sequence[int]) -> tuple[Score, NDArray[np.bool_]]:
    """The score of every effect with one amplitude in some tests, and whether it is felt in each of them.

    scores : of every effect in every test, test by test
    """
    rows = np.array([[t * bases + k for t in subset] for k in range(bases)])
    u = scores.u[rows].sum(axis=1)
    V = scores.V[rows[:, :, None], rows[:, None, :]].sum(axis=(1, 2))
    raw = scores.raw[rows].sum(axis=1)
    joint = Score(u, np.diag(np.maximum(V, 0.0)), raw, scores.sign[:bases], np.zeros(bases, int))
    return joint, scores.visible[rows].all(axis=1)


def condition_of(tests: Sequence[Test]) -> str:
    """A test by its name, several as an event that lasts all of each."""
    if len(tests) == 1:
        return tests[0].name
    return Event.of({t.name: [(float(t.time[0]), float(t.time[-1]))] for t in tests}).name


def likely_intervals(
    evidence: Evidence, heat_scan: Scan, heat: Sequence[MissingHeat], values: Mapping[str, float], laws: int
) -> list[Interval]:
    """The stretches that could carry weight once the price of when, what and where is paid."""
    scores = hat_scores(evidence, heat_scan, values)
    limit = -HOPELESS - odds_against_nothing(0.5 / (laws * len(evidence.tests)))
    by_worth = stretches(scores, heat, neighbours(evidence.fit.network))
    return [s for s in distinct(by_worth, EVENTS) if worth(scores, s) > limit]


def explained(
    evidence: Evidence, bases: Sequence[Effect], s: Interval, heat_scan: Scan, values: Mapping[str, float]
) -> tuple[Event, list[Condition]]:
    """An event with its ends at the samples, and all that it may have been, exactly run; the most probable ones with
    ends of their own."""
    far = reach(heat_scan)
    price = 0.5 / (len(bases) * len(evidence.tests))
    like = likeness(evidence, bases, s, values)
    occurrence = refined(evidence, like, repeats(evidence, like, s.event, values), far, values)
    every = best(timed_by(evidence, bases, occurrence, price, values), EACH)
    few = FEW if len(occurrence.event.every) <= SPANS else 0
    intervals = [refined(evidence, c.effect.base, occurrence.event, far, values) for c in every[:few]]
    again = [timed_by(evidence, [c.effect.base], t, price, values) for c, t in zip(every, intervals)]
    again += [[]] * (len(every) - len(again))
    return occurrence.event, [max([c, *new], key=lambda x: x.worth) for c, new in zip(every, again, strict=True)]


def reach(heat_scan: Scan) -> dict[str, float]:
    """Test -> how far (s) an end may lie from where knots of heat put it."""
    return {t: 1.5 * float(knots[1] - knots[0]) for t, knots in heat_scan.knots.items()}


def timed_by(
    evidence: Evidence, bases: Sequence[Effect], occurrence: TimedEvent, price: float, values: Mapping[str, float]
) -> list[Condition]:
    """All that an event may have been.  price : share of what and in which test"""
    share = price * float(np.exp(max(occurrence.log_share, -600.0)))
    effects = [During.of(base, occurrence.event.name, share) for base in bases]
    return scored_in(evidence, effects, values, odds_against_nothing(share))


def likeness(evidence: Evidence, bases: Sequence[Effect], s: Interval, values: Mapping[str, float]) -> Effect:
    """Of all that can hold for a while what explains a stretch best as it stands."""
    effects = [During.of(base, s.event.name) for base in bases]
    rows = scored_in(evidence, effects, values, 0.0)
    return max(rows, key=lambda c: c.worth).effect.base if rows else bases[0]


def scored_in(
    evidence: Evidence, effects: Sequence[During], values: Mapping[str, float], prior: float
) -> list[Condition]:
    """Conditions at their linear amplitude, without those that move no reading further than chance does."""
    parameters = extended(evidence.fit.network, effects).parameters[-len(effects) :]
    theta, sd = extended_prior(evidence.fit)
    parts = columns(evidence, effects, values)
    scores = score(total(projected(evidence.fit, parts)), theta, sd, np.array([q.sign for q in parameters], int))
    bayes = log_bayes_of(scores, np.array([q.prior_sd for q in parameters]))
    excursion = np.max([np.max(np.abs(s.J[:, evidence.p :]), axis=0) / s.weight for s in parts], axis=0)
    clear = scores.visible & (excursion * np.abs(scores.amplitude) > USUAL["excursion"])
    return [Condition(e, float(b) + prior) for e, b, visible in zip(effects, bayes, clear, strict=True) if visible]
