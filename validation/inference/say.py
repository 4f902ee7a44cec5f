"""What is said: the tables and the sentence of a diagnosis, from its posterior and decision."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import logit, ndtri

from geom.arrays import Array
from geom.constants import NORMAL_95
from geom.table import percent, unit_suffix
from measured.case import Case, Test
from measured.doubt import USUAL
from measured.sensors.faults import PlainFaults
from measured.sensors.operators import head
from validation.calibration.calibrate import Fit, InnerProduct, followed
from validation.calibration.model_error import total_sd
from validation.comparison.linearisation import Segment, rmse, segments
from validation.effects.above import Above
from validation.effects.base import Effect, ReadingEffect
from validation.effects.during import During
from validation.effects.time_window import ALIKE, Event
from validation.inference.decide import Decision, Group, Posterior, precedence
from validation.inference.evidence import Evidence, smallest_visible, thresholds
from validation.inference.hypotheses import (
    REPORTED,
    Cause,
    Weighed,
    best_first,
    evidence_temper,
    inclusion,
    probabilities,
)
from validation.inference.result import (
    Candidate,
    Decided,
    DetectionLimit,
    Explanation,
    Odds,
    PossibleEvent,
    RecordDoubt,
    Remainder,
    Verdict,
)
from validation.parameters.unknowns import value_words

Record = tuple[str, str]  # test and channel
Pulls = Sequence[tuple[str, float, float]]
ROWS, LEAST_ODDS = 20, 1e-4  # candidates in the table; odds below one in ten thousand are not listed
CERTAIN = 1.0 - 1e-9  # probability beyond which odds are as good as certain
LEAST_MEMBER = 0.02  # probability below which a member of a group is in the table, and not in the sentence
CLAUSE = "; these tests and sensors cannot tell them apart"
EVEN = 0.5  # probability from which that something is missing is more likely than not
OFF = 2.0  # deviations of what a sensor and a good model allow, from which a record is called off
MOST = 3  # records that stay off are told, worst first
LESS = 0.7  # of its error: what another effect must bring a record to, to be its explanation
UNSEEN = 2.0  # usual sizes from which an effect that these tests cannot show is told


def final_verdict(
    verdict: Verdict, posterior: Posterior, choice: Decision, pulls: Pulls, broken: PlainFaults
) -> Verdict:
    """The decision with what the calibration says about itself: a machine that has to be bent is not adequate."""
    if broken:
        return "data"
    e = posterior.evidence
    if verdict == "adequate":
        # is more left than noise and model error allow: most records out of twice what a model may be wrong by?
        out = np.mean([rms(s.r) > OFF * s.weight for s in explained_parts(e.fit)]) > 0.5
        return "outside" if out else "absorbed" if pulls else "adequate"
    if verdict == "named" and e.twins[choice.groups[0][0]] is not None:
        return "absorbed"
    return verdict


def prior_pulls(fit: Fit) -> tuple[tuple[str, float, float], ...]:
    """Parameters that calibration pulls further from their prior than one in twenty fits does any: name, value,
    deviations; and those at a physical bound beyond two deviations. A sensor that follows at once is at none."""
    pull = fit.theta / fit.unknowns.sd
    limit, lags = -float(ndtri(0.025 / pull.size)), np.array([head(p) == "lag" for p in fit.unknowns.parameters])
    hit = (np.abs(pull) > limit) | (fit.at_bound & ~lags & (np.abs(pull) > 2.0))
    order = [int(j) for j in np.argsort(-np.abs(pull)) if hit[j]]
    return tuple((fit.unknowns.names[j], fit.values[fit.unknowns.names[j]], float(pull[j])) for j in order)


def explained_parts(fit: Fit) -> list[Segment]:
    """What a fit leaves of every record, without what its model error explains."""
    return InnerProduct(fit.parts, fit.noise, fit.error).explained(fit.parts, fit.error)


def deviances(evidence: Evidence, fit: Fit) -> dict[Record, float]:
    """(test, channel) -> r' noise^-1 r of what a fit and its model error leave."""
    left = explained_parts(fit)
    return {(s.test, s.channel): float(np.sum(fit.noise.whiten(s, s.r[:, None]) ** 2)) for s in left}


