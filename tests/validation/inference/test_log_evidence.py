"""The evidence of a noise against the dense normal distribution, and three effects found one beside the other."""

from dataclasses import replace

import numpy as np
import pytest
from playground import Truth, wind
from scipy.linalg import block_diag
from scipy.stats import multivariate_normal

from lumped.model.multipliers import values_of
from validation.calibration.calibrate import minimise
from validation.comparison.linearisation import segments
from validation.effects import effect, extended
from validation.inference.evidence import (
    LoudNoise,
    averaged_noise,
    calibrated_case,
    calibration_evidence,
    pairs,
    recalibrated,
    scored,
    sharpened,
    singles,
    with_members,
)
from validation.inference.hypotheses import Weighed, probabilities
from validation.inference.refit import (
    WEIGHT,
    continued_refit,
    exchanging_pairs,
    laplace,
    larger_sets,
    neighbour_tangents,
    refitted,
    shares,
    weighty_refits,
)
from validation.inference.score import fit_gram, gram, total
from validation.noise import Level, Noise

NAMES = ("convection@flange.right", "loss.constant@poles", "loss.constant@bearing.left", "sensor.bias@yoke")


def three(T, u, t):
    """Wind on one flange, and heat in two parts."""
    return {**wind("flange.right", 40.0)(T, u, t), "poles": 400.0, "bearing.left": 150.0}


@pytest.fixture(scope="module")
def evidence():
    case = Truth(12, three).case()
    return scored(case, [effect(n) for n in NAMES], calibrated_case(case))


def covariance(noise, s):
    level = noise.at(s)
    return level.white**2 * level.shape().matrix(s.time)


def test_columns_about_a_fit_make_the_same_matrix_as_all_of_it_anew(evidence):
    fit = evidence.fit
    known, anew = fit_gram(fit, evidence.parts), gram(evidence.parts, fit.noise, evidence.p, fit.error)
    for test, G in anew.items():
        for name, block in vars(G).items():
            np.testing.assert_allclose(getattr(known[test], name), block, rtol=1e-9, atol=1e-9 * np.abs(block).max())


def test_log_evidence_is_that_of_the_dense_normal_distribution(evidence):
    """r + J theta ~ N(0, noise + J P J' + D D') where everything is linear."""
    fit = evidence.fit
    few = [s for s in evidence.parts if s.channel in ("yoke", "flange.right")]
    J = np.vstack([s.J[:, : evidence.p] for s in few])
    D = np.vstack([fit.error.of(s) for s in few])
    z = np.concatenate([s.r for s in few]) + J @ fit.theta
    S = block_diag(*(covariance(fit.noise, s) for s in few)) + (J * fit.unknowns.sd**2) @ J.T + D @ D.T
    dense = multivariate_normal(np.zeros(z.size), S, allow_singular=False).logpdf(z) + 0.5 * z.size * np.log(
        2.0 * np.pi
    )
    found = calibration_evidence(fit, few, total(fit_gram(fit, few)))
    assert found == pytest.approx(dense + fit.noise.log_prior(few), rel=1e-6)


def test_determinant_of_the_noise(evidence):
    for s in evidence.parts[:3]:
        expected = np.linalg.slogdet(covariance(evidence.fit.noise, s))[1]
        assert evidence.fit.noise.logdet(s) == pytest.approx(expected, rel=1e-9)


def test_a_misfit_twice_the_allowed_is_one_deviation_from_its_prior(evidence):
    s = evidence.parts[0]
    allowed = s.model_K / s.weight

    def prior(factor):
        return Noise({s.channel: Level(1e-3, 0.0, 120.0, factor * allowed, 1200.0)}).log_prior([s])

    assert prior(1.0) == pytest.approx(0.0, abs=1e-9)
    assert prior(2.0) == pytest.approx(-0.5)
    assert prior(0.5) == pytest.approx(0.0, abs=1e-9)  # never below what a model is allowed


def test_a_larger_noise_can_only_help_what_explains_less(evidence):
    """Averaged over two noises the odds of nothing against the best effect come nearer to one."""
    ones = singles(evidence)
    best = max(ones[1:], key=lambda h: h.log_bayes)
    wide = averaged_noise(ones, evidence, -10.0)
    assert [h.log_bayes for h in wide] == [h.log_bayes for h in ones]
    assert wide[0].nats == pytest.approx(np.logaddexp(0.0, -10.0))
    same = next(h for h in wide if h.members == best.members)
    assert same.nats - wide[0].nats == pytest.approx(best.log_bayes, rel=1e-6)  # the same noise twice changes nothing


