"""Which effect is missing, how sure, what it is confused with, and which test would decide."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from validation.calibrate import Fit, calibrated, silent, square_of
from validation.case import AddedEffect, Case
from validation.evidence import Evidence, calibrated_case, candidates, null_of, possible, scored
from validation.experiments import next_tests
from validation.faults import broken_channels
from validation.findings import Candidate, Decision, Diagnosis, Hidden, NextSensor, NextTest, Verdict
from validation.fitting import working
from validation.null import Null
from validation.procedure.which_base import Hypothesis, bases_tried, wrong_bases
from validation.rivals import Race, constancy, race
from validation.sensors import next_sensors
from validation.sheet import rmse, segments
from validation.where import Latent, latent_heat

Array = NDArray[np.float64]
Progress = Callable[[str], None]
STEPS = 3
BEYOND = 1.6
LOCATED = 10.0
PULL = 3.0
COMPENSATED = 0.3
SILENT = 6.0
WORTH = 0.1
HIDES = "it may hide a missing effect"


@dataclass(frozen=True)
class Step:
    """One round of the search: the evidence, each candidate's kappa, and the race if one passed the threshold."""

    evidence: Evidence
    kappa: Array
    race: Race | None


def diagnose(
    case: Case,
    draws: int = 60,
    kinds: Sequence[str] | None = None,
    seed: int = 0,
    workers: int = 2,
    cache: Path | None = None,
    progress: Progress = silent,
    plan: bool = True,
) -> Diagnosis:
    """Diagnose a case on its calibrate and validate tests; held-out tests are only predicted.

    draws : data sets of the simulated null (40 for a quick look, 200 in earnest);  kinds : restrict the catalogue
    plan : also rank the next tests and scan for latent heat
    A test that stood on another base than its sheet says is told first; then no effect is searched for.
    """
    fit = calibrated_case(case, progress)
    progress("scoring the catalogue")
    evidence = possible(case, scored(case, candidates(case, kinds), fit))
    null = null_of(evidence, draws, seed, workers, cache, progress)
    limit = null.threshold()
    stood = bases_tried(case, progress)
    steps = [Step(evidence, null.kappa, None)] if wrong_bases(stood) else search(case, evidence, null, limit, progress)
    progress("looking for where heat is missing")
    where = latent_heat(fit, evidence.tests) if plan else []
    return conclude(case, steps, null, limit, where, plan, stood)


def search(case: Case, evidence: Evidence, null: Null, limit: float, progress: Progress) -> list[Step]:
    """Add the best candidate while one passes the threshold, each time calibrating and estimating the noise anew.

    A further effect that removes less than a tenth of the residual is not worth its place.
    """
    level = dict(zip(evidence.names, null.kappa, strict=True))
    steps: list[Step] = []
    for _ in range(STEPS + 1):
        kappa = np.array([level[n] for n in evidence.names])
        if np.max(evidence.score.z / kappa, initial=0.0) < limit or len(steps) == STEPS:
            return [*steps, Step(evidence, kappa, None)]
        found = race(evidence, kappa, limit, progress)
        if case.model.effects and explained(evidence, found) < WORTH:
            return [*steps, Step(evidence, kappa, None)]
        if steps and weak(evidence, found):
            return [*steps, Step(evidence, kappa, None)]
        steps.append(Step(evidence, kappa, found))
        if weak(evidence, found):
            return [*steps, Step(evidence, kappa, None)]
        best = evidence.effects[found.index[0]]
        case = with_effect(case, best.kind, best.place, found.best)
        network, unknowns = working(case)
        fit = calibrated(network, evidence.tests, unknowns, found.best.values, 1, progress, found.noise)
        evidence = scored(case, [e for e in evidence.effects if e.name != best.name], fit)
    return steps


def with_effect(case: Case, kind: str, place: str, fit: Fit) -> Case:
    """The case with one effect more, standing at fitted values."""
    model = case.model
    grown = replace(model, effects=(*model.effects, AddedEffect(kind, place)), values={**model.values, **fit.values})
    return replace(case, model=grown)


def conclude(
    case: Case, steps: list[Step], null: Null, limit: float, where: list[Latent], plan: bool,
    stood: Sequence[Hypothesis] = (),
) -> Diagnosis:  # fmt: skip
    """From the search to a verdict and its tables.  stood : the bases that were tried"""
    first = steps[0]
    groups = [tuple(s.evidence.names[k] for k in s.race.group) for s in steps if s.race]
    pulls = pulled(first.evidence.fit, null)
    broken = [*broken_channels(first.evidence.tests), *wrong_bases(stood)]
    verdict = judge(steps, null, groups, bool(pulls), bool(broken))
    table = tabulate(case, steps, limit, verdict)
    ahead = planned(steps, null) if plan else ()
    floor = float(np.sqrt(np.mean(null.floor**2)))
    return Diagnosis(
        verdict, words(verdict, groups, table, pulls, broken, where), tuple(g[0] for g in groups), tuple(groups), table,
        unseen(first, null), tuple(where), ahead, rmse(first.evidence.fit.parts), floor, limit, pulls,
        confusion(first, [c.effect for c in table[:12]]), sensed(steps) if plan else (), float(np.median(null.kappa)),
        tuple(stood),
    )  # fmt: skip