def odds(posterior: Posterior, sure: tuple[str, ...] = ()) -> tuple[Odds, ...]:
    """Every hypothesis that carries weight, most probable first; the rest as one line.

    sure : faults that are there beside whatever else is
    """
    P = probabilities(posterior.hypotheses)
    rows = [
        _odds(posterior.evidence, h, float(p), sure)
        for h, p in zip(posterior.hypotheses, P, strict=True)
        if p > LEAST_ODDS
    ]
    rows.sort(key=lambda o: -o.probability)
    return (*rows, Odds("others", (), max(1.0 - sum(o.probability for o in rows), 0.0)))


def _odds(e: Evidence, h: Weighed, p: float, sure: tuple[str, ...]) -> Odds:
    """A hypothesis with when it held."""
    names = tuple(e.names[k] for k in h.members)
    name = " + ".join((*sure, *([e.name(h)] if names or h.heat or not sure else [])))
    conditions = [x for k in h.members if isinstance(x := e.effects[k], During)]
    tests = tuple(dict.fromkeys(t for x in conditions for t in x.tests))
    spans = [s for x in conditions if x.event for s in x.event.every]
    begin, end = spans[0] if len(spans) == 1 else (None, None)
    return Odds(name, (*sure, *names), p, h.nats, tests, begin, end, sure)


def explanations(posterior: Posterior) -> tuple[Explanation, ...]:
    """The hypotheses by leading cause: those with the cause that most of the probability holds, then of the rest.

    A cause that leads has the probability of its row among the candidates. Partners have theirs where it is there, as
    the verdict tells two causes that do not depend on each other. Plain faults are no part of it.
    """
    e, words = posterior.evidence, {"nothing": "nothing is missing"}
    words |= {name: effect.statement for name, effect in zip(e.names, e.effects, strict=True)}
    words |= {f"heat@{h.heat}": f"heat of unknown cause at {h.heat}" for h in posterior.hypotheses if h.heat}
    causes = [tuple(e.names[k] for k in h.members) or (e.name(h),) for h in posterior.hypotheses]
    nats = {each[0]: h.nats for each, h in zip(causes, posterior.hypotheses, strict=True) if len(each) == 1}
    left = list(zip(causes, map(float, probabilities(posterior.hypotheses)), strict=True))
    rows: list[Explanation] = []
    while left and sum(p for _, p in left) > LEAST_ODDS:
        share: dict[str, float] = {}
        for each, p in left:
            share |= {name: share.get(name, 0.0) + p for name in each}
        lead = min(share, key=lambda name: precedence(share[name], nats.get(name, -np.inf)))
        partners: dict[str, float] = {}
        for each, p in left:
            if lead in each:
                partners |= {name: partners.get(name, 0.0) + p for name in each if name != lead}
        likely = [(n, words[n], p / share[lead]) for n, p in partners.items() if p > LEAST_ODDS]
        alone = sum(p for each, p in left if each == (lead,))
        rows.append(Explanation(lead, words[lead], share[lead], alone, tuple(sorted(likely, key=lambda row: -row[2]))))
        left = [(each, p) for each, p in left if lead not in each]
    return (*rows, Explanation("others", "anything else", max(1.0 - sum(r.probability for r in rows), 0.0)))


