"""The log evidence of what may be missing, by tangents about a calibrated state, under one noise and model error.

Under a linear model with Gaussian noise and model error the log Bayes factor of effects A against nothing is closed:
with u, V the efficient score and its covariance, and amplitudes a ~ half-normal(s) where physics has a sign,

    log BF = 1/2 u'(V + S^-1)^-1 u - 1/2 log det(1 + V S) + log P(sign a | readings) / P(sign a),  S = diag(s^2)

averaged over a few s, since nobody knows the usual size well. What carries weight is refitted (refit.py).
Source: Kass and Raftery 1995; Kaipio and Somersalo 2005 for the model error in V.
"""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from geom.arrays import Array
from geom.errors import InputError, NoSolution
from lumped.model.multipliers import parameter_values, values_of
from lumped.model.network import Network, Parameter
from measured.case import Case, Test
from measured.doubt import PRIOR, SIZES, USUAL, nats_worth
from validation.calibration.calibrate import (
    CachedSegments,
    Fit,
    InnerProduct,
    calibrated,
    minimise,
    no_progress,
    with_model_error,
)
from validation.comparison.linearisation import Segment, segments
from validation.effects.base import Effect
from validation.effects.during import During
from validation.effects.registry import catalogue, extended
from validation.inference.columns import Linearised, effect_columns, exchange_columns, finite_change, split_columns
from validation.inference.hypotheses import NOTHING, Cause, Hypothesis, Together, Weighed, catalogue_priors, weights
from validation.inference.score import (
    Gram,
    Score,
    fit_gram,
    fit_prior,
    fit_score,
    log_sign_gain,
    one_size,
    score,
    total,
)
from validation.noise import START, Noise, fit_noise
from validation.parameters.reference import effect_sizes
from validation.parameters.unknowns import Unknowns, at_level, case_reference, scene_of, unbound, widened, working
from validation.threads import side_by_side

Progress = Callable[[str], None]
Jump = tuple[float, Sequence[Array]]  # a large amplitude, and what it does to every segment (K)
NO_JUMPS: Mapping[str, Jump] = MappingProxyType({})
TWIN = 0.9995  # cosine from which a calibrated parameter does the same as an effect
ENOUGH = 0.1  # nats: evidence is read to a few tenths
ROUNDS = 12  # steps of a calibration gone on under the model error: what nothing gains too little, all gain too much
FURTHER = 6  # steps of one gone on under another noise
PAIRS = 2000  # of most weight are kept, of all: what is left out has less than each of them
CONTENDERS = 8  # effects whose own noise is looked at: one of them leads under any
ABSENT = 0.02  # of its usual size: an effect this small is not there
POWER = 0.842  # normal quantile of 80 %
HALVINGS = 60  # of the interval up to FARTHEST: past the last bit of a number
FARTHEST = 1e4  # prior deviations: beyond them an effect is never seen


@dataclass(frozen=True)
class LoudNoise:
    """The noise that nothing asks for: what a refit under the noise of the evidence is worth under that one.

    over : log evidence (nats) of nothing under it over that under the other, both fitted anew
    gap : objective of nothing under it over that under the other
    """

    noise: Noise
    over: float
    gap: float

    @classmethod
    def create(cls, evidence: "Evidence", loud: "Evidence") -> "LoudNoise":
        over = log_evidence(loud.fit) - log_evidence(evidence.fit)
        return cls(loud.fit.noise, over, loud.fit.objective - evidence.fit.objective)

    def evidence(self, fit: Fit, bayes: float) -> float:
        """Of a refit as it stands, over that of nothing under the other noise.  bayes : under the other, by itself"""
        here, there = (InnerProduct(fit.parts, x, fit.error).square(fit.parts) for x in (fit.noise, self.noise))
        return self.over + self.gap + bayes - 0.5 * (there - here)


