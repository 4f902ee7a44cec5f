"""How far the candidate tests would set rivals apart."""

from collections.abc import Iterator, Mapping

from geom.errors import ThermoscopeError
from lumped.model.multipliers import values_of
from measured.case import Test
from validation.comparison.linearisation import segments
from validation.inference.evidence import Evidence
from validation.inference.result import Experiment
from validation.inference.score import gram
from validation.planning import rivals
from validation.planning.candidate_tests import Experiment as Candidate
from validation.planning.permissible_current import current_levels, heat_limits, permissible_tests


def next_tests(evidence: Evidence, models: rivals.CompetingModels) -> list[Experiment]:
    """Tests that separate the group, best gain per hour first.

    Gain: the smallest deviance, over all pairs, by which the wrong one would fit worse with the new test added.
    Currents are those that the most probable rival permits. To ask all would be better, and cost a run more for each.
    """
    before, network, best = evidence.tests[-1], evidence.network, models.best
    limits = heat_limits(best.network, values_of(best.network, best.values), evidence.tests)
    candidates = {e.name: (e, plan) for e, plan in permissible_tests(before, network, [limits])}
    return [
        Experiment(
            "test",
            p.what,
            rivals.separable_pairs(evidence, p.gaps),
            p.gain,
            p.hours,
            currents=current_levels(candidates[p.what][1], before, network),
            current_factor=candidates[p.what][0].current_factor,
        )
        for p in rivals.refitted_gains(evidence, models, _planned(evidence, models, candidates))
    ]


def _planned(
    evidence: Evidence, models: rivals.CompetingModels, candidates: Mapping[str, tuple[Candidate, Test]]
) -> Iterator[rivals.Plan]:
    fit = evidence.fit
    p, columns = fit.theta.size, (*fit.unknowns.parameters, *(evidence.parameters[k] for k in models.group))
    for experiment, plan in candidates.values():
        try:
            test = rivals.predicted_readings(models.best, plan)
            parts = segments(evidence.network, [test], fit.values, columns)
            error = rivals.widened_error(evidence, [test])
        except ThermoscopeError:  # a model that lacks what cools it runs away in a test that is longer than its own
            continue
        (more,) = gram(parts, fit.noise, p, error).values()
        yield rivals.Plan(experiment.name, experiment.hours, [test], rivals.separation(evidence, models, more))