def candidate_rows(
    case: Case, posterior: Posterior, choice: Decision, verdict: Verdict, single: Mapping[int, Weighed]
) -> tuple[Candidate, ...]:
    """The groups' members, then the others by probability."""
    e = posterior.evidence
    share = inclusion(posterior.hypotheses, len(e.effects))
    members = [k for g in choice.groups for k in g]
    order = [*members, *(int(k) for k in np.argsort(-share, kind="stable") if k in single and k not in members)]
    size, limit = smallest_visible(e), thresholds(e)
    standard = Standard.create(case, posterior, single[members[0]].fit if members else e.fit)
    refits = [h for h in best_first(posterior.hypotheses) if h.fit]
    rows = []
    for k in order[:ROWS]:
        within = next((h.fit for h in refits if k in h.members), single[k].fit)
        row = _row(e, single[k], within, standard, float(share[k]), leads=k in members[:1])
        row = replace(row, threshold=float(limit[k]), smallest_detectable=float(size[k]))
        group = next((g for g in choice.groups if k in g), ())
        rows.append(replace(row, decision=_decided(row, group, verdict), confused_with=_others(e, k, group)))
    return tuple(rows)


def _decided(row: Candidate, group: Group, verdict: Verdict) -> Decided:
    if not group:
        return "cannot-tell" if row.absorbed > 0.995 else "no"
    if verdict in ("outside", "absorbed"):
        return "cannot-tell"
    return "named" if len(group) == 1 else "group"


def _others(e: Evidence, k: int, group: Group) -> tuple[str, ...]:
    """What it may be confused with: the rest of its group, or what leaves a trace like its own."""
    if group:
        return tuple(e.names[m] for m in group if m != k)
    like = np.abs(e.score.cosine[k])
    return tuple(e.names[m] for m in np.argsort(-like) if m != k and like[m] > 0.9)[:5]


@dataclass(frozen=True)
class Standard:
    """What every refit is held against.

    lead : deviance of each record with the leading effect, empty without one
    temper : what divides log evidence;  tests, hold_out : held-out tests and what the model without it leaves there
    """

    lead: Mapping[Record, float]
    temper: float
    tests: tuple[Test, ...]
    hold_out: tuple[Segment, ...]

    @classmethod
    def create(cls, case: Case, posterior: Posterior, lead: Fit | None) -> "Standard":
        tests = tuple(t for t in case.tests if t.role == "hold-out")
        e, share = posterior.evidence, evidence_temper(posterior.hypotheses)
        return cls(deviances(e, lead) if lead else {}, share, tests, hold_out_residuals(tests, e.fit))


def _row(e: Evidence, h: Weighed, within: Fit | None, standard: Standard, probability: float, leads: bool) -> Candidate:
    """A candidate by itself; its size is that in the most probable hypothesis it is in (`within`)."""
    k, s, name = h.members[0], e.score, e.names[h.members[0]]
    effect, wide, spread = e.effects[k], float(np.sqrt(standard.temper)), law_scatter(e, k)
    a, sd = float(s.amplitude[k]), float(s.sd[k])
    if h.fit is not None and within is not None and not effect.whole:
        j = within.unknowns.names.index(name)
        a, sd = float(within.theta[j]), float(within.sd[j])
    exact = h.fit is not None and effect.whole
    row = Candidate(
        name,
        h.nats,
        0.0,
        1.0 if exact else a,
        e.parameters[k].unit,
        (1.0, 1.0) if exact else interval(a, wide * sd, spread, probability),
        "no",
        probability=probability,
        absorbed=float(s.absorbed[k]),
        twin=e.twins[k],
        title=effect.title,
        words=effect.words(a, e.fit.network, {}) if h.fit and isinstance(effect, Above) else effect.statement,
        isolating_test=effect.isolating_test,
    )
    if h.fit is None:
        return row
    before, after = rmse(e.fit.parts), rmse(h.fit.parts)
    new = hold_out_residuals(standard.tests, h.fit)
    tests = (*errors_by_test(e.fit.parts, h.fit.parts, False), *errors_by_test(standard.hold_out, new, True))
    return replace(
        row,
        rmse_K=(before, after),
        explained=1.0 - (after / before) ** 2,
        holdout_rmse_K=(rmse(standard.hold_out), rmse(new)) if standard.tests else None,
        tests=tests,
        note=worst_record(e, h.fit, standard) if standard.lead and not leads else "",
    )