@dataclass(frozen=True)
class Evidence:
    """The score of K causes at one calibrated state; calibrated parameters and model error are projected out.

    network : the model with all causes at zero;  run : its response to them about the fit
    jumps : name of a cause -> its large amplitude and what that does, where a tangent says too little
    grams : per test, of [nuisances and model error, causes, residual] under the fit's noise
    whole : (K,) evidence (nats) of a finite amplitude where a tangent says too little, -inf elsewhere
    loud : the larger noise under which refits are weighed as well
    """

    tests: tuple[Test, ...]
    fit: Fit
    network: Network
    causes: tuple[Cause, ...]
    run: Linearised
    jumps: Mapping[str, Jump]
    grams: Mapping[str, Gram]
    score: Score
    whole: Array
    loud: LoudNoise | None = None

    @cached_property
    def names(self) -> tuple[str, ...]:
        return tuple(c.name for c in self.causes)

    @cached_property
    def effects(self) -> tuple[Effect, ...]:
        return tuple(c.effect for c in self.causes)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        return tuple(c.parameter for c in self.causes)

    @property
    def scale(self) -> Array:
        """(K,) usual size of each cause's amplitude."""
        return np.array([c.parameter.prior_sd for c in self.causes])

    @property
    def prior(self) -> Array:
        """(K,) prior probability of each cause alone."""
        return np.exp([c.log_prior for c in self.causes])

    @cached_property
    def repeats(self) -> Array:
        """(K,) what it costs (nats) to say when each cause was again."""
        return np.array([c.repeats(self.tests) for c in self.causes])

    @property
    def p(self) -> int:
        """Number of calibrated parameters."""
        return len(self.fit.unknowns.parameters)

    @property
    def parts(self) -> tuple[Segment, ...]:
        """Segments with the columns of calibrated parameters, then of all causes."""
        return self.run.segments(self.causes)

    @cached_property
    def twins(self) -> list[str | None]:
        """For each cause the free parameter that does the same, if there is one."""
        G, p = total(self.grams), self.p
        scale = np.sqrt(np.outer(np.diag(G.JJ)[:p], np.diag(G.ZZ)))
        alike = np.abs(G.JZ[:p]) / np.where(scale > 0, scale, np.inf)
        best = np.argmax(alike, axis=0)
        return [self.fit.unknowns.names[j] if alike[j, k] > TWIN else None for k, j in enumerate(best)]

    def hypothesis(self, members: Sequence[int], log_prior: float = 0.0) -> Hypothesis:
        """That some causes are there together, or nothing where they are none.  log_prior : of a set of several"""
        if len(members) == 1:
            return self.causes[members[0]]
        return Together(tuple(self.causes[k] for k in members), log_prior) if members else NOTHING

    def name(self, h: Weighed) -> str:
        """ "nothing", "heat@place", or the causes' names with " + " between them."""
        return f"heat@{h.heat}" if h.heat else self.hypothesis(h.members).name


def candidates(case: Case, kinds: Sequence[str] | None = None) -> tuple[Effect, ...]:
    """The effects of the catalogue that can sit on this case and are not in its model.  kinds : only these"""
    inside = {e.name for e in case.model.effects}
    effects = tuple(e for e in catalogue(scene_of(case), kinds) if e.name not in inside)
    if not effects:
        where = f"case '{case.name}', kinds {', '.join(kinds or ['of the catalogue'])}"
        raise InputError("no effect can sit anywhere in this network", where, "other kinds, or inputs that they need")
    return effects


def calibrated_case(case: Case, progress: Progress = no_progress, start: Mapping[str, float] | None = None) -> Fit:
    """The model calibrated on every test but the held-out ones, model error in account.  start : values to begin at"""
    network, unknowns = working(case)
    values, tests = {**case.model.values, **(start or {})}, case.usable
    fixed = parameter_values(network, values)
    plain = calibrated(network, tests, unknowns, values, 1, progress, rough=True)
    return with_model_error(plain, tests, fixed, case.doubt, ROUNDS)


