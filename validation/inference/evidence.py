"""What a diagnosis rests on: the calibrated model, its model error, the efficient score of every candidate effect."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import permutations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError, NoSolution
from lumped.model.multipliers import parameter_values, values_of
from lumped.model.network import Network, Parameter
from measured.case import Case, Test
from validation.calibration.calibrate import (
    CachedSegments,
    Fit,
    InnerProduct,
    calibrated,
    minimise,
    no_progress,
    with_model_error,
)
from validation.comparison.linearisation import Segment, reach, segments
from validation.effects import Effect, catalogue, extended
from validation.inference.score import Gram, Score, gram, grams, score, total
from validation.noise import Noise, fit_noise
from validation.parameters.reference import effect_sizes
from validation.parameters.unknowns import Unknowns, at_level, case_reference, scene_of, widened, working

Array = NDArray[np.float64]
TWIN = 0.9995  # cosine from which a calibrated parameter does the same as an effect
ENOUGH = 0.1  # nats: evidence is read to a few tenths
FINE = 0.02  # nats at which what is told stands: a size is then within a quarter of its deviation of its optimum
STRAIGHT = 0.9  # of the gain that tangents predict: a refit that got it needs none of its own
BENDS = 10.0  # nats that a refit gains, beyond which the tangents of its start point elsewhere at its end
HOPELESS = 20.0  # nats worse than nothing after a first refit: no second one makes up for that
LEAN = 0.5  # nats that a tangent gains at a large amplitude before it pays for its own size
SECOND = 6  # steps of a refit under tangents of its own: with three, some stopped tens of nats short
ROUNDS = (
    12  # steps of a calibration that goes on under the model error: what nothing gains too little, all gain too much
)
FURTHER = 6  # of one that goes on under another noise


@dataclass(frozen=True)
class Evidence:
    """The score of candidates at one calibrated state; calibrated parameters and model error are projected out.

    network : the model with all candidates at zero;  parts : segments with nuisance, then candidate columns
    grams : per test, of [nuisances and model error, candidates, residual] under the fit's noise
    jumps : effect -> what it does to every segment (K) at a large amplitude, where a tangent says too little
    large : effect -> that amplitude
    whole : (K,) evidence (nats) of a finite amplitude where a tangent says too little, -inf elsewhere
    """

    tests: tuple[Test, ...]
    fit: Fit
    network: Network
    effects: tuple[Effect, ...]
    parameters: tuple[Parameter, ...]
    parts: tuple[Segment, ...]
    grams: Mapping[str, Gram]
    score: Score
    jumps: Mapping[int, Sequence[Array]]
    large: Mapping[int, float]
    whole: Array

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(e.name for e in self.effects)

    @property
    def p(self) -> int:
        """Number of calibrated parameters."""
        return len(self.fit.unknowns.parameters)

    @cached_property
    def twins(self) -> list[str | None]:
        """For each effect the free parameter that does the same, if there is one."""
        G, p = total(self.grams), self.p
        scale = np.sqrt(np.outer(np.diag(G.JJ)[:p], np.diag(G.ZZ)))
        alike = np.abs(G.JZ[:p]) / np.where(scale > 0, scale, np.inf)
        best = np.argmax(alike, axis=0)
        return [self.fit.unknowns.names[j] if alike[j, k] > TWIN else None for k, j in enumerate(best)]

    @property
    def reach(self) -> Array:
        """(K,) largest change of any reading (K) by one unit of each effect."""
        return reach(self.parts)[self.p :]

    def parts_of(self, few: Sequence[int]) -> tuple[Segment, ...]:
        """The segments with nuisance columns and those of some effects."""
        columns = [*range(self.p), *(self.p + k for k in few)]
        return tuple(replace(s, J=s.J[:, columns]) for s in self.parts)


def candidates(case: Case, kinds: Sequence[str] | None = None) -> tuple[Effect, ...]:
    """The catalogue on this case, less what the model has already."""
    inside = {e.name for e in case.model.effects}
    effects = tuple(e for e in catalogue(scene_of(case), kinds) if e.name not in inside)
    if not effects:
        where = f"case '{case.name}', kinds {', '.join(kinds or ['of the catalogue'])}"
        raise InputError("no effect can sit anywhere in this network", where, "other kinds, or inputs that they need")
    return effects


def calibrated_case(
    case: Case, progress: Callable[[str], None] = no_progress, start: Mapping[str, float] | None = None
) -> Fit:
    """The model calibrated on every test but the held-out ones, model error in account."""
    network, unknowns = working(case)
    values, tests = {**case.model.values, **(start or {})}, case.usable
    fixed = parameter_values(network, values)
    plain = calibrated(network, tests, unknowns, values, 1, progress, rough=True)
    return with_model_error(plain, tests, fixed, case.doubt, ROUNDS)


def scored(case: Case, effects: Sequence[Effect], fit: Fit) -> Evidence:
    """One run of every test with all candidates' tangents at a calibrated state."""
    network, names = extended(fit.network, effects), {e.name for e in effects}
    sizes = effect_sizes(network, names, case.usable)
    network = at_level(network, names, replace(case_reference(case), sizes=sizes))
    by_name = {p.name: p for p in network.parameters}
    parameters = tuple(by_name[e.name] for e in effects)
    tests, p = case.usable, len(fit.unknowns.parameters)
    values = {**parameter_values(network, case.model.values), **fit.values}
    parts = tuple(segments(network, tests, values, (*fit.unknowns.parameters, *parameters)))
    exchange(parts, effects, p)
    nuisance_parts = [replace(s, J=s.J[:, :p]) for s in parts]
    fit = minimise(
        fit.network,
        tests,
        fit.unknowns,
        fit.theta,
        fit.noise,
        values_of(fit.network, fit.values),
        0,
        CachedSegments(nuisance_parts, nearby=False),
        error=fit.error,
    )
    evidence = weighed(tests, fit, network, tuple(effects), parameters, parts, {}, {})
    there = {}
    for k, a in likely(evidence):
        with suppress(NoSolution):  # so large it cannot be: the machine would run away
            there[k, a] = jump(evidence, k, {**values, effects[k].name: a})
    worth = dict(zip(there, finite(fit, parts, there), strict=True))
    best = {k: max((a for i, a in there if i == k), key=lambda a, k=k: worth[k, a]) for k, _ in there}  # type: ignore[misc]
    jumps = {k: there[k, a] for k, a in best.items()}
    return weighed(tests, fit, network, tuple(effects), parameters, parts, jumps, best)


