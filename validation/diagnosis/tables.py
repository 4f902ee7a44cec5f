"""The tables and the sentence of a diagnosis, from its posterior and decision."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from geom.constants import NORMAL_95
from measured.case import Case, Test
from measured.doubt import USUAL
from measured.sensors.faults import PlainFaults
from validation.bases.which_base import Hypothesis as Base
from validation.calibration.calibrate import Fit, InnerProduct
from validation.comparison.linearisation import Segment, rmse, segments
from validation.conditions.events import possible_events
from validation.conditions.question import best_question
from validation.effects.above import Above
from validation.effects.during import During
from validation.inference.decision import Decision
from validation.inference.detection import smallest, thresholds
from validation.inference.evidence import Evidence, deviance
from validation.inference.posterior import Hypothesis, Posterior, inclusion, probabilities, tempered_by
from validation.inference.refits import laplace
from validation.inference.remainder import remainder
from validation.inference.result import Candidate, Decided, DetectionLimit, Diagnosis, Odds, Verdict
from validation.planning.competing_models import CompetingModels
from validation.planning.experiments import next_tests
from validation.planning.sensors import next_sensors

Array = NDArray[np.float64]
ROWS, LEAST_ODDS = 20, 1e-4  # candidates in the table; odds below one in ten thousand are not listed
LEAST_MEMBER = 0.02  # probability below which a member of a group is in the table, and not in the sentence
RIVALS = 4  # of a group are compared with each other where a plan is wanted


def tabulate(
    case: Case, posterior: Posterior, choice: Decision, broken: PlainFaults, bases: tuple[Base, ...], plan: bool
) -> Diagnosis:
    """The whole answer; the held-out tests of `case` are predicted here, after everything is decided."""
    e = posterior.evidence
    single = posterior.single
    for k in [k for g in choice.groups for k in g][:ROWS]:
        if single[k].fit is None:
            single[k] = laplace(e, single[k])
    pulls = at_prior_edge(e.fit)
    verdict = final(choice.verdict, posterior, choice, pulls, broken)
    rows = candidates(case, posterior, choice, verdict, single)
    rivals = contenders(e, choice, single) if plan and verdict in ("group", "several") else None
    groups = tuple(tuple(e.names[k] for k in g) for g in choice.groups)
    tests, sensors = (next_tests(e, rivals), next_sensors(e, rivals)) if rivals else ((), ())
    return Diagnosis(
        verdict=verdict,
        words=sentence(verdict, posterior, choice, rows, pulls, broken) + unsteady(posterior, choice),
        named=tuple(g[0] for g in groups),
        groups=groups,
        candidates=rows,
        cannot_see=hidden_effects(e),
        where=posterior.heat,
        next_tests=tuple(tests),
        next_sensors=tuple(sensors),
        rmse_K=rmse(e.fit.parts),
        floor_K=floor(e),
        threshold=float(np.min(thresholds(e))),
        pulls=pulls,
        cosine=confusion(e, [c.effect for c in rows[:12]]),
        bases=bases,
        odds=odds(posterior, broken.names),
        p_nothing=0.0 if broken.names else 1.0 - choice.sure,
        events=possible_events(posterior),
        remainder=remainder(posterior, choice, single),
        contradiction=posterior.against,
        question=best_question(posterior),
    )


def final(verdict: Verdict, posterior: Posterior, choice: Decision, pulls: Sequence, broken: PlainFaults) -> Verdict:
    """The decision with what the calibration says about itself: a machine that has to be bent is not adequate."""
    if broken:
        return "data"
    e = posterior.evidence
    if verdict == "adequate":
        return "outside" if over_model_error(e) else "absorbed" if pulls else "adequate"
    if verdict == "named" and e.twins[choice.groups[0][0]] is not None:
        return "absorbed"
    return verdict


def at_prior_edge(fit: Fit) -> tuple[tuple[str, float, float], ...]:
    """Parameters that calibration pulls further from their prior than one in twenty fits does any: name, value,
    deviations; and those at a physical bound beyond two deviations."""
    pull = fit.theta / fit.unknowns.sd
    limit = -float(ndtri(0.025 / pull.size))
    hit = (np.abs(pull) > limit) | (fit.at_bound & (np.abs(pull) > 2.0))
    order = [int(j) for j in np.argsort(-np.abs(pull)) if hit[j]]
    return tuple((fit.unknowns.names[j], fit.values[fit.unknowns.names[j]], float(pull[j])) for j in order)


def over_model_error(evidence: Evidence) -> bool:
    """Is more left than noise and model error allow: most records out of twice what a model may be wrong by?"""
    left = InnerProduct(evidence.fit.parts, evidence.fit.noise, evidence.fit.error).explained(
        evidence.fit.parts, evidence.fit.error
    )
    out = [np.sqrt(np.mean(s.r**2)) > 2.0 * s.weight for s in left]
    return bool(np.mean(out) > 0.5)


def floor(evidence: Evidence) -> float:
    """What a model of this kind may be wrong by (K), rms over all records."""
    return float(np.sqrt(np.mean([s.weight**2 for s in evidence.fit.parts])))


def odds(posterior: Posterior, sure: tuple[str, ...] = ()) -> tuple[Odds, ...]:
    """Every hypothesis that carries weight, most probable first; the rest as one line.

    sure : faults that are there beside whatever else is
    """
    P = probabilities(posterior.hypotheses)
    e = posterior.evidence
    rows = [_odds(e, h, float(p), sure) for h, p in zip(posterior.hypotheses, P, strict=True) if p > LEAST_ODDS]
    rows.sort(key=lambda o: -o.probability)
    rest = 1.0 - sum(o.probability for o in rows)
    return (*rows, Odds("others", (), max(rest, 0.0)))


def _odds(e: Evidence, h: Hypothesis, p: float, sure: tuple[str, ...]) -> Odds:
    """A hypothesis with when it held."""
    names = tuple(e.names[k] for k in h.members)
    name = " + ".join((*sure, *([h.name(e)] if names or h.heat or not sure else [])))
    conditions = [x for k in h.members if isinstance(x := e.effects[k], During)]
    tests = tuple(dict.fromkeys(t for x in conditions for t in x.tests))
    spans = [s for x in conditions if x.event for s in x.event.every]
    begin, end = spans[0] if len(spans) == 1 else (None, None)
    return Odds(name, (*sure, *names), p, h.nats, tests, begin, end)


def candidates(
    case: Case, posterior: Posterior, choice: Decision, verdict: Verdict, single: dict[int, Hypothesis]
) -> tuple[Candidate, ...]:
    """The groups' members, then the others by probability."""
    e = posterior.evidence
    share = inclusion(posterior.hypotheses, len(e.effects))
    members = [k for g in choice.groups for k in g]
    order = [*members, *(int(k) for k in np.argsort(-share, kind="stable") if k not in members)]
    size, limit = smallest(e), thresholds(e)
    lead = single[members[0]].fit if members else e.fit
    beside = Beside.of(case, posterior, lead)
    few = order[:ROWS]
    P = probabilities(posterior.hypotheses)
    refits = [h for i in np.argsort(-P, kind="stable") if (h := posterior.hypotheses[i]).fit]
    within = {k: next((h.fit for h in refits if k in h.members), single[k].fit) for k in few}
    rows = [
        _row(e, single[k], within[k], float(share[k]), float(limit[k]), float(size[k]), beside, k in members[:1])
        for k in few
    ]
    return tuple(
        replace(r, decision=_decided(r, k, choice, verdict), confused_with=_others(e, k, choice))
        for r, k in zip(rows, few, strict=True)
    )