def interval(a: float, sd: float, scatter: float = 0.0, probability: float = 0.5) -> tuple[float, float]:
    """Central 95 % of an amplitude; of what is probably there the side of zero is as far off as its odds say.

    sd : of the refit, widened by the root of the temper that divides log evidence
    scatter : share of itself (one sigma) by which its law is wrong: no single amplitude fits a film of another exponent
    """
    half = NORMAL_95 * float(np.hypot(sd, scatter * a))
    odds = float(logit(np.clip(probability, 0.5, CERTAIN)))
    if half < abs(a) or odds == 0.0:
        return a - half, a + half
    inner = min(half, NORMAL_95 * abs(a) / float(np.sqrt(2.0 * odds)))  # of a normal law with these odds at zero
    return (a - inner, a + half) if a > 0.0 else (a - half, a + inner)


def law_scatter(e: Evidence, k: int) -> float:
    """By how much of itself an effect's amplitude is off because its correlation is; 0 for what is exact."""
    law = e.fit.error.law if e.fit.error else USUAL["law"]
    return law if e.effects[k].empirical else 0.0


def worst_record(e: Evidence, fit: Fit, standard: Standard) -> str:
    """The record in which a rival fits worst beside the leading one."""
    rival = deviances(e, fit)
    worse = {key: 0.5 * (rival[key] - standard.lead[key]) for key in rival}
    (test, channel), nats = max(worse.items(), key=lambda x: x[1])
    return f"fits {channel} in {test} worse (log odds -{nats:.1f})" if nats > 1.0 else ""


def hold_out_residuals(tests: Sequence[Test], fit: Fit) -> tuple[Segment, ...]:
    """What a fit leaves on tests that nothing was fitted to."""
    return tuple(segments(fit.network, tests, fit.values)) if tests else ()


def errors_by_test(
    before: Sequence[Segment], after: Sequence[Segment], is_hold_out: bool
) -> tuple[tuple[str, float, float, bool], ...]:
    """Name, error (K) before and after, and whether nothing was fitted to it, of each test."""
    names = dict.fromkeys(s.test for s in before)
    pairs = [[[s for s in parts if s.test == name] for parts in (before, after)] for name in names]
    return tuple((name, rmse(old), rmse(new), is_hold_out) for name, (old, new) in zip(names, pairs, strict=True))


def hidden_effects(e: Evidence) -> tuple[DetectionLimit, ...]:
    """Effects that would have to be unusually large to show, most hidden first."""
    size, twins, absorbers = smallest_visible(e), e.twins, (*e.fit.unknowns.names, "model error")
    unusual = size / e.scale
    rows = [int(k) for k in np.argsort(-unusual) if unusual[k] > UNSEEN or twins[k]]
    return tuple(
        DetectionLimit(
            e.names[k],
            e.effects[k].statement,
            float(size[k]),
            e.parameters[k].unit,
            twins[k] or absorbers[min(e.score.absorber[k], e.p)],
        )
        for k in rows
        if not isinstance(e.effects[k], During)
    )


def confusion(e: Evidence, names: Sequence[str]) -> dict[str, dict[str, float]]:
    """Cosines between the traces of some candidates."""
    index = {n: k for k, n in enumerate(e.names)}
    return {a: {b: float(e.score.cosine[index[a], index[b]]) for b in names} for a in names}


