"""Which effect is missing, how sure, what it is confused with, and which test would decide."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from validation.bar import Bar, Simulation, bar_of
from validation.calibrate import Fit, minimise, silent
from validation.case import AddedEffect, Case
from validation.effects import Effect
from validation.evidence import Evidence, calibrated_case, candidates, possible, scored, sharpened
from validation.faults import broken_channels
from validation.findings import Candidate, Diagnosis, Verdict
from validation.fitting import working
from validation.gates import relevance
from validation.null import Null
from validation.procedure.which_base import Hypothesis, bases_tried, wrong_bases
from validation.rivals import Race, race, weak
from validation.rows import Step, confusion, planned, sensed, tabulate, unseen
from validation.sheet import rmse
from validation.where import Latent, latent_heat

Array = NDArray[np.float64]
Progress = Callable[[str], None]
STEPS = 3
BEYOND = 1.6
LOCATED = 10.0
PULL = 3.0
WORTH, FURTHER, CLEAR = 0.1, 1.25, 1.6
HIDES = "it may hide a missing effect"


def diagnose(
    case: Case,
    draws: int = 60,
    kinds: Sequence[str] | None = None,
    seed: int = 0,
    workers: int = 2,
    cache: Path | None = None,
    progress: Progress = silent,
    plan: bool = True,
    sizes: bool = False,
) -> Diagnosis:
    """Diagnose a case on its calibrate and validate tests; held-out tests are only predicted.

    draws : data sets of the simulated null (40 for a quick look, 200 in earnest);  kinds : restrict the catalogue
    plan : also rank the next tests and sensors;  sizes : search the smallest detectable sizes, half a second and more
    per effect; without it they are linear, which is often a tenth and at times several times too small
    A test that stood on another base than its sheet says is told first; then no effect is searched for.
    """
    fit = calibrated_case(case, progress)
    progress("scoring the catalogue")
    evidence = possible(case, scored(case, candidates(case, kinds), fit))
    bar = bar_of(case, evidence, Simulation(draws, seed, workers, cache), sizes, progress)
    stood = bases_tried(case, progress)
    steps = [Step(evidence, bar.null.kappa, None)] if wrong_bases(stood) else search(case, evidence, bar, progress)
    progress("looking for where heat is missing")
    where = latent_heat(fit, evidence.tests)
    return conclude(case, steps, bar, where, plan, stood)


def search(case: Case, evidence: Evidence, bar: Bar, progress: Progress) -> list[Step]:
    """Add the best candidate while one passes the threshold, each time calibrating and estimating the noise anew.

    An effect by another law than the true one leaves a misfit that the null does not know, so what follows in the same
    search has to pass FURTHER times the threshold. In a model that has effects, one that removes less than a tenth of
    the residual is worth its place only beyond CLEAR times the threshold. What moves no reading by 1 K is no reason to
    search: it may be in a group, but not be all of it.
    """
    level = dict(zip(evidence.names, bar.null.kappa, strict=True))
    steps: list[Step] = []
    for _ in range(STEPS + 1):
        kappa = np.array([level[n] for n in evidence.names])
        limit = bar.threshold * (FURTHER if steps else 1.0)
        best = np.max((evidence.score.z / kappa)[evidence.matters], initial=0.0)
        if best < limit or len(steps) == STEPS:
            return [*steps, Step(evidence, kappa, None)]
        found = race(evidence, kappa, limit, progress, {} if steps else bar.refits)
        little = explained(evidence, found) < WORTH and best < CLEAR * bar.threshold
        if (case.model.effects and little) or (steps and weak(evidence, found)) or trifling(evidence, found):
            return [*steps, Step(evidence, kappa, None)]
        if weak(evidence, found):
            return [*steps, Step(evidence, kappa, found), Step(evidence, kappa, None)]
        progress(f"adding {', '.join(evidence.names[k] for k in found.group)} in turn")
        settled = {k: added(case, evidence, k, found) for k in found.group}
        steps.append(Step(evidence, kappa, found, settled))
        best = found.index[0]
        case, fit = with_effect(case, evidence.effects[best], settled[best].values), sharper(evidence, settled[best])
        evidence = scored(case, [e for e in evidence.effects if e.name != evidence.names[best]], fit)
    return steps


def added(case: Case, evidence: Evidence, k: int, found: Race) -> Fit:
    """The model with a candidate in it: as large as the data say, the exponents of its law as free as the model's."""
    start = found.fit(k).values
    network, unknowns = working(with_effect(case, evidence.effects[k], start))
    held = {p.name: start.get(p.name, p.value) for p in network.parameters}
    return minimise(network, evidence.tests, unknowns, unknowns.coordinates(start), found.noise, held)


def sharper(evidence: Evidence, fit: Fit) -> Fit:
    """The fit gone on under the noise of the residual that it leaves."""
    values = fit.values
    held = {p.name: values.get(p.name, p.value) for p in fit.network.parameters}
    return minimise(fit.network, evidence.tests, fit.unknowns, fit.theta, sharpened(fit), held, 10)


def with_effect(case: Case, new: Effect, values: Mapping[str, float]) -> Case:
    """The case with one effect more, standing at fitted values."""
    model = case.model
    grown = (*model.effects, AddedEffect(new.kind, new.place))
    return replace(case, model=replace(model, effects=grown, values={**model.values, **values}))


def conclude(
    case: Case, steps: list[Step], bar: Bar, where: list[Latent], plan: bool, stood: Sequence[Hypothesis] = (),
) -> Diagnosis:  # fmt: skip
    """From the search to a verdict and its tables.  stood : the bases that were tried"""
    first, null = steps[0], bar.null
    groups = [tuple(s.evidence.names[k] for k in s.race.group) for s in steps if s.race]
    pulls = pulled(first.evidence.fit, null)
    broken = [*broken_channels(first.evidence.tests), *wrong_bases(stood)]
    verdict = judge(steps, bar, groups, bool(pulls), bool(broken))
    table = tabulate(case, steps, bar, verdict)
    ahead = planned(steps) if plan else ()
    floor = float(np.sqrt(np.mean(null.floor**2)))
    return Diagnosis(
        verdict, words(verdict, groups, table, pulls, broken, where), tuple(g[0] for g in groups), tuple(groups), table,
        unseen(first, bar), tuple(where), ahead, rmse(first.evidence.fit.parts), floor, bar.threshold, pulls,
        confusion(first, [c.effect for c in table[:12]]), sensed(steps) if plan else (), float(np.median(null.kappa)),
        tuple(stood),
    )  # fmt: skip


def judge(steps: list[Step], bar: Bar, groups: list[tuple[str, ...]], pulled_: bool, broken: bool) -> Verdict:
    """The verdict, method of docs/diagnosis."""
    last, rounds = steps[-1], [s for s in steps if s.race]
    if broken:
        return "data"
    left = (last.evidence.score.z / last.kappa)[last.evidence.matters]
    if beyond(last.evidence.fit, bar.null) or (len(rounds) == STEPS and np.max(left, initial=0.0) > bar.threshold):
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


def trifling(evidence: Evidence, found: Race) -> bool:
    """Would everything that explains the readings as well as the best move none of them by as much as one minds?"""
    fits = dict(zip(found.index, found.fits, strict=True))
    return not any(relevance(fits[k], fits[k].theta.size - 1).passed for k in found.group)


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