def continued(fit: Fit, tests: Sequence[Test], noise: Noise, steps: int, cache: CachedSegments) -> Fit:
    """A fit that goes on under a noise, with its own model error and all that is not free where it was."""
    fixed = values_of(fit.network, fit.values)
    return minimise(
        fit.network, tests, fit.unknowns, fit.theta, noise, fixed, steps, cache, worth=ENOUGH, error=fit.error
    )


def scored(case: Case, effects: Sequence[Effect], fit: Fit, priors: Mapping[str, float] | None = None) -> Evidence:
    """The evidence of some effects about a calibrated state: one run of every test with the tangents of all.

    Parameters: `priors` log prior of each effect by name, by default those of the catalogue.
    """
    priors = catalogue_priors(effects) if priors is None else priors
    network, names = extended(fit.network, effects), [e.name for e in effects]
    sizes = effect_sizes(network, set(names), case.usable)
    network = at_level(network, names, replace(case_reference(case), sizes=sizes))
    by_name = {q.name: q for q in network.parameters}
    causes = tuple(Cause(e, by_name[e.name], priors[e.name]) for e in effects)
    tests, values = case.usable, {**parameter_values(network, case.model.values), **fit.values}
    free = (*fit.unknowns.parameters, *(c.parameter for c in causes))
    run = split_columns(segments(network, tests, values, free), len(fit.unknowns.parameters), names)
    columns = exchange_columns(run.parts, effects, [run.tangents[n] for n in names])
    fit = continued(fit, tests, fit.noise, 0, CachedSegments(run.parts, nearby=False))
    run = Linearised(fit.parts, dict(zip(names, columns, strict=True)))
    # every large amplitude is run, whatever its tangent says: a joint at a fifth may well have none
    far, changes = [(k, a) for k, e in enumerate(effects) for a in e.large], {}
    for k, a in far:
        with suppress(NoSolution):  # so large it cannot be: the machine would run away
            changes[k, a] = finite_change(network, tests, run.parts, effects[k], {**values, names[k]: a})
    worth = dict(zip(changes, finite_evidence(fit, run, list(changes.values())), strict=True))
    best = {k: max((a for i, a in changes if i == k), key=lambda a, k=k: worth[k, a]) for k, _ in changes}  # type: ignore[misc]
    return assembled(tests, fit, network, causes, run, {names[k]: (a, changes[k, a]) for k, a in best.items()})


def finite_evidence(fit: Fit, run: Linearised, changes: Sequence[Sequence[Array]]) -> Array:
    """Evidence (nats) that some effects are there at a large amplitude: a joint at a fifth of its conductance bends
    the machine more than its tangent says.  changes : of each, (n, 1) K for every segment"""
    if not changes:
        return np.zeros(0)
    parts = [replace(s, J=np.column_stack([s.J, *(c[i] for c in changes)])) for i, s in enumerate(run.parts)]
    s = fit_score(fit, parts)
    return np.asarray(s.u - 0.5 * np.diag(s.V))


def assembled(
    tests: tuple[Test, ...],
    fit: Fit,
    network: Network,
    causes: Sequence[Cause],
    run: Linearised,
    jumps: Mapping[str, Jump] = NO_JUMPS,
) -> Evidence:
    """The evidence under the fit's noise and model error."""
    grams = fit_gram(fit, run.segments(causes))
    scores = score(total(grams), *fit_prior(fit), np.array([c.parameter.sign for c in causes], int))
    whole = np.where([c.effect.whole for c in causes], scores.u - 0.5 * np.diag(scores.V), -np.inf)
    jumps = {c.name: jumps[c.name] for c in causes if c.name in jumps}
    index = {c.name: k for k, c in enumerate(causes)}
    whole[[index[n] for n in jumps]] = finite_evidence(fit, run, [columns for _, columns in jumps.values()])
    return Evidence(tests, fit, network, tuple(causes), run, jumps, grams, scores, whole)