def possible_events(posterior: Posterior) -> tuple[PossibleEvent, ...]:
    """Every stretch that was tried, most probable first; it is probable as far as any explanation of it is.

    A film and a heat input explain one stretch with ends of their own: what overlaps by half is one event.
    """
    e, every, single = posterior.evidence, posterior.hypotheses, posterior.single
    share = inclusion(every, len(e.effects))
    event_of = {k: x.event for k, x in enumerate(e.effects) if k in single and isinstance(x, During) and x.event}
    groups: list[list[int]] = []
    for k in sorted(event_of, key=lambda k: (-share[k], -single[k].log_bayes)):
        alike = (g for g in groups if event_of[g[0]].overlap(event_of[k]) >= ALIKE)
        group = next(alike, None)
        if group is None:
            groups.append(group := [])
        group.append(k)
    P = probabilities(every)
    probability = [sum(float(p) for h, p in zip(every, P, strict=True) if set(g) & set(h.members)) for g in groups]
    rows = [_event(e, single[g[0]], event_of[g[0]], p) for g, p in zip(groups, probability, strict=True)]
    return tuple(sorted(rows, key=lambda r: -r.probability))


def _event(e: Evidence, h: Weighed, event: Event, probability: float) -> PossibleEvent:
    """An event by its most probable explanation."""
    k, document = h.members[0], event.document()
    value = float(e.score.amplitude[k] if h.fit is None else h.fit.theta[e.p])
    what = (e.names[k], e.effects[k].title, value, e.parameters[k].unit)
    return PossibleEvent(event.name, document["words"], tuple(document["spans"]), probability, *what)


def remainder(
    case: Case, posterior: Posterior, choice: Decision, single: Mapping[int, Weighed]
) -> tuple[Remainder, ...]:
    """The records that stay off with the best explanation in the model, one per sensor, worst first, and what that may
    be: the model's own doubts, or a second effect, or nothing that these readings can tell.

    Off are those that parameters which follow the readings leave off, too: they mend what doubts would only forgive.
    """
    lead = frozenset(g[0] for g in choice.groups)
    # the refit with all that is named; where there is none, that of the first of them, or of nothing
    whole = [h.fit for h in posterior.hypotheses if h.fit and h.members and set(h.members) == lead]
    alone = [h.fit for k in sorted(lead) if (h := single[k]).fit]
    fit = (*whole, *alone, posterior.evidence.fit)[0]
    off = [s for s in fit.parts if rms(s.r) > OFF * s.weight]
    if not off:
        return ()
    effects = {*(e.name for e in case.model.effects), *(posterior.evidence.names[k] for k in lead)}
    plain = followed(fit, posterior.evidence.tests, case.model.values, effects)
    least = {(s.test, s.channel): rms(s.r) for s in plain.parts}
    errors = {(s.test, s.channel): min(rms(s.r), least[s.test, s.channel]) for s in off}
    rows: dict[str, Segment] = {}
    for s in sorted(off, key=lambda s: -errors[s.test, s.channel] / s.weight):
        if errors[s.test, s.channel] > OFF * s.weight:
            rows.setdefault(s.channel, s)
    measure, few = InnerProduct(fit.parts, fit.noise, fit.error), list(rows.values())[:MOST]
    return tuple(_remainder(s, errors[s.test, s.channel], posterior, lead, fit, measure) for s in few)


def record_doubts(fit: Fit) -> tuple[RecordDoubt, ...]:
    """What the doubts of a model add up to at each record, the largest first."""
    error, rows = fit.error, []
    for s in fit.parts if error else ():
        square = np.mean(error.of(s)[:, : error.model_columns] ** 2, axis=0)  # type: ignore[union-attr, index]
        most = error.names[int(np.argmax(square))]  # type: ignore[union-attr]
        total = error.sums.get((s.test, s.channel), 0.0)  # type: ignore[union-attr]
        rows.append(RecordDoubt(s.channel, s.test, total, float(np.sqrt(np.sum(square))), most))
    return tuple(sorted(rows, key=lambda r: -r.sum_K))


def rms(r: Array) -> float:
    return float(np.sqrt(np.mean(r**2)))


