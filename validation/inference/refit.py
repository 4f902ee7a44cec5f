"""The evidence of what carries weight without linearisation: refitted, with Laplace's integral at its own optimum."""

from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from geom.arrays import Array
from geom.errors import NoSolution
from measured.case import Case
from measured.doubt import PRIOR
from validation.calibration.calibrate import CachedSegments, Fit, minimise, no_progress, residual_noise
from validation.comparison.linearisation import Segment, segments
from validation.effects.base import ReadingEffect
from validation.effects.during import During
from validation.effects.sensors.input_fault import is_misread
from validation.inference.columns import exchange_columns
from validation.inference.evidence import (
    ENOUGH,
    ROUNDS,
    Evidence,
    fitted_members,
    log_bayes,
    log_evidence,
    scored,
    singles,
    with_members,
)
from validation.inference.hypotheses import (
    REPORTED,
    Members,
    Weighed,
    best_first,
    catalogue_priors,
    probabilities,
    singles_by_member,
    weights,
)
from validation.noise import Noise
from validation.threads import side_by_side

Progress = Callable[[str], None]
WarmFits = Mapping[Members, Fit]
Neighbour = tuple[int, Fit, Mapping[int, Sequence[Array]]]  # a cause, its fit alone, and tangents of others there
NO_FITS: WarmFits = MappingProxyType({})
FINE = 0.02  # nats at which what is told stands: a size is then within a quarter of its deviation of its optimum
STRAIGHT = 0.9  # of the gain that tangents predict: a refit that got it needs none of its own
BENDS = 10.0  # nats that a refit gains, beyond which the tangents of its start point elsewhere at its end
HOPELESS = 20.0  # nats worse than nothing, or than another start, after a first refit: no second one makes up for that
FIRST, SECOND = 8, 6  # steps of a refit, and under tangents of its own: with three, some stopped tens of nats short
WEIGHT = 0.01  # posterior probability from which a hypothesis is refitted
PROMOTIONS, MOST = 4, 8  # what a refit promotes is refitted too; so many at once
GREAT, NEAR = 10.0, 0.5  # nats beyond which tangents mislead, and the share of the best from which a rival is refitted
FAR = 0.2  # the same of a single one: of an opened lid the tangent promised a quarter of what it explains
IMPOSSIBLE = -1e3  # nats: as good as excluded, and a number that a document can hold
STRAIN = 1.5  # prior deviations of a parameter, from which an effect that does the same is refitted
GAINED = 3.0  # nats of log evidence from which another noise is worth weighing all anew
NEARLY, MOST_LINEAR = 0.4, 3  # linear amplitude, and how many, of effects that happen whole or not at all
LARGEST_SET = 3  # effects at once: who forgot more begins with another model
RIVALS = 4  # effects that are tried beside the same others
AGAIN = float(np.log(PRIOR["two"].share / (PRIOR["effect"].share + PRIOR["fault"].share)))  # as a second beside a first


def first_refit(evidence: Evidence, members: Sequence[int], theta: Array, tangents: Sequence[Segment] = ()) -> Fit:
    """All free parameters and the amplitudes of some causes, fitted anew by given tangents; those that are whole are
    held at one.

    Parameters: `theta` where the fit begins; `tangents` segments with the columns of all these there, by default those
    without the causes.
    """
    e, fit = evidence, evidence.fit
    network, unknowns, fixed = with_members(e, members)
    cache = CachedSegments(tangents or e.run.segments([e.causes[k] for k in fitted_members(e, members)]))
    return minimise(network, e.tests, unknowns, theta, fit.noise, fixed, FIRST, cache, worth=ENOUGH, error=fit.error)


def second_refit(evidence: Evidence, members: Sequence[int], rough: Fit, objective: float) -> Fit:
    """A first refit gone on under tangents of its own, where it needs them.  objective : where it began"""
    fit, far = evidence.fit, any(evidence.effects[k].whole for k in members)  # exchanged plugs begin where nothing fits
    straight = rough.gain_ratio > STRAIGHT and objective - rough.objective < BENDS
    if straight or (rough.objective > fit.objective + HOPELESS and not far):
        return rough
    network, unknowns, fixed = with_members(evidence, members)
    free = (network, evidence.tests, unknowns)
    return minimise(*free, rough.theta, fit.noise, fixed, SECOND, draft=True, worth=ENOUGH, error=fit.error)


