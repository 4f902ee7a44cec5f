"""Which effect is missing, how sure, what it is confused with, and which test would decide."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lumped.multipliers import values_of
from validation.bar import Bar, Simulation, bar_of
from validation.calibrate import Fit, Known, minimise, silent
from validation.case import AddedEffect, Case
from validation.effects import Effect
from validation.evidence import Evidence, calibrated_case, candidates, possible, scored, sharpened
from validation.faults import broken_channels
from validation.findings import Diagnosis
from validation.fitting import working
from validation.gates import relevance
from validation.procedure.which_base import Hypothesis, bases_tried, wrong_bases
from validation.rivals import Race, race, weak
from validation.rows import Step, confusion, planned, sensed, tabulate, unseen
from validation.sheet import rmse
from validation.threads import one_blas_thread
from validation.verdict import FURTHER, STEPS, judge, pulled, refused, strained, words
from validation.where import Latent, latent_heat

Array = NDArray[np.float64]
Progress = Callable[[str], None]
WORTH, CLEAR = 0.1, 1.6


@one_blas_thread
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
    evidence = possible(scored(case, candidates(case, kinds), fit))
    bar = bar_of(case, evidence, Simulation(draws, seed, workers, cache), sizes, progress)
    stood = bases_tried(case, progress)
    steps = [Step(evidence, bar.null.kappa, None)] if wrong_bases(stood) else search(case, evidence, bar, progress)
    progress("looking for where heat is missing")
    where = latent_heat(fit, evidence.tests)
    left = latent_heat(steps[-1].evidence.fit, evidence.tests) if len(steps) > 1 else where
    return conclude(case, steps, bar, where, left, plan, stood)


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
    return minimise(fit.network, evidence.tests, fit.unknowns, fit.theta, sharpened(fit),
                    values_of(fit.network, fit.values), 10, Known(fit.parts, nearby=False))  # fmt: skip


def with_effect(case: Case, new: Effect, values: Mapping[str, float]) -> Case:
    """The case with one effect more, standing at fitted values."""
    model = case.model
    grown = (*model.effects, AddedEffect(new.kind, new.place))
    return replace(case, model=replace(model, effects=grown, values={**model.values, **values}))


def conclude(
    case: Case, steps: list[Step], bar: Bar, where: list[Latent], left: list[Latent], plan: bool,
    stood: Sequence[Hypothesis] = (),
) -> Diagnosis:  # fmt: skip
    """From the search to a verdict and its tables.

    where, left : heat missing before, and with all in the model that was found;  stood : the bases that were tried
    """
    first, null = steps[0], bar.null
    groups = [tuple(s.evidence.names[k] for k in s.race.group) for s in steps if s.race]
    pulls, doubt = pulled(first.evidence.fit, first.evidence.fit, null), refused(steps)
    broken = [*broken_channels(first.evidence.tests), *wrong_bases(stood)]
    verdict = judge(steps, bar, left, bool(doubt), bool(pulls), bool(broken))
    table = tabulate(case, steps, bar, verdict)
    ahead = planned(steps) if plan else ()
    floor = float(np.sqrt(np.mean(null.floor**2)))
    told = words(verdict, groups, table, pulls, broken, left, null.heat_nats, doubt, strained(case, steps, null))
    return Diagnosis(
        verdict, told, tuple(g[0] for g in groups), tuple(groups), table,
        unseen(first, bar), tuple(where), ahead, rmse(first.evidence.fit.parts), floor, bar.threshold, pulls,
        confusion(first, [c.effect for c in table[:12]]), sensed(steps) if plan else (), float(np.median(null.kappa)),
        tuple(stood), null.heat_nats,
    )  # fmt: skip


def explained(evidence: Evidence, found: Race) -> float:
    """Share of the residual's sum of squares that the best candidate removes."""
    return 1.0 - (rmse(found.best.parts) / rmse(evidence.fit.parts)) ** 2


def trifling(evidence: Evidence, found: Race) -> bool:
    """Would everything that explains the readings as well as the best move none of them by as much as one minds?"""
    fits = [found.fit(k) for k in found.group]
    return not any(relevance(fit, fit.theta.size - 1).passed for fit in fits)