def _remainder(
    s: Segment, error: float, posterior: Posterior, lead: frozenset[int], fit: Fit, measure: InnerProduct
) -> Remainder:
    doubt, model_K = "", 0.0
    if fit.error is not None:
        parts, k = fit.error.of(s) * measure.doubts(fit.parts), fit.error.model_columns
        left = s.r - parts[:, k:].sum(axis=1)  # when inputs stepped is not a fault of the model
        model_K = rms(left) - rms(left - parts[:, :k].sum(axis=1))
        doubt = fit.error.names[int(np.argmax(np.mean(parts[:, :k] ** 2, axis=0)))]
    effect, p, less = second_effect(posterior, lead, s)
    name, how = ("", "") if effect is None else (effect.name, effect.effect.isolating_test)
    return Remainder(s.channel, s.test, error, min(max(model_K, 0.0), error), doubt, name, p, less, how)


def second_effect(posterior: Posterior, lead: frozenset[int], s: Segment) -> tuple[Cause | None, float, float]:
    """The cause beside the leading ones that brings a record down most surely, its probability, the error (K) then."""
    P = probabilities(posterior.hypotheses)
    rows = [(h, float(p)) for h, p in zip(posterior.hypotheses, P, strict=True) if lead <= {*h.members} and not h.heat]
    whole, better = sum(p for _, p in rows), []
    for h, p in rows:
        if h.fit is not None and len(set(h.members) - lead) == 1:
            error = next(rms(x.r) for x in h.fit.parts if (x.test, x.channel) == (s.test, s.channel))
            if error < LESS * rms(s.r):
                better.append((p / whole, h, error))
    p, best, error = max(better, key=lambda x: x[0], default=(0.0, None, 0.0))
    if best is None or p < REPORTED:
        return None, 0.0, 0.0
    return posterior.evidence.causes[min(set(best.members) - lead)], p, error


def sentence(
    verdict: Verdict,
    posterior: Posterior,
    choice: Decision,
    rows: Sequence[Candidate],
    pulls: Pulls,
    broken: PlainFaults,
    left: Sequence[Remainder] = (),
) -> str:
    """The verdict in words, with its odds.  left : what stays off, worst first"""
    hides = "it may hide a missing effect"
    if broken:
        rest = sentence(choice.verdict, posterior, choice, rows, pulls, PlainFaults(), left) if broken.names else ""
        return f"check the measurement first: {broken.words}" + (f"; without those readings: {rest}" if rest else "")
    if verdict == "adequate":
        none, sure = percent(1.0 - choice.sure), " sure" * bool(choice.withheld)
        words = f"no{sure} evidence of a missing effect (nothing missing: {none})"
        if choice.sure > EVEN and rows:
            words = f"whether something is missing cannot be told: nothing {none}, {rows[0].words} "
            words += percent(rows[0].probability)
        if off := [r for r in left if not (r.effect or r.forgiven)]:
            where = f"{off[0].channel} is {off[0].error_K:.1f} K off in {off[0].record}, and nothing explains it"
            words = f"nothing with a{sure} name is missing ({none}); {where}"
        return "; ".join([*filter(None, [r.forgiven for r in left[:1]]), words])
    if verdict == "absorbed" and not choice.groups:
        return f"calibration of {value_words(pulls[0][0])} is {abs(pulls[0][2]):.1f} deviations from its prior: {hides}"
    if verdict == "absorbed":
        return f"{rows[0].words} would do what calibration of {value_words(rows[0].twin or '')} has done: {hides}"
    if verdict == "outside" and (contradictions := [c.words for c in choice.checks if c.contradicts]):
        return "; ".join(contradictions)
    if verdict == "outside":
        place = f" at {posterior.heat[0].place}" if posterior.heat and posterior.best.heat else ""
        return f"heat is missing or in excess{place}; nothing in the catalogue explains it ({percent(choice.sure)})"
    heat = _leading_heat(posterior, rows)
    each = [_group_words(posterior, g, rows, () if i else heat) for i, g in enumerate(choice.groups)]
    clause = CLAUSE if each[-1].endswith(CLAUSE) else ""  # once, at the end
    words = "; ".join(w.removesuffix(clause) for w in each) + clause
    return words + ("; check the measurement first" if verdict == "data" else "")