def neighbour_tangents(evidence: Evidence, one: int, alone: Fit, others: Sequence[int]) -> dict[int, list[Array]]:
    """What each of some further causes does to every segment (K per unit) where one cause was fitted alone."""
    e, free = evidence, fitted_members(evidence, others)
    network, _, fixed = with_members(e, [one, *free])
    parts = segments(network, e.tests, {**fixed, **alone.values}, [e.parameters[k] for k in free])
    return {k: [s.J[:, i] for s in parts] for i, k in enumerate(free)}


def neighbour_refit(evidence: Evidence, members: Sequence[int], neighbour: Neighbour) -> Fit:
    """Two causes fitted from where one of them was fitted alone, with its tangents and those of the other there."""
    (one, alone, columns), p = neighbour, evidence.p
    free = fitted_members(evidence, members)
    theta = np.concatenate([alone.theta[:p], [alone.theta[p] if k == one else 0.0 for k in free]])
    tangents = [
        replace(s, J=np.column_stack([s.J[:, :p], *(s.J[:, p] if k == one else columns[k][i] for k in free)]))
        for i, s in enumerate(alone.parts)
    ]
    return first_refit(evidence, members, theta, tangents)


def continued_refit(evidence: Evidence, members: Sequence[int], before: Fit, fine: bool = False) -> Fit:
    """A refit that goes on with what it ran last, under another noise; where its effects have new ends, nearby.

    fine : to its end, with tangents of its own there
    """
    network, unknowns, fixed = with_members(evidence, members)
    other_times, fit = before.unknowns.names != unknowns.names, evidence.fit
    cache = CachedSegments(before.parts, nearby=other_times, renewed=True, stale=True)
    steps, worth = (ROUNDS, FINE) if fine else (SECOND, ENOUGH)
    free = (network, evidence.tests, unknowns)
    return minimise(*free, before.theta, fit.noise, fixed, steps, cache, draft=not fine, worth=worth, error=fit.error)


def starts(evidence: Evidence, members: Sequence[int]) -> list[Array]:
    """Where a refit may begin: at the linear amplitudes, and where a tangent says too little at large ones."""
    free = fitted_members(evidence, members)
    q = [evidence.parameters[k] for k in free]
    sd, low, high = (np.array([getattr(x, name) for x in q]) for name in ("prior_sd", "low", "high"))
    # a tangent of a large effect points far beyond what physics allows: within three deviations and the bounds
    first = np.clip(np.clip(evidence.score.amplitude[free], -3.0 * sd, 3.0 * sd), 0.9 * low, 0.9 * high)
    far = {k: evidence.jumps[n][0] for k in free if (n := evidence.names[k]) in evidence.jumps}
    points = [first, *([np.array([far.get(k, f) for k, f in zip(free, first, strict=True)])] if far else [])]
    return [np.concatenate([evidence.fit.theta, a]) for a in points]


def laplace(
    evidence: Evidence,
    h: Weighed,
    neighbour: Neighbour | None = None,
    warm_fits: WarmFits = NO_FITS,
    fine: bool = False,
) -> Weighed:
    """The hypothesis with the best of its refits and the evidence that follows.

    Parameters: `neighbour` one of two causes fitted without the other; `warm_fits` members -> a refit that may go on;
    `fine`: to its end. Returns: the hypothesis, as good as excluded where the machine runs away from every start.
    """
    before, fits = warm_fits.get(h.members), []
    if before is not None:
        with suppress(NoSolution):
            fits.append(continued_refit(evidence, h.members, before, fine))
    else:
        rough = []
        for i, theta in enumerate(starts(evidence, h.members)):
            near = neighbour if i == 0 else None
            with suppress(NoSolution):  # a machine that would run away there begins elsewhere
                one = neighbour_refit(evidence, h.members, near) if near else first_refit(evidence, h.members, theta)
                rough.append((one, near[1].objective if near else evidence.fit.objective))
        least = min((one.objective for one, _ in rough), default=np.inf) + HOPELESS
        for one, begin in rough:
            with suppress(NoSolution):
                fits += [second_refit(evidence, h.members, one, begin)] if one.objective <= least else []
    if not fits:
        return replace(h, log_bayes=IMPOSSIBLE, loud=IMPOSSIBLE)
    best = min(fits, key=lambda fit: fit.objective)
    if is_unreadable(evidence, h.members, best):
        return replace(h, fit=best, log_bayes=IMPOSSIBLE, loud=IMPOSSIBLE)
    bayes = log_bayes(evidence, best, h.members)
    loud = evidence.loud.evidence(best, bayes) if evidence.loud else h.loud
    return replace(h, fit=best, log_bayes=bayes, loud=loud)