def joined(
    evidence: Evidence, effects: Mapping[Effect, float], values: Mapping[str, float], places: Sequence[int] = ()
) -> Evidence:
    """The evidence with further effects.

    Parameters: `effects` each with its log prior; `values` of what is not calibrated; `places` indices of the causes
    that they replace, one after the other; behind all others where there is none.
    """
    if not effects:
        return evidence
    e, new = evidence, list(effects)
    network = extended(e.network, new)
    added = network.parameters[-len(new) :]
    causes = [*e.causes, *(Cause(x, q, effects[x]) for x, q in zip(new, added, strict=True))]
    columns = split_columns(effect_columns(e.fit, e.tests, new, values), e.p, [x.name for x in new])
    run = Linearised(e.run.parts, {**e.run.tangents, **columns.tangents})
    if places:
        order = {k: n for n, k in enumerate(places, len(e.causes))}
        causes = [causes[order.get(k, k)] for k in range(len(e.causes))]
    return assembled(e.tests, e.fit, network, causes, run, e.jumps)


def recalibrated(evidence: Evidence, noise: Noise) -> Evidence:
    """The evidence under another noise, the calibration gone on under it."""
    return moved_evidence(evidence, continued_fit(evidence.fit, evidence.tests, noise))


def continued_fit(fit: Fit, tests: Sequence[Test], noise: Noise) -> Fit:
    """A calibration that goes on under another noise, with the tangents of where it stands."""
    return continued(fit, tests, noise, FURTHER, CachedSegments(fit.parts, nearby=True))


def converged(evidence: Evidence) -> Evidence:
    """The evidence with nothing fitted to its end under its noise, by tangents of its own there.

    What nothing falls short of its end, every effect gains.
    """
    cache = CachedSegments(evidence.fit.parts, nearby=False, stale=True)
    return moved_evidence(evidence, continued(evidence.fit, evidence.tests, evidence.fit.noise, ROUNDS, cache))


def moved_evidence(evidence: Evidence, fit: Fit) -> Evidence:
    """The evidence about another calibration; causes keep the tangents they had."""
    e = evidence
    return assembled(e.tests, fit, e.network, e.causes, replace(e.run, parts=fit.parts), e.jumps)


def quiet(evidence: Evidence) -> Evidence:
    """The evidence under a noise no larger than is usual, calibrated under it; the same where it is no larger.

    What held in one test or for a while must not pass for noise of them all.
    """
    noise = usual_noise(evidence.fit.noise)
    return evidence if noise == evidence.fit.noise else recalibrated(evidence, noise)


def quiet_fit(fit: Fit, tests: Sequence[Test]) -> Fit:
    """A calibration under a noise no larger than is usual; the same where it is no larger."""
    noise = usual_noise(fit.noise)
    return fit if noise == fit.noise else continued_fit(fit, tests, noise)


def usual_noise(noise: Noise) -> Noise:
    """Every part of a noise no larger than a good model leaves, in units of the error usual for each record."""
    cap = {"white": START.white, "fast": USUAL["fast"], "slow": START.slow}
    small = {n: replace(x, **{k: min(getattr(x, k), most) for k, most in cap.items()}) for n, x in noise.levels.items()}
    return replace(noise, levels=small)


def log_evidence(fit: Fit, noise: Noise | None = None) -> float:
    """Log evidence (nats) of the readings under a noise, calibration and model error integrated out by tangents.

    Parameters: `noise` by default that of the fit. It is normalised: a large noise pays for what it leaves room for.
    """
    other = fit if noise is None else replace(fit, noise=noise)
    return calibration_evidence(other, fit.parts, total(fit_gram(other, fit.parts)))


def calibration_evidence(fit: Fit, parts: Sequence[Segment], G: Gram) -> float:
    """The same from the Gram matrix of some segments; what it holds of effects is left out."""
    theta, sd = fit_prior(fit)
    weight = sd**-2.0
    g = G.Jr - weight * theta
    H = G.JJ + np.diag(weight)
    left = G.rr + theta @ (weight * theta) - g @ np.linalg.solve(H, g)
    wide = np.linalg.slogdet(H)[1] + 2.0 * np.sum(np.log(sd)) + sum(fit.noise.logdet(s) for s in parts)
    return float(-0.5 * (left + wide) + fit.noise.log_prior(parts))


