"""Which effect is missing, how probable, what it is confused with, and which test would decide."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from measured.case import Case
from measured.sensors.faults import PlainFaults, broken_channels, without
from validation.bases.which_base import base_hypotheses, wrong_bases
from validation.calibration.calibrate import no_progress
from validation.conditions.conditional_effects import conditions, reach
from validation.conditions.contradiction import contradiction
from validation.conditions.laws import laws
from validation.conditions.question import answered
from validation.conditions.refine import joined
from validation.conditions.retime import retimed
from validation.conditions.robust import quiet
from validation.diagnosis.numerical_error import signal_to_error
from validation.diagnosis.tables import tabulate
from validation.effects.above import KIND
from validation.inference.decision import Decision, decide
from validation.inference.evidence import (
    Evidence,
    calibrated_case,
    candidates,
    converged,
    log_evidence,
    noise_beside,
    scored,
    under,
    with_noise,
)
from validation.inference.missing_heat import MissingHeat, Scan, scan
from validation.inference.multifidelity import at_low_fidelity, fidelity_error
from validation.inference.posterior import (
    Hypothesis,
    Posterior,
    against_nothing,
    averaged,
    pairs,
    singles,
    unknown_heat,
    weights,
)
from validation.inference.refits import NOWHERE, WarmFits, finely, noise_of_refits, refitted, weighty_refits
from validation.inference.result import Diagnosis
from validation.inference.several import further
from validation.inference.steadiness import steady
from validation.noise import Noise
from validation.threads import one_blas_thread, side_by_side

Progress = Callable[[str], None]
CONTENDERS = 8  # effects whose own noise is looked at: one of them leads under any
NO_BUDGET: Mapping[str, float] = MappingProxyType({})


@one_blas_thread
def diagnose(
    case: Case,
    kinds: Sequence[str] | None = None,
    progress: Progress = no_progress,
    plan: bool = True,
    budget: Mapping[str, float] = NO_BUDGET,
) -> Diagnosis:
    """Diagnose a case on its calibrate and validate tests; held-out tests are predicted once, after.

    kinds : restrict the catalogue;  plan : also rank the next tests and sensors
    budget : channel -> error (K) of the model's own numbers there; what moves no reading by more is not named
    A test that stood on another base than its sheet says is told before anything else. Readings of a channel that is
    plainly broken are told, and left out. Where the case has a small network beside its own, that is run.
    """
    broken = broken_channels(case.training().tests)
    whole, case = case, at_low_fidelity(case, progress)
    training = case.training()
    training = replace(training, tests=without(training.tests, broken))
    base_rows = base_hypotheses(training, progress)
    posterior = infer(training, kinds, progress)
    wrong, small = wrong_bases(base_rows), fidelity_error(whole, case, posterior)
    budget = {c: budget.get(c, 0.0) + small.get(c, 0.0) for c in {**budget, **small}}
    choice = steady(posterior, lambda p: above(p, decide(p.evidence, p.hypotheses), budget))
    if wrong:  # nothing else is accused of what the base does
        choice = Decision("data", (), choice.sure)
    progress("writing the tables")
    return tabulate(case, posterior, choice, PlainFaults(tuple(broken), tuple(wrong)), tuple(base_rows), plan)


def above(posterior: Posterior, choice: Decision, budget: Mapping[str, float]) -> Decision:
    """The decision without what the error of the model's own numbers could pass for."""
    e, single = posterior.evidence, posterior.single
    clear = tuple(g for g in choice.groups if signal_to_error(moved(e, single[g[0]]), budget).above_budget)
    if len(clear) == len(choice.groups):
        return choice
    return Decision(choice.verdict if clear else "adequate", clear, choice.sure)


def moved(evidence: Evidence, h: Hypothesis) -> dict[str, float]:
    """Channel -> largest change (K) that one effect makes there at its size, all else held."""
    k, p = h.members[0], evidence.p
    out: dict[str, float] = {}
    size = 1.0 if evidence.effects[k].whole else float(evidence.score.amplitude[k] if h.fit is None else h.fit.theta[p])
    for s in evidence.parts:
        out[s.channel] = max(out.get(s.channel, 0.0), float(np.max(np.abs(size * s.J[:, p + k]))))
    return out