def is_unreadable(evidence: Evidence, members: Sequence[int], fit: Fit) -> bool:
    """Would a room, an inlet or an input have to be further off than any is read? Nobody could add that."""
    at_bound = zip(fitted_members(evidence, members), fit.at_bound[evidence.p :].tolist(), strict=True)
    return any(far and is_misread(evidence.effects[k], evidence.parameters[k]) for k, far in at_bound)


def fine_refit(evidence: Evidence, h: Weighed) -> Weighed:
    """A refitted hypothesis, refitted further to its end."""
    return laplace(evidence, h, warm_fits={h.members: h.fit} if h.fit else NO_FITS, fine=True)


def refitted(
    evidence: Evidence,
    hypotheses: Sequence[Weighed],
    progress: Progress = no_progress,
    warm_fits: WarmFits = NO_FITS,
    again: Collection[Members] = (),
) -> list[Weighed]:
    """The hypotheses with those that carry weight refitted, until none does that is not.

    Parameters: `warm_fits` members -> a refit of theirs under another noise; `again` members of what carried weight
    there, and may do so here though its tangents promise too little.
    """
    out = list(hypotheses)
    weighty = [i for i, h in enumerate(out) if h.members in again]
    far = dict.fromkeys([*exchanges(evidence, out), *pulled_twins(evidence, out), *rivals(out), *weighty])
    refit_together(evidence, out, list(far), progress, warm_fits)
    for _ in range(PROMOTIONS):
        P = shares(with_gains(hypotheses, out))
        due = [i for i in np.argsort(-P) if P[i] > WEIGHT and out[i].members and out[i].fit is None][:MOST]
        due = due or exchanging_pairs(out)[:MOST]
        if not due:
            break
        for size in (1, 2):  # two begin where one of them was fitted alone
            refit_together(evidence, out, [i for i in due if len(out[i].members) == size], progress, warm_fits)
    return with_shortfalls(hypotheses, out)


def refit_together(
    evidence: Evidence, out: list[Weighed], due: Sequence[int], progress: Progress, warm_fits: WarmFits
) -> None:
    """Refit some hypotheses side by side (the kernel frees the GIL); none depends on another of them."""
    for i in due:
        progress(f"refitting {evidence.name(out[i])}")
    near = neighbours(evidence, out, due)
    fresh = side_by_side(lambda i: laplace(evidence, out[i], near.get(i), warm_fits), due)
    for i, h in zip(due, fresh, strict=True):
        out[i] = h


def neighbours(evidence: Evidence, hypotheses: Sequence[Weighed], due: Sequence[int]) -> dict[int, Neighbour]:
    """For pairs of which one cause was fitted by itself: the better such fit, and the tangents of all the other causes
    there, in one run."""
    single = singles_by_member(hypotheses)
    alone: dict[int, tuple[int, Fit]] = {}
    for i in due:
        fits = [(k, fit) for k in hypotheses[i].members if k in single and (fit := single[k].fit)]
        if fits and len(hypotheses[i].members) > 1:
            alone[i] = min(fits, key=lambda x: x[1].objective)
    others: dict[int, list[int]] = {}
    for i, (one, _) in alone.items():
        others.setdefault(one, []).extend(k for k in hypotheses[i].members if k != one)
    columns = {one: neighbour_tangents(evidence, one, fit, others[one]) for one, fit in dict(alone.values()).items()}
    return {i: (one, fit, columns[one]) for i, (one, fit) in alone.items()}


def shares(hypotheses: Sequence[Weighed]) -> Array:
    """Probabilities; of what has a name those without heat of unknown cause, which is not refitted and may hide it."""
    P, with_cause = probabilities(hypotheses, 1.0), np.array([not h.heat for h in hypotheses])
    return np.where(with_cause, P / max(float(P[with_cause].sum()), 1e-300), P)


def weighty_refits(hypotheses: Sequence[Weighed]) -> list[Members]:
    """Members of what carries weight once it is refitted."""
    P = shares(hypotheses)
    return [h.members for p, h in zip(P, hypotheses, strict=True) if p > WEIGHT and h.fit and h.members]


def exchanging_pairs(hypotheses: Sequence[Weighed]) -> list[int]:
    """Pairs without a refit that only exchange what weighty pairs exchange already, most probable first.

    Where a + b and c + b and a + d carry weight, a and c may stand for each other, and c + d is weighed as the three
    are. Its tangents alone promise too little as often as theirs, and whether it is refitted would hang on chance.
    """
    partners: dict[int, set[int]] = {}
    for a, b in (m for m in weighty_refits(hypotheses) if len(m) == 2):
        partners.setdefault(a, set()).add(b)
        partners.setdefault(b, set()).add(a)

    def closes(h: Weighed) -> bool:
        if len(h.members) != 2 or h.fit is not None:
            return False
        first, second = (partners.get(k, set()) for k in h.members)
        return any(first & partners[a] for a in second)

    return [int(i) for i in np.argsort(-shares(hypotheses), kind="stable") if closes(hypotheses[i])]