def judge(steps: list[Step], null: Null, groups: list[tuple[str, ...]], pulled_: bool, broken: bool) -> Verdict:
    """The verdict, method of docs/diagnosis."""
    last, rounds = steps[-1], [s for s in steps if s.race]
    if broken:
        return "data"
    left = last.evidence.score.z / last.kappa
    if beyond(last.evidence.fit, null) or (len(rounds) == STEPS and np.max(left, initial=0.0) > null.threshold()):
        return "outside"
    if not rounds:
        return "absorbed" if pulled_ else "adequate"
    if len(rounds) > 1:
        return "several"
    evidence, found = rounds[0].evidence, rounds[0].race
    assert found is not None
    if all(evidence.effects[k].fault for k in found.group):
        return "data"
    if weak(evidence, found):
        return "absorbed"
    if len(found.group) > 1:
        return "group"
    return "outside" if on_bound(evidence, found) else "named"


def beyond(fit: Fit, null: Null) -> bool:
    """Is more left than simulated machines of this kind leave, and more than a model may be wrong by?"""
    channels = list(dict.fromkeys(s.channel for s in fit.parts))
    own = [[s for s in fit.parts if s.channel == c] for c in channels]
    left = np.array([rmse(parts) for parts in own])
    allowed = np.array([np.sqrt(np.mean([s.model_K**2 for s in parts])) for parts in own])
    usual = np.maximum(np.maximum(null.floor, np.median(null.floor)), allowed)
    return bool(np.any(left > BEYOND * usual))


def explained(evidence: Evidence, found: Race) -> float:
    """Share of the residual's sum of squares that the best candidate removes."""
    return 1.0 - (rmse(found.best.parts) / rmse(evidence.fit.parts)) ** 2


def told_by_data(evidence: Evidence, found: Race) -> tuple[float, float]:
    """What the readings contribute to the best candidate's gain in deviance, and their share in it."""
    before, after = (square_of(fit.parts, found.noise) for fit in (evidence.fit, found.best))
    strain, eased = (float(np.sum((fit.theta / fit.unknowns.sd) ** 2)) for fit in (evidence.fit, found.best))
    gain = before - after + max(strain - eased, 0.0)
    return before - after, (before - after) / gain if gain > 0 else 0.0


def weak(evidence: Evidence, found: Race) -> bool:
    """Does the calibration explain the readings as well, against its priors only?"""
    best = found.index[0]
    if evidence.effects[best].fault:
        return False
    gain, share = told_by_data(evidence, found)
    return evidence.twins[best] is not None or (share < COMPENSATED and gain < SILENT)


def on_bound(evidence: Evidence, found: Race) -> bool:
    """Does the best candidate's amplitude stick to its upper physical bound?"""
    return bool(found.best.at_bound[-1])


def pulled(fit: Fit, null: Null) -> tuple[tuple[str, float, float], ...]:
    """Calibrated parameters further from their prior than chance allows: (name, value, prior deviations)."""
    pull = fit.theta / fit.unknowns.sd / null.pull_scale
    limit = max(PULL, pull_threshold(null))
    hit = [i for i in np.argsort(-np.abs(pull)) if abs(pull[i]) > limit]
    return tuple((fit.unknowns.names[i], fit.values[fit.unknowns.names[i]], float(pull[i])) for i in hit)


def pull_threshold(null: Null) -> float:
    best = np.max(np.abs(null.pulls / null.pull_scale), axis=1)
    return float(np.mean(best) + 2.6 * np.std(best))


def tabulate(case: Case, steps: list[Step], limit: float, verdict: Verdict, rows: int = 20) -> tuple[Candidate, ...]:
    """Candidates that were in a race first, then the others by score."""
    out: dict[str, Candidate] = {}
    for step in steps:
        if step.race:
            for k in step.race.index:
                out.setdefault(step.evidence.names[k], raced(case, step, k, limit, verdict))
    first = steps[0]
    for k in np.argsort(-first.evidence.score.z / first.kappa)[:rows]:
        out.setdefault(first.evidence.names[k], plain(first, int(k), limit))
    order = {"named": 0, "group": 1, "cannot-tell": 2, "no": 3}
    return tuple(sorted(out.values(), key=lambda c: (order[c.decision], -c.score)))


def plain(step: Step, k: int, limit: float) -> Candidate:
    """A row from the score alone."""
    e, s, kappa = step.evidence, step.evidence.score, float(step.kappa[k])
    a, half, twin = float(s.amplitude[k]), 1.96 * kappa * float(s.sd[k]), e.twins[k]
    like = s.cosine[k]
    near = [e.names[m] for m in np.argsort(-np.abs(like)) if m != k and abs(like[m]) > 0.9][:5]
    hidden = not s.visible[k] or s.absorbed[k] > 0.995
    return Candidate(
        e.names[k], float(s.z[k]) / kappa, limit, a, e.parameters[k].unit, (a - half, a + half),
        "cannot-tell" if hidden else "no", confused_with=tuple(near), absorbed=float(s.absorbed[k]),
        smallest_detectable=float(s.detectable(step.kappa, limit)[k]), twin=twin, title=e.effects[k].title,
        isolating_test=e.effects[k].isolating_test, kappa=kappa,
    )  # fmt: skip


