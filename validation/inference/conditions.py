"""Conditions nobody wrote down, as hypotheses: what may have held in one test, or for a while, and laws that are off.

All are scored by tangents; those that could carry weight join the evidence, where they are paired and refitted like
all others. Their prior is a share of PRIOR["condition"]: half for whole tests, half for stretches, evenly over what, in
which test, and when. What can hold for a while: films, flows, inputs, boundaries, mounting; never masses or joints.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from geom.arrays import Array
from geom.errors import InputError
from lumped.model.sites import ambient, neighbours
from lumped.schemas.reader import suggestion
from measured.case import Case, Test
from measured.doubt import FORM
from measured.sensors.blocks import groups
from validation.calibration.calibrate import no_progress
from validation.effects.above import KIND, Above
from validation.effects.base import Effect, Scene
from validation.effects.during import During
from validation.effects.registry import catalogue, effect, kinds
from validation.effects.time_window import ALIKE, Event, all_but, event
from validation.inference.columns import amplitudes, effect_columns
from validation.inference.events import TimedEvent, predicted_repeats, time_around, timed_event
from validation.inference.evidence import Evidence, Progress
from validation.inference.hypotheses import NOTHING, condition_prior, is_rare, law_prior, repeats_price
from validation.inference.missing_heat import MissingHeat, Scan
from validation.inference.score import Score, fit_score
from validation.inference.stretches import Interval, distinct, hat_scores, stretches, worth
from validation.parameters.model_form import EXACT_LOSSES, is_film
from validation.parameters.unknowns import scene_of
from validation.scope import SENSORS
from validation.threads import side_by_side

Values = Mapping[str, float]
EVERYWHERE = ("loss.constant", "convection.constant")  # at every node: a lid that is open cools what it never washed
AS_DECLARED = ("conduction.bench", "flow", "blockage", "blockage.all", "input.factor")  # where the catalogue has them
IN_WHOLE_TESTS = ("ambient.offset", "input.offset", "sensor.loose", "loss.factor.all")
LOOSENED = ("sensor.loose", "sensor.slip")  # at once, or as a probe does that is slow by itself
CLOSE = 40  # samples around the most probable instant that a sensor slipped at: a block of readings is many of them
LOOSE = 8  # sensors that may have come loose, in the tests that speak for it most, are asked when
SLIPPED = (0.0, 0.3, 0.6, 0.85)  # of a test, when one may have: from one to the next it shows half its change at least
TESTS, EACH = 16, 6  # conditions of whole tests, and explanations of an event, that join the others
EVENTS = 8  # that pay the price of when, what and where; more would be a matter of time, not of odds
LAWS = 4  # laws that join
FEW = 3  # explanations with ends of their own: a film that changes bends a record later than heat does
SPANS = 4  # of an event, beyond which its explanations share their ends: each span costs thirty runs
FEW_TESTS = 6  # whose sets are all tried: of more each must stand for itself
HOPELESS = 5.0  # nats below nothing, prior included: what has less cannot carry weight
LEVELS = (0.5, 0.75)  # quantiles of an input at which its law may turn
VARIED = 0.2  # of its largest value: an input that moves less shows no law


@dataclass(frozen=True)
class Promising:
    """A cause before it joins.  worth : log posterior odds against nothing, by its tangent"""

    effect: Effect
    log_prior: float
    worth: float


def temporary_effects(scene: Scene) -> tuple[Effect, ...]:
    """Effects that can hold for a while."""
    table, network = kinds(), scene.network
    nodes = [p.name for p in network.places.values() if p.kind in ("part", "node", "fluid")]
    heavy = [place for place in nodes if network.C[network.places[place].states[0]] > 0]
    everywhere = [k for k in EVERYWHERE if k != "convection.constant" or ambient(network)]
    return (*(table[k](place) for k in everywhere for place in heavy), *_catalogue(scene, AS_DECLARED))


def single_test_effects(scene: Scene) -> tuple[Effect, ...]:
    """Effects that can hold in one test: those, other losses of a part, and a thermometer that was elsewhere."""
    return (*temporary_effects(scene), *_catalogue(scene, IN_WHOLE_TESTS))


def _catalogue(scene: Scene, names: Sequence[str]) -> list[Effect]:
    table = kinds()
    return [table[k](place) for k in names for place in table[k].places(scene)]


def check_names(case: Case, names: Iterable[str], where: str) -> None:
    """Refuse what is neither a kind, nor a "kind@place" that can be here, nor SENSORS, with the nearest that are."""
    scene, words = scene_of(case), (*kinds(), KIND, SENSORS)
    effects = {e.name: e.kind for e in (*catalogue(scene), *single_test_effects(scene), *_catalogue(scene, LOOSENED))}
    for text in names:
        kind = next((k for k in words if text.startswith(f"{k}@")), "")
        if kind == KIND:
            effect(text)  # its level comes from the readings: any that can be read may be found
        elif text not in effects and text not in words:
            here = [name for name, of in effects.items() if of == kind]
            raise InputError(f"no effect '{text}' here", where, suggestion(text, here or words))


def conditions(
    evidence: Evidence,
    case: Case,
    scan: Scan,
    heat: Sequence[MissingHeat],
    holds: Callable[[Effect], bool] = lambda effect: True,
    progress: Progress = no_progress,
) -> dict[Effect, float]:
    """The conditions that could carry weight, most probable first, each with its log prior.

    Parameters: `evidence` under the noise of a good model; `scan`, `heat` where and when heat is missing; `holds`
    whether an effect is asked about.
    """
    values = {**case.model.values, **evidence.fit.values}
    scene = replace(scene_of(case), network=evidence.fit.network)
    bases = [e for e in temporary_effects(scene) if holds(e)]
    if not bases:
        return {}
    progress("looking for what held in one test or for a while")
    whole = [e for e in single_test_effects(scene) if holds(e)]
    selection, events = best(single_test_conditions(evidence, whole, values), TESTS), []
    intervals = likely_intervals(evidence, scan, heat, values, len(bases))
    for occurrence, rows in side_by_side(lambda s: explanations(evidence, bases, s, scan, values), intervals):
        events.append(occurrence)
        selection += best(rows, EACH)
    sensors = [e for e in _catalogue(scene, LOOSENED) if holds(e)]
    selection += best(loose_sensors(evidence, sensors, values, 0.5 / (len(bases) + len(sensors))), EACH)
    for name, share in declared_conditions(case, evidence, events):
        selection += best(tangent_worth(evidence, bases, name, share / len(bases), values), EACH)
    once: dict[str, Promising] = {}
    for c in sorted(selection, key=lambda c: -c.worth):
        once.setdefault(c.effect.name, c)  # two stretches may come to the same ends
    return {c.effect: c.log_prior for c in once.values()}


def declared_conditions(case: Case, evidence: Evidence, events: Sequence[Event]) -> list[tuple[str, float]]:
    """What the user says was different: inputs of 0 and 1 that no law reads, and events he confirmed, each with its
    share of the prior."""
    laws = [*(x.law for x in evidence.network.links), *(x.law for x in evidence.network.sources)]
    read = {name for law in laws for name in law.reads}
    values = {n: {float(x) for t in evidence.tests for x in np.unique(t.inputs.get(n, []))} for n in _inputs(evidence)}
    switches = [n for n, each in values.items() if n not in read and each == {0.0, 1.0}]
    confirmed = [e for name, yes in case.answers.items() if yes and (e := event(name))]
    new = [e.name for e in confirmed if all(e.overlap(x) < ALIKE for x in events)]
    return [(n, 0.5 / len(switches)) for n in switches] + [(n, 0.5 / len(evidence.tests)) for n in new]


def _inputs(evidence: Evidence) -> list[str]:
    return list(dict.fromkeys(n for t in evidence.tests for n in t.inputs))


def best(rows: Sequence[Promising], most: int) -> list[Promising]:
    """The most probable of those that could carry weight."""
    return sorted((c for c in rows if c.worth > -HOPELESS), key=lambda c: -c.worth)[:most]


def single_test_conditions(evidence: Evidence, bases: Sequence[Effect], values: Values) -> list[Promising]:
    """Everything that may have held in one test alone, or in some of them; none where there is only one test."""
    names = [t.name for t in evidence.tests]
    if len(names) < 2 or not bases:
        return []
    parameters = amplitudes(evidence.fit.network, bases)
    sign = np.tile([q.sign for q in parameters], len(names)).astype(int)
    parts = effect_columns(evidence.fit, evidence.tests, bases, values)
    scores = fit_score(evidence.fit, parts, sign, each_test=True)
    scale = np.array([q.prior_sd for q in parameters])
    every, out = whole_test_sets(len(names)), []
    for subset in every:
        joint, visibility = set_score(scores, len(bases), subset)
        one = len(subset) == 1
        form = FORM["one whole test" if one else "several whole tests"]
        prior = condition_prior(form / (len(bases) * (len(names) if one else len(every) - len(names))))
        name = set_condition(evidence.tests, subset)
        out += [
            Promising(During.of(base, name), prior, float(b) + prior - NOTHING.log_prior)
            for base, b, visible in zip(bases, joint.log_bayes(scale), visibility, strict=True)
            if visible
        ]
    return out


def whole_test_sets(tests: int) -> list[tuple[int, ...]]:
    """Each test alone, and where there are not too many every set of some but not all of them."""
    most = tests - 1 if tests <= FEW_TESTS else 1
    return [c for n in range(1, most + 1) for c in combinations(range(tests), n)]


def set_score(scores: Score, bases: int, subset: Sequence[int]) -> tuple[Score, NDArray[np.bool_]]:
    """The score of every effect with one amplitude in some tests, and whether it is felt in each of them.

    scores : of every effect in every test, test by test
    """
    rows = np.array([[t * bases + k for t in subset] for k in range(bases)])
    u = scores.u[rows].sum(axis=1)
    V = scores.V[rows[:, :, None], rows[:, None, :]].sum(axis=(1, 2))
    raw = scores.raw[rows].sum(axis=1)
    joint = Score(u, np.diag(np.maximum(V, 0.0)), raw, scores.sign[:bases], np.zeros(bases, int))
    return joint, scores.visible[rows].all(axis=1)


def set_condition(tests: Sequence[Test], subset: Sequence[int]) -> str:
    """A test by its name, several as an event that lasts all of each. What held in most of them is what is usual: it
    is named by the others, and holds in a test that is still to come."""
    some = [t for i, t in enumerate(tests) if i in subset]
    if len(some) == 1:
        return some[0].name
    if 2 * len(some) > len(tests):
        return all_but(t.name for i, t in enumerate(tests) if i not in subset)
    return Event.of({t.name: [(float(t.time[0]), float(t.time[-1]))] for t in some}).name


def likely_intervals(
    evidence: Evidence, scan: Scan, heat: Sequence[MissingHeat], values: Values, laws: int
) -> list[Interval]:
    """The stretches that could carry weight once the price of when, what and where is paid."""
    scores = hat_scores(evidence, scan, values)
    limit = -HOPELESS - (condition_prior(0.5 / (laws * len(evidence.tests))) - NOTHING.log_prior)
    by_worth = stretches(scores, heat, neighbours(evidence.fit.network))
    return [s for s in distinct(by_worth, EVENTS) if worth(scores, s) > limit]


def explanations(
    evidence: Evidence, bases: Sequence[Effect], s: Interval, scan: Scan, values: Values
) -> tuple[Event, list[Promising]]:
    """An event with its ends at the samples, and all that it may have been, exactly run; the most probable ones with
    ends of their own."""
    far, price = end_reach(scan), 0.5 / (len(bases) * len(evidence.tests))
    rows = tangent_worth(evidence, bases, s.event.name, 1.0, values)
    like = max(rows, key=lambda c: c.worth).effect.base if rows else bases[0]  # type: ignore[attr-defined]
    occurrence = timed_event(evidence, like, s.event, far, values)
    occurrence = replace(occurrence, event=predicted_repeats(evidence, like, occurrence.event, values))
    every = best(timed_worth(evidence, bases, occurrence, price, values), EACH)
    some = every[: FEW if len(occurrence.event.every) <= SPANS else 0]
    out = []
    for i, c in enumerate(every):
        base = c.effect.base  # type: ignore[attr-defined]
        new = timed_event(evidence, base, occurrence.event, far, values) if i < len(some) else None
        again = timed_worth(evidence, [base], new, price, values) if new else []
        out.append(max([c, *again], key=lambda x: x.worth))
    return occurrence.event, out


def end_reach(scan: Scan) -> dict[str, float]:
    """Test -> how far (s) an end may lie from where knots of heat put it."""
    return {t: 1.5 * float(knots[1] - knots[0]) for t, knots in scan.knots.items()}


def loose_sensors(evidence: Evidence, sensors: Sequence[Effect], values: Values, share: float) -> list[Promising]:
    """Sensors that may have come loose during a test, and stayed so to its end; when, by the most probable instant.

    share : of the prior, of each sensor
    """
    pairs = [(e, t) for e in sensors for t in evidence.tests if any(c.name == e.place for c in t.channels)]
    first = [(e, t, float(np.quantile(t.time, at))) for e, t in pairs for at in SLIPPED]
    worth = dict[tuple[str, str], float]()
    for (e, t, _), bayes in zip(first, slip_bayes(evidence, first, values), strict=True):
        worth[e.name, t.name] = max(worth.get((e.name, t.name), -np.inf), float(bayes))
    out = []
    for e, t in sorted(pairs, key=lambda x: -worth[x[0].name, x[1].name])[:LOOSE]:
        at = np.unique(t.time[groups(t.time.size)][1:-1])
        if not at.size:
            continue
        bayes = slip_bayes(evidence, [(e, t, float(x)) for x in at], values)
        k = int(np.argmax(bayes))
        low, high = np.searchsorted(t.time, at[[max(k - 1, 0), min(k + 1, at.size - 1)]])
        near = np.setdiff1d(t.time[low : high + 1][:: -(-(high + 1 - low) // CLOSE)], at)
        order = np.argsort(at := np.append(at, near))
        bayes = np.append(bayes, slip_bayes(evidence, [(e, t, float(x)) for x in near], values))[order]
        at, prior = at[order], condition_prior(share / len(evidence.tests))
        density = float(logsumexp(bayes - bayes.max() + np.log(time_around(at) / np.ptp(t.time))))
        effect = slipped(e, t, float(at[np.argmax(bayes)]))
        out.append(Promising(effect, prior + density, float(bayes.max()) + prior + density - NOTHING.log_prior))
    return out


def slipped(sensor: Effect, test: Test, since: float) -> During:
    """A sensor that is loose from an instant (s) on."""
    return During.of(sensor, Event.of({test.name: [(since, float(test.time[-1]))]}).name)


def slip_bayes(evidence: Evidence, many: Sequence[tuple[Effect, Test, float]], values: Values) -> Array:
    """Log Bayes factor by its tangent of each (sensor, test, since when) against nothing."""
    return tangent_bayes(evidence, [slipped(*one) for one in many], values)[0]


def timed_worth(
    evidence: Evidence, bases: Sequence[Effect], occurrence: TimedEvent, price: float, values: Values
) -> list[Promising]:
    """All that an event may have been.  price : share of what and in which test"""
    again = 0.0 if is_rare(evidence.tests, occurrence.event) else occurrence.repeats  # else a part of the evidence
    share = price * float(np.exp(max(occurrence.log_share + again, -600.0)))  # a share of zero has no logarithm
    return tangent_worth(evidence, bases, occurrence.event.name, share, values)


def tangent_worth(
    evidence: Evidence, bases: Sequence[Effect], condition: str, share: float, values: Values
) -> list[Promising]:
    """Effects while a condition holds, at their linear amplitude; all that leave any trace, however small it is beside
    what a model may be wrong by: the noise and the price of when have that in account.

    share : of the prior of all conditions
    """
    effects, prior = [During.of(base, condition) for base in bases], condition_prior(share)
    bayes, visible = tangent_bayes(evidence, effects, values)
    if occurrence := event(condition):
        bayes -= repeats_price(evidence.tests, occurrence)
    return [
        Promising(e, prior, float(b) + prior - NOTHING.log_prior)
        for e, b, shows in zip(effects, bayes, visible, strict=True)
        if shows
    ]


def tangent_bayes(evidence: Evidence, effects: Sequence[Effect], values: Values) -> tuple[Array, NDArray[np.bool_]]:
    """(K,) log Bayes factors of effects against nothing by their tangents, and which of them leave any trace."""
    parameters = amplitudes(evidence.fit.network, effects)
    parts = effect_columns(evidence.fit, evidence.tests, effects, values)
    scores = fit_score(evidence.fit, parts, np.array([q.sign for q in parameters], int))
    return scores.log_bayes(np.array([q.prior_sd for q in parameters])), scores.visible


def law_errors(evidence: Evidence, values: Values) -> dict[Effect, float]:
    """Declared losses and films that would have to be more or less where an input is large, each with its log prior;
    those that could carry weight."""
    turns = input_levels(evidence)
    effects = [
        Above(f"{x}|{name}>{level:g}")
        for x, names in law_inputs(evidence, list(turns)).items()
        for name in names
        for level in turns[name]
    ]
    if not effects:
        return {}
    prior = law_prior(1.0 / len(effects))
    bayes, visible = tangent_bayes(evidence, effects, values)
    worth = bayes + prior - NOTHING.log_prior
    rows = [Promising(e, prior, float(x)) for e, x, shows in zip(effects, worth, visible, strict=True) if shows]
    return {c.effect: prior for c in best(rows, LAWS)}


def law_inputs(evidence: Evidence, inputs: Sequence[str]) -> dict[str, list[str]]:
    """Declared losses with every input, but for those whose law is not in doubt; films with those they follow."""
    network = evidence.fit.network
    losses = {s.name: list(inputs) for s in network.sources if not s.origin and s.kind not in EXACT_LOSSES}
    films = [x for x in network.links if not x.origin and is_film(network, x)]
    return losses | {x.name: [r for r in x.law.reads if r in inputs] for x in films}


def input_levels(evidence: Evidence) -> dict[str, list[float]]:
    """Input -> values at which its law may turn."""
    out = {}
    for name in _inputs(evidence):
        u = np.abs(np.concatenate([t.inputs[name] for t in evidence.tests if name in t.inputs]))
        at = [float(f"{x:.2g}") for x in np.quantile(u, LEVELS)]
        if np.ptp(u) > VARIED * u.max() and all(name in t.inputs for t in evidence.tests):
            out[name] = list(dict.fromkeys(x for x in at if 0.0 < x < u.max()))
    return out