def noise_evidence(evidence: Evidence, members: Sequence[int], noise: Noise) -> float:
    """Log evidence (nats) of some causes of usual size under another noise, by tangents."""
    e, h = evidence, evidence.hypothesis(members)
    fit, parts = replace(e.fit, noise=noise), e.run.segments([h])
    G = total(fit_gram(fit, parts))
    s = score(G, *fit_prior(fit), h.sign)
    H = s.V + np.diag(h.scale**-2.0)
    log_det = np.linalg.slogdet(np.diag(h.scale) @ H @ np.diag(h.scale))[1]
    gain = float(0.5 * s.u @ np.linalg.solve(H, s.u) - 0.5 * log_det - np.sum(e.repeats[list(members)]))
    return calibration_evidence(fit, parts, G) + gain


def leftover_noise(evidence: Evidence, members: Sequence[int]) -> Noise:
    """The noise of what calibration, model error and some causes leave, by tangents."""
    e, (theta, sd) = evidence, fit_prior(evidence.fit)
    G, q = total(e.grams).subset(members), theta.size
    wide = np.array([widened(e.causes[k].parameter).prior_sd for k in members])
    weight = np.concatenate([sd, wide]) ** -2.0
    A = np.block([[G.JJ, G.JZ], [G.JZ.T, G.ZZ]])
    b = np.concatenate([G.Jr, G.Zr]) - weight * np.concatenate([theta, np.zeros(len(members))])
    x = np.linalg.solve(A + np.diag(weight), b)
    step, error = np.concatenate([x[: e.p], x[q:]]), e.fit.error
    parts = e.run.segments([e.hypothesis(members)])
    return fit_noise([replace(s, r=s.r - s.J @ step - (error.of(s) @ x[e.p : q] if error else 0.0)) for s in parts])


def sharpened(evidence: Evidence, also: Sequence[int] = (), rounds: int = 2) -> Evidence:
    """The evidence under the noise that is left beside the leading cause: what is missing is not noise.

    also : causes that may lead, most probable first, although they seem small beside the noise of nothing
    """
    for _ in range(rounds):
        noise = leader_noise(evidence, also)
        if noise is None:
            break
        evidence = recalibrated(evidence, noise)
    return evidence


def leader_noise(evidence: Evidence, also: Sequence[int] = ()) -> Noise | None:
    """The noise left beside the cause that, with its own noise, has most evidence; None where nothing has more."""
    e, ones = evidence, singles(evidence)
    leading = [k for i in np.argsort(-weights(ones), kind="stable") for k in ones[i].members if not e.effects[k].whole]
    few = [ones[1 + k] for k in dict.fromkeys([*leading[:CONTENDERS], *also[:CONTENDERS]])]

    def leftover_evidence(h: Weighed) -> tuple[float, Noise]:
        noise = leftover_noise(e, h.members)
        return noise_evidence(e, h.members, noise) + h.log_prior, noise

    gain, noise = max(side_by_side(leftover_evidence, few), key=lambda x: x[0], default=(-np.inf, None))
    return noise if gain > log_evidence(e.fit) + ones[0].log_prior else None


def singles(evidence: Evidence) -> list[Weighed]:
    """Nothing, and each cause by itself."""
    bayes = single_evidence(evidence)
    one = [Weighed((k,), "", c.log_prior, float(bayes[k])) for k, c in enumerate(evidence.causes)]
    return [Weighed(log_prior=NOTHING.log_prior), *one]


def single_evidence(evidence: Evidence) -> Array:
    """(K,) log Bayes factor of each cause against nothing; of a joint or a clock also at a large amplitude, of plugs
    exchanged."""
    tangent = evidence.score.log_bayes(evidence.scale) - evidence.repeats
    both = np.logaddexp(tangent, evidence.whole) - np.where(np.isfinite(evidence.whole), np.log(2.0), 0.0)
    return np.asarray(np.where([e.whole for e in evidence.effects], evidence.whole, both))


