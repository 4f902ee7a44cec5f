"""The evidence of what carries weight without linearisation: refitted, with Laplace's integral at its own optimum."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from geom.errors import NoSolution
from measured.doubt import SIZES
from validation.calibration.calibrate import Fit, no_progress, residual_noise
from validation.inference.evidence import (
    Evidence,
    evidence_of,
    free_of,
    mended_by_exchange,
    refit,
    refit_beside,
    refit_onwards,
    starts,
    tangents_beside,
)
from validation.inference.posterior import Hypothesis, probabilities, weights
from validation.inference.score import log_sign_gain
from validation.noise import Noise
from validation.threads import side_by_side

Array = NDArray[np.float64]
WarmFits = Mapping[tuple[int, ...], Fit]
Beside = tuple[int, Fit, Mapping[int, Sequence[Array]]]
NOWHERE: WarmFits = MappingProxyType({})
WEIGHT = 0.01  # posterior probability from which a hypothesis is refitted
ABSENT = 0.02  # of its usual size: an effect this small is not there
REPORTED = 0.05  # posterior probability from which a hypothesis is told in the first place
ROUNDS, MOST = 4, 8  # what a refit promotes is refitted too; so many at once
GREAT, NEAR = 10.0, 0.5  # nats beyond which tangents mislead, and the share of the best from which a rival is refitted
IMPOSSIBLE = -1e3  # nats: as good as excluded, and a number that a document can hold
STRAIN = 1.5  # prior deviations of a parameter, from which an effect that does the same is refitted
GAINED = 3.0  # nats of log evidence from which another noise is worth weighing all anew
NEARLY, MOST_LINEAR = 0.4, 3  # linear amplitude, and how many, of effects that happen whole or not at all


def refitted(
    evidence: Evidence,
    hypotheses: Sequence[Hypothesis],
    progress: Callable[[str], None] = no_progress,
    warm_fits: WarmFits = NOWHERE,
    again: Collection[tuple[int, ...]] = (),
) -> list[Hypothesis]:
    """The hypotheses with those that carry weight refitted, until none does that is not.

    warm_fits : members -> a refit of theirs under another noise
    again : members of what carried weight there, and may do so here though its tangents promise too little
    """
    out = list(hypotheses)
    weighty = [i for i, h in enumerate(out) if h.members in again]
    far = dict.fromkeys([*exchanged(evidence, out), *far_from_prior(evidence, out), *rivals(out), *weighty])
    together(evidence, out, list(far), progress, warm_fits)
    for _ in range(ROUNDS):
        P = shares(promised(hypotheses, out))
        due = [i for i in np.argsort(-P) if P[i] > WEIGHT and out[i].members and out[i].fit is None][:MOST]
        due = due or between(out)[:MOST]
        if not due:
            break
        for size in (1, 2):  # two begin where one of them was fitted alone
            together(evidence, out, [i for i in due if len(out[i].members) == size], progress, warm_fits)
    return with_smaller_shortfall(hypotheses, out)


def weighty_refits(hypotheses: Sequence[Hypothesis]) -> list[tuple[int, ...]]:
    """Members of what carries weight once it is refitted."""
    P = shares(hypotheses)
    return [h.members for p, h in zip(P, hypotheses, strict=True) if p > WEIGHT and h.fit and h.members]


def between(hypotheses: Sequence[Hypothesis]) -> list[int]:
    """Pairs without a refit that only exchange what weighty pairs exchange already, most probable first.

    Where a + b and c + b and a + d carry weight, a and c may stand for each other, and c + d is weighed as the three
    are. Its tangents alone promise too little as often as theirs, and whether it is refitted would hang on chance.
    """
    weighty = [m for m in weighty_refits(hypotheses) if len(m) == 2]
    partners: dict[int, set[int]] = {}
    for a, b in weighty:
        partners.setdefault(a, set()).add(b)
        partners.setdefault(b, set()).add(a)

    def closes(m: tuple[int, ...]) -> bool:
        return any(partners.get(m[0], set()) & partners[a] for a in partners.get(m[1], ()))

    P = shares(hypotheses)
    return [
        int(i)
        for i in np.argsort(-P, kind="stable")
        if len(hypotheses[i].members) == 2 and hypotheses[i].fit is None and closes(hypotheses[i].members)
    ]


def together(
    evidence: Evidence, out: list[Hypothesis], due: Sequence[int], progress: Callable[[str], None], warm_fits: WarmFits
) -> None:
    """Refit some hypotheses side by side (the kernel frees the GIL); none depends on another of them."""
    for i in due:
        progress(f"refitting {out[i].name(evidence)}")
    near = all_beside(evidence, out, due)
    refitted = side_by_side(lambda i: laplace(evidence, out[i], near.get(i), warm_fits), due)
    for i, h in zip(due, refitted, strict=True):
        out[i] = h


def all_beside(evidence: Evidence, hypotheses: Sequence[Hypothesis], due: Sequence[int]) -> dict[int, Beside]:
    """For pairs of which one effect was fitted by itself: that fit, and the tangents of all the other effects there,
    in one run."""
    alone = {i: a for i in due if (a := fitted_alone(hypotheses, hypotheses[i].members))}
    fits = {one: fit for one, fit in alone.values()}
    others: dict[int, list[int]] = {one: [] for one in fits}
    for i, (one, _) in alone.items():
        others[one] += [k for k in hypotheses[i].members if k != one]
    columns = {one: tangents_beside(evidence, one, fit, others[one]) for one, fit in fits.items()}
    return {i: (one, fit, columns[one]) for i, (one, fit) in alone.items()}


def promised(before: Sequence[Hypothesis], after: Sequence[Hypothesis]) -> list[Hypothesis]:
    """Two effects gain by tangents what either of them gains by its refit more than by its tangent."""
    return _corrected(before, after, lambda each: max(0.0, *each))


def with_smaller_shortfall(before: Sequence[Hypothesis], after: Sequence[Hypothesis]) -> list[Hypothesis]:
    """Two effects that were not refitted, for there were too many, lose what the refit of either fell short of its
    tangent."""
    return _corrected(before, after, lambda each: min(0.0, *each))


def _corrected(
    before: Sequence[Hypothesis], after: Sequence[Hypothesis], by: Callable[[list[float]], float]
) -> list[Hypothesis]:
    """Pairs without a refit, by what those of their members gained more than their tangents."""
    linear = {h.members[0]: h.log_bayes for h in before if len(h.members) == 1}
    more = {h.members[0]: h.log_bayes - linear[h.members[0]] for h in after if h.fit and len(h.members) == 1}
    gain = [0.0 if h.fit or len(h.members) < 2 else by([more.get(k, 0.0) for k in h.members]) for h in after]
    return [replace(h, log_bayes=h.log_bayes + g) for h, g in zip(after, gain, strict=True)]


def shares(hypotheses: Sequence[Hypothesis]) -> Array:
    """Probabilities; of what has a name those without heat of unknown cause, which is not refitted and may hide it."""
    P, with_cause = probabilities(hypotheses), np.array([not h.heat for h in hypotheses])
    return np.where(with_cause, P / max(float(P[with_cause].sum()), 1e-300), P)


def fitted_alone(hypotheses: Sequence[Hypothesis], members: Sequence[int]) -> tuple[int, Fit] | None:
    """The better fitted of two effects that were fitted each by itself, as far as they were."""
    fits = [(h.members[0], h.fit) for h in hypotheses if h.fit and len(h.members) == 1 and h.members[0] in members]
    return min(fits, key=lambda x: x[1].objective) if fits and len(members) > 1 else None


def rivals(hypotheses: Sequence[Hypothesis]) -> list[int]:
    """Where evidence is too great for tangents to be trusted: single effects that come near the most probable."""
    P = probabilities(hypotheses)
    alone = sorted((-P[i], i) for i, h in enumerate(hypotheses) if len(h.members) == 1)[:MOST]
    best = hypotheses[alone[0][1]].log_bayes if alone else 0.0
    if best < GREAT:
        return []
    return [i for _, i in alone if hypotheses[i].log_bayes > NEAR * best and hypotheses[i].fit is None]


def exchanged(evidence: Evidence, hypotheses: Sequence[Hypothesis]) -> list[int]:
    """All-or-nothing effects that come near, or that mend the model before its calibration: they are too large for
    tangents, so they are refitted in any case."""
    a, mended = evidence.score.amplitude, mended_by_exchange(evidence)
    whole = [
        (i, h.members[0])
        for i, h in enumerate(hypotheses)
        if len(h.members) == 1 and evidence.effects[h.members[0]].whole
    ]
    near = sorted((x for x in whole if a[x[1]] > NEARLY), key=lambda x: -hypotheses[x[0]].log_bayes)[:MOST_LINEAR]
    before = sorted((x for x in whole if x[1] in mended), key=lambda x: -mended[x[1]])[:MOST_LINEAR]
    return [i for i, _ in dict.fromkeys([*near, *before])]


def far_from_prior(evidence: Evidence, hypotheses: Sequence[Hypothesis]) -> list[int]:
    """Effects that do what a calibrated parameter does which is far from its prior: the calibration has swallowed what
    a tangent would show."""
    fit = evidence.fit
    pull = dict(zip(fit.unknowns.names, np.abs(fit.theta / fit.unknowns.sd), strict=True))
    alone = [(i, evidence.twins[h.members[0]]) for i, h in enumerate(hypotheses) if len(h.members) == 1 and not h.fit]
    order = sorted((-pull[twin], i) for i, twin in alone if twin and pull[twin] > STRAIN)
    return [i for _, i in order[:MOST_LINEAR]]


def laplace(
    evidence: Evidence, h: Hypothesis, near: Beside | None = None, warm_fits: WarmFits = NOWHERE, finely: bool = False
) -> Hypothesis:
    """The hypothesis with the best of its refits and the evidence that follows.

    near : one of two effects, its fit without the other, and tangents there
    warm_fits : members -> a refit that may go on
    finely : to its end
    """
    before, fits = warm_fits.get(h.members), []
    if before is not None:
        with suppress(NoSolution):
            fits.append(refit_onwards(evidence, h.members, before, finely))
    else:
        for i, theta in enumerate(starts(evidence, h.members)):
            with suppress(NoSolution):  # a machine that would run away there begins elsewhere
                first = near if i == 0 else None
                fits.append(refit_beside(evidence, h.members, *first) if first else refit(evidence, h.members, theta))
    if not fits:
        return replace(h, log_bayes=IMPOSSIBLE, loud=IMPOSSIBLE)
    best = min(fits, key=lambda fit: fit.objective)
    return replace(h, fit=best, log_bayes=log_bayes(evidence, best, h.members))


def to_the_end(evidence: Evidence, h: Hypothesis) -> Hypothesis:
    """A refitted hypothesis, refitted further to its end."""
    return laplace(evidence, h, warm_fits={h.members: h.fit} if h.fit else NOWHERE, finely=True)


def finely(evidence: Evidence, hypotheses: Sequence[Hypothesis]) -> list[Hypothesis]:
    """The hypotheses, those that will be told refitted to their end: sizes are read off them."""
    out, P = list(hypotheses), probabilities(hypotheses)
    due = [i for i in np.argsort(-P) if P[i] > REPORTED and out[i].fit and free_of(evidence, out[i].members)]
    for i, h in zip(due, side_by_side(lambda i: to_the_end(evidence, out[i]), due), strict=True):
        out[i] = h
    return out


def noise_of_refits(hypotheses: Sequence[Hypothesis]) -> Noise | None:
    """The noise that the most probable refits leave, of the one that has most evidence under its own; None where it
    gains little.

    Tangents of a large effect leave more than the effect does, and noise as large as that cannot tell it from others.
    """
    order = [i for i in np.argsort(-weights(hypotheses), kind="stable") if hypotheses[i].fit and hypotheses[i].members]
    best, most, gained = None, -np.inf, 0.0
    for h in (hypotheses[i] for i in order[:MOST_LINEAR]):
        assert h.fit is not None
        noise = residual_noise(h.fit)
        more = evidence_of(h.fit, noise) - evidence_of(h.fit, h.fit.noise)
        if h.log_prior + h.log_bayes + more > most:
            best, most, gained = noise, h.log_prior + h.log_bayes + more, more
    return best if gained > GAINED else None


def log_bayes(evidence: Evidence, fit: Fit, members: Sequence[int]) -> float:
    """Log evidence over that of nothing: the gain at the optimum, times what the prior of the amplitudes gives there.

    The curvature of what calibration moves is taken to be the same for all.
    """
    free = free_of(evidence, members)
    p, m = evidence.p, len(free)
    if not m:
        return evidence.fit.objective - fit.objective
    wide = fit.unknowns.sd[p:]
    a = fit.theta[p:]
    gain = evidence.fit.objective - (fit.objective - 0.5 * float(np.sum((a / wide) ** 2)))
    v = spread(fit, p, wide)
    sd = np.array([evidence.parameters[k].prior_sd for k in free])
    sign = np.array([evidence.parameters[k].sign for k in free], int)
    if np.all(np.abs(a) < ABSENT * sd):  # what moved is the calibration, which may go on without them as well
        gain = min(gain, 0.0)
    return gain + float(logsumexp([_log_prior_mass(a, v, f * sd, sign) for f in SIZES]) - np.log(len(SIZES)))


def spread(fit: Fit, p: int, wide: Array) -> Array:
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