def _decided(row: Candidate, k: int, choice: Decision, verdict: Verdict) -> Decided:
    group = next((g for g in choice.groups if k in g), ())
    if not group:
        return "cannot-tell" if row.absorbed > 0.995 else "no"
    if verdict in ("outside", "absorbed"):
        return "cannot-tell"
    return "named" if len(group) == 1 else "group"


def _others(e: Evidence, k: int, choice: Decision) -> tuple[str, ...]:
    group = next((g for g in choice.groups if k in g), ())
    if group:
        return tuple(e.names[m] for m in group if m != k)
    like = np.abs(e.score.cosine[k])
    return tuple(e.names[m] for m in np.argsort(-like) if m != k and like[m] > 0.9)[:5]


@dataclass(frozen=True)
class Beside:
    """What every refit is set beside.  lead : deviance of each record with the leading effect, empty without one
    temper : what divides log evidence;  tests, hold_out : held-out tests and what the model without it leaves there"""

    lead: Mapping[tuple[str, str], float]
    temper: float
    tests: tuple[Test, ...]
    hold_out: tuple[Segment, ...]

    @classmethod
    def of(cls, case: Case, posterior: Posterior, lead: Fit | None) -> Beside:
        tests = tuple(t for t in case.tests if t.role == "hold-out")
        e, share = posterior.evidence, tempered_by(posterior.hypotheses)
        return cls(deviance(e, lead) if lead else {}, share, tests, hold_out_residuals(tests, e.fit))