def likely(evidence: Evidence) -> list[tuple[int, float]]:
    """Effects and large amplitudes that the readings lean to, by their tangents, and those of clocks: others need no
    run so large."""
    far = [(k, a) for k, e in enumerate(evidence.effects) for a in e.large]
    return [(k, a) for k, a in far if a * evidence.score.u[k] > LEAN or evidence.effects[k].fault]


def jump(evidence: Evidence, k: int, values: Mapping[str, float]) -> list[Array]:
    """What an effect does to every segment (K) at some values; a clock is of its own test alone."""
    place = evidence.effects[k].place
    acted = [t for t in evidence.tests if t.name == place] or evidence.tests
    new = {(s.test, s.channel): s.r for s in segments(evidence.network, acted, values)}
    return [s.r - new.get((s.test, s.channel), s.r) for s in evidence.parts]


def weighed(
    tests: tuple[Test, ...],
    fit: Fit,
    network: Network,
    effects: tuple[Effect, ...],
    parameters: tuple[Parameter, ...],
    parts: tuple[Segment, ...],
    jumps: Mapping[int, Sequence[Array]],
    large: Mapping[int, float],
) -> Evidence:
    """The score under the fit's noise and model error."""
    sign = np.array([q.sign for q in parameters], int)
    grams = projected(fit, parts)
    theta, sd = extended_prior(fit)
    scores = score(total(grams), theta, sd, sign)
    whole = np.where([e.whole for e in effects], scores.u - 0.5 * np.diag(scores.V), -np.inf)
    whole[list(jumps)] = finite(fit, parts, jumps)
    return Evidence(tests, fit, network, effects, parameters, parts, grams, scores, jumps, large, whole)