def pairs(evidence: Evidence, ones: Sequence[Weighed]) -> list[Weighed]:
    """Every two causes, in proportion to the prior of each; those of most weight."""
    e, prior, alone = evidence, evidence.prior, single_evidence(evidence)
    usable = [h for h in ones if h.members and not e.effects[h.members[0]].whole and e.score.visible[h.members[0]]]
    usable.sort(key=lambda h: -(h.log_prior + h.log_bayes))
    few = np.array([h.members[0] for h in usable], int)
    i, j = np.triu_indices(few.size, 1)
    a, b = few[i], few[j]
    every = (np.sum(prior) ** 2 - np.sum(prior**2)) / 2.0
    log_prior = np.log(PRIOR["two"].share * prior[a] * prior[b] / every)
    more = np.maximum(alone + e.repeats - e.score.log_bayes(e.scale), 0.0)  # beyond its tangent, at a large amplitude
    bayes = pair_evidence(e, a, b) + np.maximum(more[a], more[b])
    likely = np.sort(np.argsort(-(log_prior + bayes), kind="stable")[:PAIRS])
    return [Weighed((int(a[n]), int(b[n])), "", float(log_prior[n]), float(bayes[n])) for n in likely]


def pair_evidence(evidence: Evidence, a: NDArray[np.int64], b: NDArray[np.int64]) -> Array:
    """Log Bayes factors (nats) of pairs (a_i, b_i) against nothing: two-by-two systems, all at once."""
    s, sd = evidence.score, evidence.scale
    out = []
    for f in SIZES:
        A, B = s.V[a, a] + (f * sd[a]) ** -2.0, s.V[b, b] + (f * sd[b]) ** -2.0
        X, det = s.V[a, b], np.maximum(A * B - s.V[a, b] ** 2, 1e-300)
        ma, mb = (B * s.u[a] - X * s.u[b]) / det, (A * s.u[b] - X * s.u[a]) / det
        gain = 0.5 * (s.u[a] * ma + s.u[b] * mb) - 0.5 * np.log((f * sd[a]) ** 2 * (f * sd[b]) ** 2 * det)
        signed = [log_sign_gain(m / np.sqrt(Y / det), s.sign[k]) for m, Y, k in ((ma, B, a), (mb, A, b))]
        out.append(gain + signed[0] + signed[1])
    return np.asarray(logsumexp(out, axis=0) - np.log(len(SIZES)) - evidence.repeats[a] - evidence.repeats[b])


def averaged_noise(hypotheses: Sequence[Weighed], loud: Evidence, over: float) -> list[Weighed]:
    """The hypotheses with their evidence under a larger noise as well, so that what is merely noisier is a rival.

    over : log evidence of nothing under that noise over the one it has without.  Heat of unknown cause gains nothing
    there.
    """
    alone, many = single_evidence(loud), [h.members for h in hypotheses if len(h.members) == 2]
    both = pair_evidence(loud, *np.array(many, int).reshape(-1, 2).T)
    gain: dict[Any, float] = {(): 0.0, **{(k,): x for k, x in enumerate(alone)}, **dict(zip(many, both, strict=True))}
    return [replace(h, loud=over + float(gain[h.members])) for h in hypotheses]


def thresholds(evidence: Evidence) -> Array:
    """(K,) log Bayes factor from which each cause is more probable than nothing, temper in account."""
    return np.array([nats_worth(NOTHING.log_prior - c.log_prior) for c in evidence.causes])