def _row(
    e: Evidence, h: Hypothesis, within: Fit | None, share: float, limit: float, size: float, beside: Beside, leads: bool
) -> Candidate:
    """A candidate by itself; its size is that in the most probable hypothesis it is in (`within`)."""
    k, s = h.members[0], e.score
    a, wide = float(s.amplitude[k]), float(np.sqrt(beside.temper))
    row = Candidate(
        e.names[k],
        h.nats,
        limit,
        a,
        e.parameters[k].unit,
        interval(a, wide * float(s.sd[k]), scatter(e, k)),
        "no",
        absorbed=float(s.absorbed[k]),
        smallest_detectable=size,
        twin=e.twins[k],
        title=e.effects[k].title,
        isolating_test=e.effects[k].isolating_test,
        probability=share,
    )
    if h.fit is None:
        return row
    before, after = rmse(e.fit.parts), rmse(h.fit.parts)
    if e.effects[k].whole:
        row = replace(row, value=1.0, ci95=(1.0, 1.0))
    elif within is not None:
        j = within.unknowns.names.index(e.names[k])
        a = float(within.theta[j])
        row = replace(row, value=a, ci95=interval(a, wide * float(within.sd[j]), scatter(e, k)))
    new = hold_out_residuals(beside.tests, h.fit)
    hold_out = (rmse(beside.hold_out), rmse(new)) if beside.tests else None
    tests = (*by_test(e.fit.parts, h.fit.parts, False), *by_test(beside.hold_out, new, True))
    return replace(
        row,
        rmse_K=(before, after),
        explained=1.0 - (after / before) ** 2,
        holdout_rmse_K=hold_out,
        tests=tests,
        note=against(e, h.fit, beside) if beside.lead and not leads else "",
    )


def interval(a: float, sd: float, scatter: float = 0.0) -> tuple[float, float]:
    """Central 95 % of an amplitude.  sd : of the refit, widened by the root of the temper that divides log evidence

    scatter : share of itself (one sigma) by which its law is wrong: no single amplitude fits a film of another exponent
    """
    half = NORMAL_95 * float(np.hypot(sd, scatter * a))
    return a - half, a + half


def scatter(e: Evidence, k: int) -> float:
    """By how much of itself an effect's amplitude is off because its correlation is; 0 for what is exact."""
    law = e.fit.error.law if e.fit.error else USUAL["law"]
    return law if e.effects[k].empirical else 0.0


def against(e: Evidence, fit: Fit, beside: Beside) -> str:
    """The record in which a rival fits worst beside the leading one."""
    rival = deviance(e, fit)
    worse = {key: 0.5 * (rival[key] - beside.lead[key]) for key in rival}
    (test, channel), nats = max(worse.items(), key=lambda x: x[1])
    return f"fits {channel} in {test} worse by {nats:.1f} nats" if nats > 1.0 else ""


def hold_out_residuals(tests: Sequence[Test], fit: Fit) -> tuple[Segment, ...]:
    """What a fit leaves on tests that nothing was fitted to."""
    return tuple(segments(fit.network, tests, fit.values)) if tests else ()


def by_test(
    before: Sequence[Segment], after: Sequence[Segment], is_hold_out: bool
) -> tuple[tuple[str, float, float, bool], ...]:
    """Name, error (K) before and after, and whether nothing was fitted to it, of each test."""
    names = dict.fromkeys(s.test for s in before)
    pairs = [[[s for s in parts if s.test == name] for parts in (before, after)] for name in names]
    return tuple((name, rmse(old), rmse(new), is_hold_out) for name, (old, new) in zip(names, pairs, strict=True))


def hidden_effects(e: Evidence) -> tuple[DetectionLimit, ...]:
    """Effects that would have to be unusually large to show, most hidden first."""
    size = smallest(e)
    unusual = size / np.array([p.prior_sd for p in e.parameters])
    names, twins = e.fit.unknowns.names, e.twins
    lasting = [not isinstance(x, During) for x in e.effects]
    hit = [int(k) for k in np.argsort(-unusual) if lasting[k] and (unusual[k] > 2.0 or twins[k])]
    return tuple(
        DetectionLimit(e.names[k], float(size[k]), e.parameters[k].unit, twins[k] or _absorber(e, k, names))
        for k in hit
    )