def replaced(evidence: Evidence, by_last: Sequence[int]) -> Evidence:
    """The evidence whose last effects take the places of some others."""
    e, p, n = evidence, evidence.p, len(evidence.effects) - len(by_last)
    order = list(range(n))
    for last, k in enumerate(by_last):
        order[k] = n + last
    parts = tuple(replace(s, J=s.J[:, [*range(p), *(p + k for k in order)]]) for s in e.parts)
    keep = {k: e.jumps[k] for k in e.jumps if k not in by_last}
    large = {k: e.large[k] for k in e.large if k not in by_last}
    return weighed(
        e.tests,
        e.fit,
        e.network,
        tuple(e.effects[k] for k in order),
        tuple(e.parameters[k] for k in order),
        parts,
        keep,
        large,
    )


def projected(fit: Fit, parts: Sequence[Segment]) -> dict[str, Gram]:
    """Gram matrices whose nuisances are the calibrated parameters and the model error."""
    p, error = len(fit.unknowns.parameters), fit.error
    if error is None:
        return gram(parts, fit.noise, p)
    return grams([(s, (s.J[:, :p], error.of(s), s.J[:, p:])) for s in parts], fit.noise, p + error.size)


def extended_prior(fit: Fit) -> tuple[Array, Array]:
    """Coordinates and prior deviations of the calibrated parameters, then of the model error."""
    d = fit.error.size if fit.error else 0
    return np.concatenate([fit.theta, np.zeros(d)]), np.concatenate([fit.unknowns.sd, np.ones(d)])


def finite(fit: Fit, parts: Sequence[Segment], jumps: Mapping[Any, Sequence[Array]]) -> Array:
    """Evidence (nats) that some effects are there at a large amplitude: a joint at a fifth of its conductance bends
    the machine more than its tangent foretells."""
    if not jumps:
        return np.zeros(0)
    p = len(fit.unknowns.parameters)
    blocks = [replace(s, J=np.column_stack([s.J[:, :p], *(c[i] for c in jumps.values())])) for i, s in enumerate(parts)]
    theta, sd = extended_prior(fit)
    scores = score(total(projected(fit, blocks)), theta, sd, np.zeros(len(jumps), int))
    return np.asarray(scores.u - 0.5 * np.diag(scores.V))


def exchange(parts: Sequence[Segment], effects: Sequence[Effect], p: int) -> None:
    """Set the columns of exchanged plugs to what was read (y_1 - y_2) instead of what is predicted (T_2 - T_1).

    A model calibrated to exchanged readings has both places at nearly one temperature, so that exchanging its
    predictions would change little; the readings themselves can be exchanged exactly.  p : columns before the effects'
    """
    other = {(a, k): b for k, e in enumerate(effects) if e.whole for a, b in permutations(e.place.split("|"), 2)}
    segment_of = {(s.test, s.channel): s for s in parts}
    for (a, k), b in other.items():
        for s in (s for s in parts if s.channel == a and (s.test, b) in segment_of):
            t = segment_of[s.test, b]
            s.J[:, p + k] = s.r - np.interp(s.time, t.time, t.r) - s.J[:, p + k]