def with_gains(before: Sequence[Weighed], after: Sequence[Weighed]) -> list[Weighed]:
    """Two effects gain by tangents what either of them gains by its refit more than by its tangent."""
    return _pairs_corrected(before, after, lambda each: max(0.0, *each))


def with_shortfalls(before: Sequence[Weighed], after: Sequence[Weighed]) -> list[Weighed]:
    """Two effects that were not refitted, for there were too many, lose what the refit of either fell short of its
    tangent."""
    return _pairs_corrected(before, after, lambda each: min(0.0, *each))


def _pairs_corrected(
    before: Sequence[Weighed], after: Sequence[Weighed], by: Callable[[list[float]], float]
) -> list[Weighed]:
    """Pairs without a refit, by what those of their members gained more than their tangents."""
    tangent = {k: h.log_bayes for k, h in singles_by_member(before).items()}
    more = {k: h.log_bayes - tangent[k] for k, h in singles_by_member(after).items() if h.fit}
    gain = [0.0 if h.fit or len(h.members) < 2 else by([more.get(k, 0.0) for k in h.members]) for h in after]
    return [replace(h, log_bayes=h.log_bayes + g) for h, g in zip(after, gain, strict=True)]


def rivals(hypotheses: Sequence[Weighed]) -> list[int]:
    """Where evidence is too great for tangents to be trusted: single effects that come near the most probable, under
    the noise of a good model."""
    alone = sorted((-h.log_prior - h.log_bayes, i) for i, h in enumerate(hypotheses) if len(h.members) == 1)[:MOST]
    best = hypotheses[alone[0][1]].log_bayes if alone else 0.0
    if best < GREAT:
        return []
    return [i for _, i in alone if hypotheses[i].log_bayes > FAR * best and hypotheses[i].fit is None]


def exchanges(evidence: Evidence, hypotheses: Sequence[Weighed]) -> list[int]:
    """All-or-nothing effects that come near, or that mend the model before its calibration: they are too large for
    tangents, so they are refitted in any case."""
    a, mended = evidence.score.amplitude, mended_squares(evidence)
    single = ((i, h.members[0]) for i, h in enumerate(hypotheses) if len(h.members) == 1)
    whole = [(i, k) for i, k in single if evidence.effects[k].whole]
    near = sorted((x for x in whole if a[x[1]] > NEARLY), key=lambda x: -hypotheses[x[0]].log_bayes)[:MOST_LINEAR]
    before = sorted((x for x in whole if x[1] in mended), key=lambda x: -mended[x[1]])[:MOST_LINEAR]
    return [i for i, _ in dict.fromkeys([*near, *before])]


def mended_squares(evidence: Evidence) -> dict[int, float]:
    """All-or-nothing effects that take half or more off the squares they touch, of the model before any calibration,
    with what they take; a model calibrated to exchanged readings hides that they were."""
    e, few = evidence, [k for k, x in enumerate(evidence.effects) if x.whole]
    if not few:
        return {}
    values = {q.name: q.value for q in e.network.parameters}
    try:
        parts = segments(e.network, e.tests, values, [e.parameters[k] for k in few])
    except NoSolution:  # the declared values alone run away
        return {}
    plain = [[s.J[:, i : i + 1] for s in parts] for i in range(len(few))]
    out = {}
    for k, columns in zip(few, exchange_columns(parts, [e.effects[k] for k in few], plain), strict=True):
        touched = [(s.r / s.weight, J[:, 0] / s.weight) for s, J in zip(parts, columns, strict=True) if np.any(J)]
        before, after = sum(float(r @ r) for r, _ in touched), sum(float((r - J) @ (r - J)) for r, J in touched)
        if after < 0.5 * before:
            out[k] = before - after
    return out


def pulled_twins(evidence: Evidence, hypotheses: Sequence[Weighed]) -> list[int]:
    """Effects that do what a calibrated parameter does which is far from its prior: the calibration has swallowed what
    a tangent would show."""
    fit = evidence.fit
    pull = dict(zip(fit.unknowns.names, np.abs(fit.theta / fit.unknowns.sd), strict=True))
    alone = [(i, evidence.twins[h.members[0]]) for i, h in enumerate(hypotheses) if len(h.members) == 1 and not h.fit]
    order = sorted((-pull[twin], i) for i, twin in alone if twin and pull[twin] > STRAIN)
    return [i for _, i in order[:MOST_LINEAR]]