def _absorber(e: Evidence, k: int, names: Sequence[str]) -> str | None:
    j = int(e.score.absorber[k])
    return names[j] if j < len(names) else "model error"


def contenders(e: Evidence, choice: Decision, single: dict[int, Hypothesis]) -> CompetingModels | None:
    """The first group that could not be separated, with the refits of its leading members."""
    group = next((g for g in choice.groups if len(g) > 1), ())
    few = [k for k in group if not e.effects[k].whole][:RIVALS]
    fits = {k: fit for k in few if (fit := single[k].fit) is not None}
    return CompetingModels(tuple(fits), tuple(fits.values()), e.fit.noise) if len(fits) > 1 else None


def confusion(e: Evidence, names: Sequence[str]) -> dict[str, dict[str, float]]:
    """Cosines between the traces of some candidates."""
    index = {n: k for k, n in enumerate(e.names)}
    return {a: {b: float(e.score.cosine[index[a], index[b]]) for b in names} for a in names}


def sentence(
    verdict: Verdict,
    posterior: Posterior,
    choice: Decision,
    rows: Sequence[Candidate],
    pulls: Sequence,
    broken: PlainFaults,
) -> str:
    """The verdict in words, with its odds."""
    hides = "it may hide a missing effect"
    if broken:
        rest = sentence(choice.verdict, posterior, choice, rows, pulls, PlainFaults()) if broken.names else ""
        return f"check the measurement first: {broken.words}" + (f"; without those readings: {rest}" if rest else "")
    if verdict == "adequate":
        return f"no evidence of a missing effect (nothing missing: {percent(1.0 - choice.sure)})"
    if verdict == "absorbed" and not choice.groups:
        return f"calibration of {pulls[0][0]} is {abs(pulls[0][2]):.1f} deviations from its prior: {hides}"
    if verdict == "absorbed":
        return f"{rows[0].effect} would do what calibration of {rows[0].twin} has done: {hides}"
    if verdict == "outside":
        place = f" at {posterior.heat[0].place}" if posterior.heat and posterior.best.heat else ""
        return f"heat is missing or in excess{place}; nothing in the catalogue explains it ({percent(choice.sure)})"
    return "; ".join(_group(posterior, g, rows) for g in choice.groups) + (
        "; check the measurement first" if verdict == "data" else ""
    )


def unsteady(posterior: Posterior, choice: Decision) -> str:
    """What other instants of the same record would have said."""
    if not choice.others:
        return ""
    names, d = posterior.evidence.names, choice.others[0]
    other = " and ".join(" or ".join(names[k] for k in g[:2]) for g in d.groups)
    other = other or {"adequate": "nothing missing"}.get(d.verdict, "unknown heat")
    how = "not all are named: " if any(len(g) == 1 for g in choice.groups) else "no single name is given: "
    claimed = "" if choice.verdict in ("adequate", "outside") else how
    return f"; {claimed}every second sample alone leads to {d.verdict} ({other})"


def _group(posterior: Posterior, group: tuple[int, ...], rows: Sequence[Candidate]) -> str:
    e, by_name = posterior.evidence, {r.effect: r for r in rows}
    best = by_name.get(e.names[group[0]])
    if len(group) == 1 and best:
        effect = e.effects[group[0]]
        if isinstance(effect, Above):
            return f"{effect.words(best.value)} ({percent(best.probability)})"
        place = effect.words if isinstance(effect, During) else f"at {effect.place}"
        unit = "" if best.unit == "1" else f" {best.unit}"
        size = "" if effect.whole else f", {best.value:.3g}{unit}"
        return f"{'fault' if effect.fault else 'missing'}: {best.title} {place}{size} ({percent(best.probability)})"
    probability = {k: by_name[e.names[k]].probability for k in group if e.names[k] in by_name}
    likely = [f"{e.names[k]} {percent(p)}" for k, p in probability.items() if p >= LEAST_MEMBER or k in group[:2]]
    others = f" or {len(group) - len(likely)} less likely ones" if len(group) > len(likely) else ""
    return f"one of {', '.join(likely)}{others}; these tests and sensors cannot tell them apart"


def percent(p: float) -> str:
    """A probability in per cent, never rounded to certainty."""
    return f"{100 * min(p, 0.999):.0f} %" if p < 0.995 else "> 99 %"