def _leading_heat(posterior: Posterior, rows: Sequence[Candidate]) -> tuple[str, ...]:
    """Heat of unknown cause at every place where that is more probable than any cause with a name."""
    P = probabilities(posterior.hypotheses)
    least = max((r.probability for r in rows), default=0.0)
    places = [(float(p), h.heat) for h, p in zip(posterior.hypotheses, P, strict=True) if h.heat and p > least]
    return tuple(f"heat of unknown cause at {place} ({percent(p)})" for p, place in sorted(places, reverse=True))


def _group_words(posterior: Posterior, group: Group, rows: Sequence[Candidate], heat: Sequence[str] = ()) -> str:
    """heat : what else it may be, more probable than all of them"""
    e, by_name = posterior.evidence, {r.effect: r for r in rows}
    best = by_name.get(e.names[group[0]])
    if len(group) == 1 and best and not heat:
        effect = e.effects[group[0]]
        if isinstance(effect, ReadingEffect):
            h = posterior.best if group[0] in posterior.best.members else posterior.single[group[0]]
            text = effect.words(best.value, e.fit.network, (h.fit or e.fit).values, best.ci95)
            return f"{text} ({percent(best.probability)})"
        size = "" if effect.whole else f", {best.value:.3g}{unit_suffix(best.unit)}{impossible_words(effect, best)}"
        return f"{'fault' if effect.fault else 'missing'}: {effect.statement}{size} ({percent(best.probability)})"
    probability = {k: by_name[e.names[k]].probability for k in group if e.names[k] in by_name}
    members = [(k, p) for k, p in probability.items() if p >= LEAST_MEMBER or k in group[:2]]
    likely = [*heat, *(f"{by_name[e.names[k]].words} ({percent(p)})" for k, p in members)]
    likely += [f"{len(group) - len(members)} less likely ones"] * (len(group) > len(members))
    return f"{' or '.join(likely)}{CLAUSE}"


def impossible_words(effect: Effect, row: Candidate) -> str:
    """That no material has such a size, where it is a property of one and the whole interval lies beside it."""
    (low, high), (a, b) = effect.typical, row.ci95
    if not effect.of_material or (a <= high and b >= low):
        return ""
    return f" (no physics has that: {low:g} to {high:g} is usual, so something else is in it)"


def unsteady_words(posterior: Posterior, choice: Decision) -> str:
    """What other instants of the same record would have said; "" where they say the same."""
    if not choice.others:
        return ""
    effects, d = posterior.evidence.effects, choice.others[0]

    def claim(x: Decision) -> str:
        every = " and ".join(" or ".join(effects[k].statement for k in g[:2]) for g in x.groups)
        return every or {"adequate": "nothing is missing"}.get(x.verdict, "heat of unknown cause")

    other = claim(d)
    if choice.withheld:
        return f"; {claim(choice.withheld)} is not named, since every second reading alone says {other}"
    single = any(len(g) == 1 for g in choice.groups)
    how = "not all are named: " if single else "no single name is given: "
    claimed = "" if choice.verdict in ("adequate", "outside") else how
    if d.groups and d.groups == choice.groups:
        return (
            f"; {how}every second reading alone cannot tell them apart" if single else "; nor can every second reading"
        )
    return f"; {claimed}every second reading alone says {other}"


def unseen_words(fit: Fit) -> str:
    """Where inputs between two rows move a record by more than it is otherwise uncertain; "" where they do not."""
    worst = 1.0, ""
    if fit.error is None:
        return ""
    for s in fit.parts:
        between = total_sd(fit.error.of(s)[:, fit.error.model_columns :])
        if between > worst[0] * s.weight:
            words = f"; inputs change between rows of {s.test}: unseen, they move {s.channel} by {between:.1f} K"
            worst = between / s.weight, words
    return worst[1]