def mended_by_exchange(evidence: Evidence) -> dict[int, float]:
    """All-or-nothing effects that take half or more off the squares they touch, of the model before any calibration,
    with what they take; a model calibrated to exchanged readings hides that they were."""
    e, few = evidence, [k for k, x in enumerate(evidence.effects) if x.whole]
    try:
        parts = segments(
            e.network, e.tests, {q.name: q.value for q in e.network.parameters}, [e.parameters[k] for k in few]
        )
    except NoSolution:  # the declared values alone run away
        return {}
    exchange(parts, [e.effects[k] for k in few], 0)
    out = {}
    for i, k in enumerate(few):
        pairs = [(s.r / s.weight, s.J[:, i] / s.weight) for s in parts if np.any(s.J[:, i])]
        before, after = sum(float(r @ r) for r, _ in pairs), sum(float((r - J) @ (r - J)) for r, J in pairs)
        if after < 0.5 * before:
            out[k] = before - after
    return out


def log_evidence(evidence: Evidence) -> float:
    """Of the readings under the fit's noise (nats), calibration and model error integrated out by tangents.

    With the normalisation of the noise, so that a large noise pays for what it leaves room for.
    """
    return without_effects(evidence.fit, evidence.parts, total(evidence.grams))


def without_effects(fit: Fit, parts: Sequence[Segment], G: Gram) -> float:
    """The same from the Gram matrix of the segments; what it holds of effects is left out."""
    theta, sd = extended_prior(fit)
    weight = sd**-2.0
    g = G.Jr - weight * theta
    H = G.JJ + np.diag(weight)
    left = G.rr + theta @ (weight * theta) - g @ np.linalg.solve(H, g)
    wide = np.linalg.slogdet(H)[1] + 2.0 * np.sum(np.log(sd)) + sum(fit.noise.logdet(s) for s in parts)
    return float(-0.5 * (left + wide) + fit.noise.log_prior(parts))


def evidence_of(fit: Fit, noise: Noise) -> float:
    """Log evidence (nats) of a fit under a noise, all that was fitted integrated out where it stands."""
    other = replace(fit, noise=noise)
    return without_effects(other, fit.parts, total(projected(other, fit.parts)))


def with_noise(evidence: Evidence, members: Sequence[int], noise: Noise) -> float:
    """Log evidence of some effects of usual size under another noise, by tangents."""
    e = evidence
    fit, parts = replace(e.fit, noise=noise), e.parts_of(members)
    theta, sd = extended_prior(fit)
    G = total(projected(fit, parts))
    scores = score(G, theta, sd, e.score.sign[list(members)])
    usual = np.array([e.parameters[k].prior_sd for k in members])
    H = scores.V + np.diag(usual**-2.0)
    gain = (
        0.5 * scores.u @ np.linalg.solve(H, scores.u) - 0.5 * np.linalg.slogdet(np.diag(usual) @ H @ np.diag(usual))[1]
    )
    return without_effects(fit, parts, G) + float(gain)


def under(evidence: Evidence, noise: Noise) -> Evidence:
    """The evidence under another noise, the calibration gone on under it."""
    e = evidence
    return _calibrated_to(e, continuation(e.fit, e.tests, noise, e.parts_of([])))


def converged(evidence: Evidence) -> Evidence:
    """The evidence with nothing fitted to its end under its noise, by tangents of its own there.

    What nothing falls short of its end, every effect gains.
    """
    e, fit = evidence, evidence.fit
    new = minimise(
        fit.network,
        e.tests,
        fit.unknowns,
        fit.theta,
        fit.noise,
        values_of(fit.network, fit.values),
        ROUNDS,
        CachedSegments(fit.parts, nearby=False, stale=True),
        worth=ENOUGH,
        error=fit.error,
    )
    return _calibrated_to(e, new)


def _calibrated_to(evidence: Evidence, fit: Fit) -> Evidence:
    """The evidence about another calibration; candidates keep the tangents they had."""
    e, segment_of = evidence, {(s.test, s.channel): s for s in fit.parts}
    here = [(s, segment_of[s.test, s.channel]) for s in e.parts]
    parts = tuple(replace(s, r=n.r, J=np.column_stack([n.J, s.J[:, e.p :]])) for s, n in here)
    return weighed(e.tests, fit, e.network, e.effects, e.parameters, parts, e.jumps, e.large)