def infer(case: Case, kinds: Sequence[str] | None = None, progress: Progress = no_progress) -> Posterior:
    """Calibrate, score, weigh every hypothesis, refit what carries weight."""
    fit = calibrated_case(case, progress)
    progress("scoring the catalogue")
    evidence = sharpened(scored(case, candidates(case, kinds), fit))
    calm = quiet(evidence)
    against = contradiction(calm.fit, evidence.tests)
    progress("looking for where heat is missing")
    heat_scan = scan(evidence.fit, evidence.tests)
    heat = heat_scan.read(evidence.fit.parts, evidence.fit.noise, evidence.fit.theta, evidence.fit.error)
    selection = conditions(calm, case, heat_scan, heat, kinds, progress)
    values = {**case.model.values, **evidence.fit.values}
    law_errors = laws(evidence, values) if kinds is None or KIND in kinds else []
    first = len(evidence.effects)
    evidence = converged(
        sharpened(joined(evidence, [*selection, *law_errors], values), range(first, first + len(selection)))
    )
    hypotheses, heat = weighed(case, evidence, heat_scan, fit.noise, progress)
    update, noise = retimed(evidence, hypotheses, reach(heat_scan)), noise_of_refits(hypotheses)
    if noise is not None or update is not evidence:
        evidence = converged(under(update, noise or update.fit.noise))
        warm_fits = {h.members: h.fit for h in hypotheses if h.fit and h.members}
        again = weighty_refits(hypotheses)
        hypotheses, heat = weighed(case, evidence, heat_scan, fit.noise, progress, warm_fits, again)
    every = further(case, evidence, finely(evidence, hypotheses), progress)
    return Posterior(evidence, tuple(against_nothing(every)), tuple(heat), against)


def weighed(
    case: Case,
    evidence: Evidence,
    heat_scan: Scan,
    loudest: Noise,
    progress: Progress,
    warm_fits: WarmFits = NOWHERE,
    again: Collection[tuple[int, ...]] = (),
) -> tuple[list[Hypothesis], list[MissingHeat]]:
    """All hypotheses, those that carry weight refitted, and where heat is missing.

    loudest : the noise that nothing asks for;  warm_fits : members -> a refit of theirs that may go on
    again : members of what is refitted in any case
    """
    heat = heat_scan.read(evidence.fit.parts, evidence.fit.noise, evidence.fit.theta, evidence.fit.error)
    loud, ones = under(evidence, loudest), singles(evidence)
    every = [*ones, *pairs(evidence, ones), *unknown_heat({w.place: w.log_bayes for w in heat})]
    every = averaged(every, loud, log_evidence(loud) - log_evidence(evidence))
    return refitted(evidence, answered(evidence, every, case.answers), progress, warm_fits, again), heat


def sharpened(evidence: Evidence, also: Sequence[int] = (), rounds: int = 2) -> Evidence:
    """The evidence under the noise that is left beside the leading effect: what is missing is no noise.

    also : effects that may lead, most probable first, although they seem small beside the noise of nothing
    """
    for _ in range(rounds):
        noise = noise_of_leader(evidence, also)
        if noise is None:
            break
        evidence = under(evidence, noise)
    return evidence


def noise_of_leader(evidence: Evidence, also: Sequence[int] = ()) -> Noise | None:
    """The noise left beside the effect that, with its own noise, has most evidence; None where nothing has more."""
    e, ones = evidence, singles(evidence)
    leading = [k for i in np.argsort(-weights(ones), kind="stable") for k in ones[i].members if not e.effects[k].whole]
    few = [ones[1 + k] for k in dict.fromkeys([*leading[:CONTENDERS], *also[:CONTENDERS]])]

    def beside(h: Hypothesis) -> tuple[float, Noise]:
        noise = noise_beside(e, h.members)
        return with_noise(e, h.members, noise) + h.log_prior, noise

    gain, noise = max(side_by_side(beside, few), key=lambda x: x[0], default=(-np.inf, None))
    return noise if gain > log_evidence(e) + ones[0].log_prior else None