def fine_refits(evidence: Evidence, hypotheses: Sequence[Weighed]) -> list[Weighed]:
    """The hypotheses, those that will be told refitted to their end: sizes are read off them."""
    out, P = list(hypotheses), probabilities(hypotheses, 1.0)
    due = [i for i in np.argsort(-P) if P[i] > REPORTED and out[i].fit and fitted_members(evidence, out[i].members)]
    for i, h in zip(due, side_by_side(lambda i: fine_refit(evidence, out[i]), due), strict=True):
        out[i] = h
    return out


def refit_noise(hypotheses: Sequence[Weighed]) -> Noise | None:
    """The noise that the most probable refits leave, of the one that has most evidence under its own; None where it
    gains little.

    Tangents of a large effect leave more than the effect does, and noise as large as that cannot tell it from others.
    """
    best, most, gained = None, -np.inf, 0.0
    for h in [h for h in best_first(hypotheses) if h.fit and h.members][:MOST_LINEAR]:
        assert h.fit is not None
        noise = residual_noise(h.fit)
        more = log_evidence(h.fit, noise) - log_evidence(h.fit)
        if h.log_prior + h.log_bayes + more > most:
            best, most, gained = noise, h.log_prior + h.log_bayes + more, more
    return best if gained > GAINED else None


def larger_sets(
    case: Case, evidence: Evidence, hypotheses: Sequence[Weighed], progress: Progress = no_progress
) -> list[Weighed]:
    """The hypotheses, with larger sets where two effects explain most, or heat of unknown cause explains more.

    A greedy search: from the best explanation so far the tangents of all others are made anew, and the next is fitted
    beside it, as long as that pays. Of three effects none of which explains much without the others it may find another
    three.
    """
    out, weight = list(hypotheses), weights(hypotheses)
    refits = [
        i for i, h in enumerate(out) if h.fit and h.members and h.members == tuple(fitted_members(evidence, h.members))
    ]
    if not refits:
        return out
    first = max(refits, key=lambda i: weight[i])
    best = out[first]
    goes_on = len(best.members) > 1 or weight[first] < max((w for w, h in zip(weight, out) if h.heat), default=-np.inf)
    while goes_on and len(best.members) < LARGEST_SET:
        new = with_one_more(case, evidence, best, progress)
        *_, old, more = weights([*out, best, *new[:1]])
        goes_on = bool(new) and more > old
        if goes_on:
            best = new[0]
            out += new
    return out


def with_one_more(case: Case, evidence: Evidence, best: Weighed, progress: Progress) -> list[Weighed]:
    """The best explanation that adds one lasting effect, the most probable first, then those that add a rival of it;
    none if there is nothing to add."""
    assert best.fit is not None
    effects = evidence.effects
    others = [k for k, e in enumerate(effects) if k not in best.members and not (isinstance(e, During) or e.whole)]
    if not others:
        return []
    laws = {e.name: evidence.causes[k].log_prior for k in others if isinstance(e := effects[k], ReadingEffect)}
    priors = {**catalogue_priors([e for k in others if (e := effects[k]).name not in laws]), **laws}
    now = scored(case, [effects[k] for k in others], best.fit, priors)
    ones = singles(now)
    first, *more = (h for h in (ones[i] for i in np.argsort(-weights(ones))) if h.members)
    # single effects that come near the first: tangents do not tell them apart
    close = [first, *(h for h in more if h.log_bayes > NEAR * first.log_bayes > 0.0)][:RIVALS]
    for one in close:
        progress(f"refitting {evidence.name(best)} + {now.name(one)}")
    out = []
    for h in side_by_side(lambda one: laplace(now, one), close):
        k = others[h.members[0]]
        prior = best.log_prior + AGAIN + evidence.causes[k].log_prior
        out.append(Weighed((*best.members, k), "", prior, best.log_bayes + h.log_bayes, best.loud, h.fit))
    return [out[i] for i in np.argsort(-weights(out))]


def group_refits(evidence: Evidence, single: Mapping[int, Weighed], members: Sequence[int]) -> dict[int, Weighed]:
    """Each cause by itself, some of them refitted where they were not."""
    out = dict(single)
    for k in members:
        if out[k].fit is None:
            out[k] = laplace(evidence, out[k])
    return out