def continuation(fit: Fit, tests: Sequence[Test], noise: Noise, parts: Sequence[Segment]) -> Fit:
    """A calibration that goes on under another noise, with the tangents of where it stands."""
    return minimise(
        fit.network,
        tests,
        fit.unknowns,
        fit.theta,
        noise,
        values_of(fit.network, fit.values),
        FURTHER,
        CachedSegments(parts, nearby=True),
        worth=ENOUGH,
        error=fit.error,
    )


def noise_beside(evidence: Evidence, members: Sequence[int]) -> Noise:
    """The noise of what calibration, model error and some effects leave, by tangents."""
    e, p = evidence, evidence.p
    G, (theta, sd) = total(e.grams), extended_prior(e.fit)
    columns, q = list(members), theta.size
    A = np.block([[G.JJ, G.JZ[:, columns]], [G.JZ[:, columns].T, G.ZZ[np.ix_(columns, columns)]]])
    wide = np.array([widened(e.parameters[k]).prior_sd for k in columns])
    weight = np.concatenate([sd, wide]) ** -2.0
    b = np.concatenate([G.Jr, G.Zr[columns]]) - weight * np.concatenate([theta, np.zeros(len(columns))])
    x = np.linalg.solve(A + np.diag(weight), b)
    error, left = e.fit.error, []
    for s in e.parts:
        response = s.J[:, :p] @ x[:p] + s.J[:, [p + k for k in columns]] @ x[q:]
        left.append(replace(s, r=s.r - response - (error.of(s) @ x[p:q] if error else 0.0)))
    return fit_noise(left)


def refit(
    evidence: Evidence,
    members: Sequence[int],
    theta: Array,
    tangents: Sequence[Segment] = (),
    objective: float | None = None,
) -> Fit:
    """All free parameters and the amplitudes of some candidates, fitted anew; those that are whole are held at one.

    tangents : of all these where the fit begins, by default those without the candidates
    objective : there, by default that without the candidates
    """
    network, unknowns, fixed = with_members(evidence, members)
    free, fit = free_of(evidence, members), evidence.fit
    before = fit.objective if objective is None else objective
    rough = minimise(
        network,
        evidence.tests,
        unknowns,
        theta,
        fit.noise,
        fixed,
        8,
        CachedSegments(tangents or evidence.parts_of(free)),
        worth=ENOUGH,
        error=fit.error,
    )
    far = any(evidence.effects[k].whole for k in members)  # exchanged plugs begin where the calibration is wrong
    straight = rough.gain_ratio > STRAIGHT and before - rough.objective < BENDS
    if straight or (rough.objective > fit.objective + HOPELESS and not far):
        return rough
    return minimise(
        network,
        evidence.tests,
        unknowns,
        rough.theta,
        fit.noise,
        fixed,
        SECOND,
        draft=True,
        worth=ENOUGH,
        error=fit.error,
    )


def tangents_beside(evidence: Evidence, one: int, alone: Fit, others: Sequence[int]) -> dict[int, list[Array]]:
    """What each of some further effects does to every segment (K per unit) where one effect was fitted alone."""
    e, free = evidence, [k for k in others if not evidence.effects[k].whole]
    whole = [one, *free]
    network = extended(e.fit.network, [e.effects[k] for k in whole])
    values = values_of(network, {**e.fit.values, **alone.unknowns.values(alone.theta), **fixed_multipliers(e, [one])})
    parts = segments(network, e.tests, values, [e.parameters[k] for k in free])
    return {k: [s.J[:, i] for s in parts] for i, k in enumerate(free)}