def raced(case: Case, step: Step, k: int, limit: float, verdict: Verdict) -> Candidate:
    """A row with the refit's numbers."""
    assert step.race is not None
    e, found, row = step.evidence, step.race, plain(step, k, limit)
    fit, kappa = found.fits[found.index.index(k)], float(step.kappa[k])
    a, half = fit.values[e.names[k]], 1.96 * kappa * float(fit.sd[-1])
    before, after = rmse(e.fit.parts), rmse(fit.parts)
    group = tuple(e.names[m] for m in found.group if m != k)
    member = k in found.group
    decision: Decision = "no" if not member else "group" if group else "named"
    if decision == "named" and verdict in ("outside", "absorbed"):
        decision = "cannot-tell"
    return replace(
        row, value=a, ci95=(a - half, a + half), decision=decision, rmse_K=(before, after),
        explained=1.0 - (after / before) ** 2, holdout_rmse_K=held_out(case, e.fit, fit),
        confused_with=group if member else row.confused_with,
        same_over_tests=constancy(e, k, kappa),
    )  # fmt: skip


def held_out(case: Case, before: Fit, after: Fit) -> tuple[float, float] | None:
    """Error (K) on the held-out tests, with nothing fitted to them."""
    tests = [t for t in case.tests if t.role == "hold-out"]
    if not tests:
        return None
    return (rmse(segments(before.network, tests, before.values)), rmse(segments(after.network, tests, after.values)))


def unseen(step: Step, null: Null) -> tuple[Hidden, ...]:
    """Effects that would have to be unusually large to show, most hidden first."""
    e, s = step.evidence, step.evidence.score
    size = s.detectable(step.kappa, null.threshold())
    unusual = size / np.array([p.prior_sd for p in e.parameters])
    names, twins = e.fit.unknowns.names, e.twins
    hit = [int(k) for k in np.argsort(-unusual) if unusual[k] > 2.0 or twins[k]]
    return tuple(
        Hidden(e.names[k], float(size[k]), e.parameters[k].unit, twins[k] or names[s.absorber[k]]) for k in hit
    )


def planned(steps: list[Step], null: Null) -> tuple[NextTest, ...]:
    """Tests that would separate the first group that could not be separated."""
    for step, group, size in unresolved(steps):
        return tuple(next_tests(step.evidence, group, size, step.kappa))
    return ()


def sensed(steps: list[Step]) -> tuple[NextSensor, ...]:
    """Sensors that would separate the same group."""
    for step, group, size in unresolved(steps):
        return tuple(next_sensors(step.evidence, group, size, step.kappa))
    return ()


def unresolved(steps: list[Step]) -> Iterator[tuple[Step, tuple[int, ...], dict[int, float]]]:
    """Groups that could not be separated, with the amplitude of each member."""
    for step in steps:
        if step.race and len(step.race.group) > 1:
            found = step.race
            yield (
                step,
                found.group,
                {k: found.fits[found.index.index(k)].values[step.evidence.names[k]] for k in found.group},
            )


def confusion(step: Step, names: Sequence[str]) -> dict[str, dict[str, float]]:
    """Cosines between the traces of some candidates."""
    known = {n: k for k, n in enumerate(step.evidence.names)}
    c = step.evidence.score.cosine
    chosen = [n for n in names if n in known]
    return {a: {b: float(c[known[a], known[b]]) for b in chosen} for a in chosen}


def words(
    verdict: Verdict, groups: list[tuple[str, ...]], table: Sequence[Candidate], pulls: tuple, broken: Sequence[str],
    where: list[Latent],
) -> str:  # fmt: skip
    """The verdict in a sentence."""
    if verdict == "adequate":
        return "no evidence of a missing effect"
    if verdict == "absorbed":
        if pulls:
            return f"calibration of {pulls[0][0]} is {abs(pulls[0][2]):.1f} deviations from its prior: {HIDES}"
        return f"{table[0].effect} would do what calibration of {table[0].twin or 'the rest'} has done: {HIDES}"
    if broken:
        return f"check the measurement first: {'; '.join(broken)}"
    if verdict == "outside":
        place = f" at {where[0].place}" if where and where[0].evidence_nats > LOCATED else ""
        return f"heat is missing or in excess{place}; nothing in the catalogue explains all of it"
    if verdict == "data":
        return f"check the measurement first: {' or '.join(groups[0])}"
    best = table[0]
    if verdict == "named":
        return f"missing: {best.title} at {best.effect.split('@')[1]}, {best.value:.3g} {best.unit}"
    if verdict == "group":
        return f"one of {', '.join(groups[0])}; these tests and sensors cannot tell them apart"
    return "missing: " + "; ".join(" or ".join(g) for g in groups)
