"""Which effect is missing, how probable, what it is confused with, and which test would decide."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from geom.errors import InputError
from geom.one_thread import one_blas_thread
from measured.case import Case
from measured.sensors.faults import PlainFaults, broken_channels, without
from validation.bases.which_base import BaseDeviance, base_hypotheses, wrong_bases
from validation.calibration.calibrate import no_progress
from validation.comparison.linearisation import rmse
from validation.consistency import checks
from validation.effects.above import KIND
from validation.effects.base import Effect
from validation.inference import decide, refit, say
from validation.inference.conditions import check_names, conditions, end_reach, law_errors
from validation.inference.contradiction import contradiction
from validation.inference.events import retimed
from validation.inference.evidence import (
    Evidence,
    LoudNoise,
    averaged_noise,
    calibrated_case,
    candidates,
    converged,
    joined,
    pairs,
    quiet,
    recalibrated,
    scored,
    sharpened,
    singles,
    thresholds,
)
from validation.inference.hypotheses import Members, Weighed, catalogue_priors, relative_evidence
from validation.inference.low_fidelity import fidelity_error, low_fidelity_case
from validation.inference.missing_heat import MissingHeat, Scan, scan_heat
from validation.inference.question import best_question, with_answers
from validation.inference.result import Diagnosis, Remainder
from validation.noise import Noise
from validation.planning.experiments import next_tests
from validation.planning.rivals import CompetingModels
from validation.planning.sensors import next_sensors
from validation.scope import Scope, odds_factor
from validation.yardstick.network_terms import network_terms

Progress = Callable[[str], None]
Report = Callable[[Callable[[], Diagnosis]], None]
NO_BUDGET: Mapping[str, float] = MappingProxyType({})
RIVALS = 4  # of a group are compared with each other where a plan is wanted
EVERYTHING = Scope()
PRELIMINARY = "preliminary odds, from a search that goes on without --quick"
CONFUSIONS = 12  # candidates whose traces are compared


def untold(so_far: object) -> None:
    """Nobody is told what is known so far."""


@one_blas_thread
def diagnose(
    case: Case,
    kinds: Sequence[str] | None = None,
    progress: Progress = no_progress,
    plan: bool = True,
    budget: Mapping[str, float] = NO_BUDGET,
    scope: Scope = EVERYTHING,
    quick: bool = False,
    report: Report = untold,
) -> Diagnosis:
    """Diagnose a case on its calibrate and validate tests; held-out tests are predicted once, after.

    A test that stood on another base than its sheet says is told before anything else. Readings of a channel that is
    plainly broken are told, and left out. Where the case has a small network beside its own, that is run.

    Parameters: `kinds` restricts the catalogue; `progress` is told what is being done; `plan`: also rank the next tests
    and sensors; `budget` channel -> error (K) of the model's own numbers there, what moves no reading by more is not
    named; `scope` what is asked about; `quick`: stop at the first odds, which are preliminary; `report` is told of what
    works out the same while the search goes on. Returns: the verdict with its odds and tables.
    """
    check_names(case, [*scope.without, *scope.only], "the effects asked for or left out")
    check_names(case, case.odds, "[odds] of case.toml")
    broken = broken_channels(case.training().tests)
    whole, case = case, low_fidelity_case(case, progress)
    training = case.training()
    training = replace(training, tests=without(training.tests, broken))
    bases = base_hypotheses(training, progress)
    wrong = wrong_bases(bases)

    def result(posterior: decide.Posterior, preliminary: bool) -> Diagnosis:
        small = fidelity_error(whole, case, posterior)
        most = {c: budget.get(c, 0.0) + small.get(c, 0.0) for c in {**budget, **small}}
        choice = decide.steady_decision(
            posterior, lambda p: decide.clear_decision(p, decide.decide(p.evidence, p.hypotheses), most)
        )
        left, first = say.remainder(case, posterior, choice, posterior.single), choice.groups
        if not preliminary:
            choice = decide.consistent_decision(choice, checks(case, posterior, choice, most, left))
        if wrong:  # nothing else is accused of what the base does
            choice = decide.Decision("data", (), choice.sure)
        if choice.groups != first:
            left = say.remainder(case, posterior, choice, posterior.single)
        faults = PlainFaults(tuple(broken), tuple(wrong))
        answer = tabulate(case, posterior, choice, faults, bases, left, plan and not preliminary, scope, preliminary)
        return replace(answer, small_network_K=small)

    posterior = infer(training, kinds, progress, scope, quick, lambda first: report(lambda: result(first, True)))
    progress("writing the tables")
    return result(posterior, quick)


def infer(
    case: Case,
    kinds: Sequence[str] | None = None,
    progress: Progress = no_progress,
    scope: Scope = EVERYTHING,
    quick: bool = False,
    report: Callable[[decide.Posterior], None] = untold,
) -> decide.Posterior:
    """Calibrate, score, weigh every hypothesis, refit what carries weight.

    Parameters: as of `diagnose`; `report` is told the first odds. Returns: every hypothesis with its log evidence over
    that of nothing.
    """
    fit = calibrated_case(case, progress)
    progress("scoring the catalogue")
    effects = [e for e in candidates(case, kinds) if scope.holds(e)]
    if not effects:
        right = "fewer of --without, others of --only"
        raise InputError("every effect that can be here is left out", f"case '{case.name}'", right)
    usual = catalogue_priors(effects)
    priors = {e.name: usual[e.name] + odds_factor(e, case.odds) for e in effects}
    evidence = sharpened(scored(case, effects, fit, priors))
    calm = quiet(evidence)
    against = contradiction(calm.fit, evidence.tests)
    progress("looking for where heat is missing")
    scan = scan_heat(evidence.fit, evidence.tests)
    heat = scan.read(evidence.fit.parts, evidence.fit.noise, evidence.fit.theta, evidence.fit.error)

    def is_wanted(effect: Effect) -> bool:
        return (kinds is None or effect.kind in kinds) and scope.holds(effect)

    selection = conditions(calm, case, scan, heat, is_wanted, progress)
    values = {**case.model.values, **evidence.fit.values}
    laws = law_errors(evidence, values) if kinds is None or KIND in kinds else {}
    laws |= network_terms(case, evidence, kinds)
    first = len(evidence.causes)
    more = {e: p + odds_factor(e, case.odds) for e, p in {**selection, **laws}.items() if scope.holds(e)}
    larger = joined(evidence, more, values)
    evidence = converged(sharpened(larger, range(first, first + len(selection))))
    hypotheses, heat = weigh(case, evidence, scan, fit.noise, progress)
    each = decide.united_events(evidence, relative_evidence(hypotheses))
    first_odds = decide.Posterior(evidence, each, tuple(heat), against)
    report(first_odds)
    if quick:
        return first_odds
    # the noise and the ends of events were set by tangents: once refits say them better, all is weighed anew
    progress("refitting the ends of what held for a while")
    before = evidence.names
    update, noise = retimed(evidence, hypotheses, end_reach(scan), refit.fine_refit), refit.refit_noise(hypotheses)
    if noise is not None or update is not evidence:
        evidence = converged(recalibrated(update, noise or update.fit.noise))
        warm_fits = {h.members: h.fit for h in hypotheses if h.fit and h.members}
        new_ends = [(k,) for k, name in enumerate(evidence.names) if name != before[k]]
        again = [*refit.weighty_refits(hypotheses), *new_ends]
        hypotheses, heat = weigh(case, evidence, scan, fit.noise, progress, warm_fits, again)
    every = refit.larger_sets(case, evidence, refit.fine_refits(evidence, hypotheses), progress)
    return decide.Posterior(evidence, decide.united_events(evidence, relative_evidence(every)), tuple(heat), against)


def weigh(
    case: Case,
    evidence: Evidence,
    scan: Scan,
    loudest: Noise,
    progress: Progress,
    warm_fits: refit.WarmFits = refit.NO_FITS,
    again: Collection[Members] = (),
) -> tuple[list[Weighed], list[MissingHeat]]:
    """All hypotheses, those that carry weight refitted, and where heat is missing.

    Parameters: `loudest` the noise that nothing asks for; `warm_fits` members -> a refit of theirs that may go on;
    `again` members of what is refitted in any case.
    """
    fit = evidence.fit
    heat = scan.read(fit.parts, fit.noise, fit.theta, fit.error)
    prior = {h.place: h.log_prior for h in scan.hypotheses}
    loud, ones = recalibrated(evidence, loudest), singles(evidence)
    every = [*ones, *pairs(evidence, ones), *(Weighed((), w.place, prior[w.place], w.log_bayes) for w in heat)]
    larger = LoudNoise.create(evidence, loud)
    evidence, every = replace(evidence, loud=larger), averaged_noise(every, loud, larger.over)
    return refit.refitted(evidence, with_answers(evidence, every, case.answers), progress, warm_fits, again), heat


def tabulate(
    case: Case,
    posterior: decide.Posterior,
    choice: decide.Decision,
    broken: PlainFaults,
    bases: Sequence[BaseDeviance],
    left: Sequence[Remainder],
    plan: bool,
    scope: Scope,
    preliminary: bool = False,
) -> Diagnosis:
    """The whole answer; the held-out tests of `case` are predicted here, after everything is decided."""
    e, members = posterior.evidence, [k for g in choice.groups for k in g][: say.ROWS]
    single = refit.group_refits(e, posterior.single, members)
    pulls = say.prior_pulls(e.fit)
    verdict = say.final_verdict(choice.verdict, posterior, choice, pulls, broken)
    rows = say.candidate_rows(case, posterior, choice, verdict, single)
    rivals = competing_models(e, choice, single) if plan and verdict in ("group", "several") else None
    groups = tuple(tuple(e.names[k] for k in g) for g in choice.groups)
    tests, sensors = (next_tests(e, rivals), next_sensors(e, rivals)) if rivals else ((), ())
    words = say.sentence(verdict, posterior, choice, rows, pulls, broken, left)
    words += say.unsteady_words(posterior, choice) + say.unseen_words(e.fit)
    return Diagnosis(
        verdict=verdict,
        words="; ".join(filter(None, [PRELIMINARY * preliminary, scope.words(case.odds), words])),
        named=tuple(g[0] for g in groups),
        groups=groups,
        candidates=rows,
        cannot_see=say.hidden_effects(e),
        where=posterior.heat,
        next_tests=tuple(tests),
        next_sensors=tuple(sensors),
        rmse_K=rmse(e.fit.parts),
        floor_K=float(np.sqrt(np.mean([s.weight**2 for s in e.fit.parts]))),
        threshold=float(np.min(thresholds(e))),
        pulls=pulls,
        cosine=say.confusion(e, [c.effect for c in rows[:CONFUSIONS]]),
        bases=tuple(bases),
        odds=say.odds(posterior, broken.names),
        explanations=say.explanations(posterior),
        p_nothing=0.0 if broken.names else 1.0 - choice.sure,
        events=say.possible_events(posterior),
        remainder=tuple(left),
        doubts=say.record_doubts(e.fit),
        contradiction=posterior.against,
        question=best_question(posterior),
        checks=choice.checks,
        without=scope.without,
        only=scope.only,
        preliminary=preliminary,
        stated_odds=tuple((name, o.share, o.reason) for name, o in case.odds.items()),
    )


def competing_models(e: Evidence, choice: decide.Decision, single: Mapping[int, Weighed]) -> CompetingModels | None:
    """The first group that could not be separated, with the refits of its leading members."""
    group = next((g for g in choice.groups if len(g) > 1), ())
    few = [k for k in group if not e.effects[k].whole][:RIVALS]
    fits = {k: fit for k in few if (fit := single[k].fit) is not None}
    return CompetingModels(tuple(fits), tuple(fits.values()), e.fit.noise) if len(fits) > 1 else None