def refit_beside(
    evidence: Evidence, members: Sequence[int], one: int, alone: Fit, columns: Mapping[int, Sequence[Array]]
) -> Fit:
    """Two candidates fitted from where one of them was fitted alone, with its tangents and those of the other there."""
    free, p = free_of(evidence, members), evidence.p
    theta = np.concatenate([alone.theta[:p], [alone.theta[p] if k == one else 0.0 for k in free]])
    tangents = [
        replace(s, J=np.column_stack([s.J[:, :p], *(s.J[:, p] if k == one else columns[k][i] for k in free)]))
        for i, s in enumerate(alone.parts)
    ]
    return refit(evidence, members, theta, tangents, alone.objective)


def refit_onwards(evidence: Evidence, members: Sequence[int], before: Fit, finely: bool = False) -> Fit:
    """A refit that goes on with what it ran last, under another noise; where its effects have new ends, nearby.

    finely : to its end, with tangents of its own there
    """
    network, unknowns, fixed = with_members(evidence, members)
    other_times, fit = before.unknowns.names != unknowns.names, evidence.fit
    cache = CachedSegments(before.parts, nearby=other_times, renewed=True, stale=True)
    steps, worth = (ROUNDS, FINE) if finely else (SECOND, ENOUGH)
    return minimise(
        network,
        evidence.tests,
        unknowns,
        before.theta,
        fit.noise,
        fixed,
        steps,
        cache,
        draft=not finely,
        worth=worth,
        error=fit.error,
    )


def free_of(evidence: Evidence, members: Sequence[int]) -> list[int]:
    """Those whose amplitude is fitted."""
    return [k for k in members if not evidence.effects[k].whole]


def with_members(evidence: Evidence, members: Sequence[int]) -> tuple[Network, Unknowns, dict[str, float]]:
    fit = evidence.fit
    network = extended(fit.network, [evidence.effects[k] for k in members])
    free = [evidence.parameters[k] for k in free_of(evidence, members)]
    unknowns = Unknowns((*fit.unknowns.parameters, *(widened(p) for p in free)))
    return network, unknowns, values_of(network, {**fit.values, **fixed_multipliers(evidence, members)})


def fixed_multipliers(evidence: Evidence, members: Sequence[int]) -> dict[str, float]:
    """Those that happen whole or not at all."""
    return {evidence.names[k]: 1.0 for k in members if evidence.effects[k].whole}


def starts(evidence: Evidence, members: Sequence[int]) -> list[Array]:
    """Where a refit may begin: at the linear amplitudes, and where a tangent says too little at large ones."""
    free = free_of(evidence, members)
    first = first_amplitudes(evidence, free)
    far = [evidence.large.get(k) for k in free]
    points = [first]
    if len(free) == 1 and far[0] is not None:
        points += [np.array([a]) for a in evidence.effects[free[0]].large]
    elif any(a is not None for a in far):
        points.append(np.array([f if a is None else a for a, f in zip(far, first, strict=True)]))
    return [np.concatenate([evidence.fit.theta, a]) for a in points]


def first_amplitudes(evidence: Evidence, members: Sequence[int]) -> Array:
    """Linear estimates, kept to the admissible side and within three prior deviations."""
    few = list(members)
    a, sd = evidence.score.amplitude[few], np.array([evidence.parameters[k].prior_sd for k in few])
    low = np.array([evidence.parameters[k].low for k in few])
    high = np.array([evidence.parameters[k].high for k in few])
    return np.clip(np.clip(a, -3.0 * sd, 3.0 * sd), 0.9 * low, 0.9 * high)


def deviance(evidence: Evidence, fit: Fit) -> dict[tuple[str, str], float]:
    """(test, channel) -> r' noise^-1 r of what a fit and its model error leave."""
    measure = InnerProduct(fit.parts, fit.noise, fit.error)
    left = measure.explained(fit.parts, fit.error)
    return {(s.test, s.channel): float(np.sum(fit.noise.whiten(s, s.r[:, None]) ** 2)) for s in left}