def smallest_visible(evidence: Evidence) -> Array:
    """(K,) smallest amplitude whose evidence outweighs nothing four times in five, inf where none does; linear."""
    s, sd = evidence.score, evidence.scale
    V, limit, side = np.diag(s.V), thresholds(evidence), np.where(s.sign == 0, 1, s.sign)
    low, high = np.zeros_like(sd), FARTHEST * sd

    def passes(a: Array) -> NDArray[np.bool_]:
        u = side * np.maximum(a * V - POWER * np.sqrt(np.maximum(V, 0.0)), 0.0)
        return one_size(u, V, sd, s.sign) > limit

    never = ~s.visible | ~passes(high)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        detectable = passes(middle)
        low, high = np.where(detectable, low, middle), np.where(detectable, middle, high)
    return np.where(never, np.inf, high)


def fitted_members(evidence: Evidence, members: Sequence[int]) -> list[int]:
    """Those whose amplitude is fitted; the others happen whole or not at all."""
    return [k for k in members if not evidence.effects[k].whole]


def with_members(evidence: Evidence, members: Sequence[int]) -> tuple[Network, Unknowns, dict[str, float]]:
    """The network with some causes, what is free in it, and the values of all that is not (whole causes at one)."""
    fit = evidence.fit
    network = evidence.hypothesis(members).extend(fit.network)
    each = fitted_members(evidence, members)  # a lid that is opened or a fan may be of any size
    free = [(unbound if isinstance(evidence.effects[k], During) else widened)(evidence.parameters[k]) for k in each]
    fixed = {evidence.names[k]: 1.0 for k in members if evidence.effects[k].whole}
    return network, Unknowns((*fit.unknowns.parameters, *free)), values_of(network, {**fit.values, **fixed})


def log_bayes(evidence: Evidence, fit: Fit, members: Sequence[int]) -> float:
    """Log evidence over that of nothing: the gain at the optimum, times what the prior of the amplitudes gives there.

    Calibrated parameters are integrated by their curvature at either optimum: what leaves them wider gains by that.
    """
    free, p = fitted_members(evidence, members), evidence.p
    curvature = [np.linalg.slogdet(f.H[:p, :p])[1] for f in (evidence.fit, fit)]
    gain = evidence.fit.objective - fit.objective + 0.5 * float(curvature[0] - curvature[1])
    if not free:
        return gain
    h, a, wide = evidence.hypothesis(free), fit.theta[p:], fit.unknowns.sd[p:]
    # the fit's own wide prior of the amplitudes is taken out of its objective, and the usual one integrated instead
    gain += 0.5 * float(np.sum((a / wide) ** 2))
    v = amplitude_covariance(fit, p, wide)
    if np.all(np.abs(a) < ABSENT * h.scale):  # what moved is the calibration, which may go on without them as well
        gain = min(gain, 0.0)
    mass = logsumexp([_log_prior_mass(a, v, f * h.scale, h.sign) for f in SIZES]) - np.log(len(SIZES))
    return gain + float(mass - np.sum(evidence.repeats[free]))


def amplitude_covariance(fit: Fit, p: int, wide: Array) -> Array:
    """Covariance of the amplitudes by the readings alone; what these do not feel is as wide as the fit's prior."""
    H = fit.H
    felt = H[p:, p:] - H[p:, :p] @ np.linalg.solve(H[:p, :p], H[:p, p:]) - np.diag(wide**-2.0)
    values, vectors = np.linalg.eigh(felt * np.outer(wide, wide))
    return np.asarray((vectors / np.maximum(values, 1.0)) @ vectors.T * np.outer(wide, wide))


def _log_prior_mass(a: Array, v: Array, sd: Array, sign: NDArray[np.int64]) -> float:
    """log of the integral of exp(-1/2 (x - a)' v^-1 (x - a)) over the prior of x, signs in account."""
    wide = v + np.diag(sd**2)
    posterior = np.linalg.inv(np.linalg.inv(v) + np.diag(sd**-2.0))
    mean = posterior @ np.linalg.solve(v, a)
    log = -0.5 * a @ np.linalg.solve(wide, a) + 0.5 * (np.linalg.slogdet(v)[1] - np.linalg.slogdet(wide)[1])
    return float(log + np.sum(log_sign_gain(mean / np.sqrt(np.diag(posterior)), sign)))