def test_a_refit_is_weighed_under_the_larger_noise_by_what_it_leaves_there(evidence):
    """As a refit under that noise would be; by its tangents about nothing it would keep what they promised too much."""
    best = max(singles(evidence)[1:], key=lambda h: h.log_bayes)
    levels = {n: replace(x, white=2.0 * x.white, slow=2.0 * x.slow) for n, x in evidence.fit.noise.levels.items()}
    loud = recalibrated(evidence, replace(evidence.fit.noise, levels=levels))
    known = LoudNoise.create(evidence, loud)
    direct, found = laplace(loud, best), laplace(replace(evidence, loud=known), best)
    assert found.loud == pytest.approx(known.over + direct.log_bayes, rel=0.05)
    assert LoudNoise.create(evidence, evidence).evidence(found.fit, found.log_bayes) == pytest.approx(found.log_bayes)


@pytest.mark.heavy
def test_three_effects_are_found_one_beside_the_other(evidence):
    case = Truth(12, three).case()
    sharp = sharpened(evidence)
    ones = singles(sharp)
    fitted = refitted(sharp, [*ones, *pairs(sharp, ones)])
    every = larger_sets(case, sharp, fitted)
    found = every[int(np.argmax(probabilities(every)))]
    assert isinstance(found, Weighed)
    assert {sharp.names[k] for k in found.members} == set(NAMES[:3])


def test_what_carried_weight_under_one_noise_is_refitted_under_the_next(evidence):
    """Though its tangents promise too little there: a rival must not vanish because it was not looked at again."""
    ones = singles(evidence)
    every = [*ones, *pairs(evidence, ones)]
    once = refitted(evidence, every)
    weighty = weighty_refits(once)
    assert weighty
    assert all(p > WEIGHT for p, h in zip(shares(once), once, strict=True) if h.members in weighty)
    idle = next(h.members for h in reversed(once) if h.members and not h.fit)
    warm_fits = {h.members: h.fit for h in once if h.fit and h.members}
    twice = {h.members: h for h in refitted(evidence, every, warm_fits=warm_fits, again=[idle]) if h.members}
    assert twice[idle].fit is not None
    assert sum(h.fit is not None for h in twice.values()) == 1 + sum(h.fit is not None for h in once if h.members)


def test_a_pair_that_exchanges_what_weighty_pairs_exchange_is_refitted_however_little_tangents_promise(evidence):
    """Of two members that stand for each other beside one partner, neither is left out beside another."""
    weighty = [Weighed(m, log_bayes=10.0, fit=evidence.fit) for m in ((0, 2), (1, 2), (0, 3))]
    fourth, apart = Weighed((1, 3), log_bayes=-20.0), Weighed((2, 3), log_bayes=-20.0)
    assert exchanging_pairs([Weighed(), *weighty, apart, fourth]) == [5]
    assert exchanging_pairs([Weighed(), *weighty, apart, replace(fourth, fit=evidence.fit)]) == []
    for i in range(3):  # without one of the three nothing says that they stand for each other
        idle = [replace(h, log_bayes=-20.0) if i == j else h for j, h in enumerate(weighty)]
        assert exchanging_pairs([Weighed(), *idle, apart, fourth]) == []


def to_the_end(evidence, network, unknowns, theta, held):
    noise, error = evidence.fit.noise, evidence.fit.error
    return minimise(network, evidence.tests, unknowns, theta, noise, held, 40, worth=1e-3, error=error)


def test_a_refit_that_goes_on_ends_no_worse_than_one_from_the_start_and_finely_at_its_optimum(evidence):
    (k,) = [evidence.names.index(NAMES[0])]
    before = laplace(evidence, Weighed((k,))).fit
    sharp = sharpened(evidence)
    onwards, anew = continued_refit(sharp, [k], before), laplace(sharp, Weighed((k,))).fit
    assert onwards.objective < anew.objective + 0.5  # half a nat: fits stop at a tenth or so
    fine = continued_refit(sharp, [k], onwards, fine=True)
    end = to_the_end(sharp, *with_members(sharp, [k])[:2], fine.theta, with_members(sharp, [k])[2])
    assert abs(fine.theta[-1] - end.theta[-1]) < 0.3 * end.sd[-1]


def test_tangents_beside_a_refit_are_differences_there(evidence):
    """Of the second of two effects, where the first was fitted alone."""
    one, other = (evidence.names.index(n) for n in NAMES[:2])
    alone = laplace(evidence, Weighed((one,))).fit
    (columns,) = neighbour_tangents(evidence, one, alone, [other]).values()
    step = 1.0
    values = {**evidence.fit.values, **alone.unknowns.values(alone.theta)}
    network = extended(evidence.fit.network, [evidence.effects[k] for k in (one, other)])
    low, high = (segments(network, evidence.tests, {**values, NAMES[1]: a}) for a in (0.0, step))
    for column, a, b in zip(columns, low, high, strict=True):
        np.testing.assert_allclose((a.r - b.r) / step, column, atol=1e-3 + 0.01 * np.abs(column).max())


def test_nothing_is_fitted_as_well_as_what_it_is_held_against(evidence):
    """A bearing's friction stands in for heat at nine deviations of its prior: far from where a fit begins."""
    fit = evidence.fit
    end = to_the_end(evidence, fit.network, fit.unknowns, fit.theta, values_of(fit.network, fit.values))
    assert fit.objective - end.objective < 2.0
