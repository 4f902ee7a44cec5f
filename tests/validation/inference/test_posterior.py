"""Evidence against closed integrals, probabilities against Bayes' rule, the decision against its costs."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from playground import Truth, wind
from scipy.integrate import quad
from scipy.stats import norm

from geom.errors import InputError
from measured.doubt import PRIOR, TABLE, TEMPER, USUAL, nats_worth, widened
from validation.effects import effect
from validation.inference.decide import SURE, decide
from validation.inference.evidence import (
    calibrated_case,
    pair_evidence,
    pairs,
    scored,
    single_evidence,
    singles,
    smallest_visible,
)
from validation.inference.hypotheses import Weighed, inclusion, probabilities
from validation.inference.refit import laplace, with_gains, with_shortfalls
from validation.inference.score import one_size

NAMES = (
    "convection@flange.right",
    "convection.constant@flange.right",
    "brush.drop@commutator",
    "sensor.bias@yoke",
    "mass@shaft",
)


@cache
def evidence():
    case = Truth(12, wind("flange.right", 12.0)).case()
    return scored(case, [effect(n) for n in NAMES], calibrated_case(case))


@pytest.mark.parametrize("sign", [1, 0, -1])
def test_bayes_factor_of_one_effect_is_the_integral_over_its_prior(sign):
    """Likelihood ratio exp(a u - a^2 V / 2), a ~ half-normal(s) on the side of the sign."""
    u, V, s = 2.3, 1.7, 0.8
    low, high = {1: (0.0, 12.0), 0: (-12.0, 12.0), -1: (-12.0, 0.0)}[sign]
    share = 1.0 if sign == 0 else 2.0
    whole, _ = quad(lambda a: np.exp(a * u - 0.5 * a**2 * V) * share * norm.pdf(a, 0.0, s), low, high)
    found = one_size(np.array([u]), np.array([V]), np.array([s]), np.array([sign]))
    assert found[0] == pytest.approx(np.log(whole), abs=1e-6)


def test_two_effects_that_share_nothing_are_worth_what_each_is():
    e = evidence()
    V = np.diag(np.diag(e.score.V))
    apart = replace(e, score=replace(e.score, V=V))
    a, b = np.array([0]), np.array([2])
    sd = np.array([p.prior_sd for p in e.parameters])
    each = [one_size(e.score.u[k], V[k, k], 1.0 * sd[k], e.score.sign[k]) for k in (0, 2)]
    sizes = [
        np.log(
            np.mean(
                [np.exp(one_size(e.score.u[k], V[k, k], f * sd[k], e.score.sign[k]) - each[i]) for f in (0.3, 1.0, 3.0)]
            )
        )
        for i, k in enumerate((0, 2))
    ]
    most = float(
        sum(each) + sum(sizes) + np.log(3.0)
    )  # the sizes of both are the same one: at most three times as likely
    assert float(pair_evidence(apart, a, b)[0]) <= most + 1e-9


def test_probabilities_follow_bayes_with_tempered_evidence():
    """A Bayes factor of 20 to the power of the temper counts as one of 20."""
    first, more = TEMPER["temper"].share, TEMPER["temper per nat"].share
    nats = nats_worth(np.log(20.0))
    assert nats / (first + more * nats) == pytest.approx(np.log(20.0))
    hypotheses = [Weighed(log_prior=np.log(0.5)), Weighed((0,), "", np.log(0.1), nats)]
    np.testing.assert_allclose(probabilities(hypotheses, 1.0), [0.5 / 2.5, 2.0 / 2.5])


def test_stated_odds_are_a_power_of_what_bayes_gives():
    """One monotone recalibration: the order stays, and two odds as far apart as the power makes them."""
    hypotheses = [Weighed(log_prior=np.log(p)) for p in (0.5, 0.3, 0.2)]
    plain, stated = probabilities(hypotheses, 1.0), probabilities(hypotheses)
    assert stated.sum() == pytest.approx(1.0)
    np.testing.assert_allclose(np.log(stated[0] / stated), TEMPER["sharpness"].share * np.log(plain[0] / plain))


def test_prior_shares_sum_to_their_classes():
    e, share = evidence(), evidence().prior
    faults = np.array([x.fault for x in e.effects])
    assert share[~faults].sum() == pytest.approx(PRIOR["effect"].share)
    assert share[faults].sum() == pytest.approx(PRIOR["fault"].share)
    assert sum(p.share for p in PRIOR.values()) == pytest.approx(1.0)


def test_the_true_effect_leads_and_a_refit_agrees():
    e = evidence()
    lead = max(singles(e), key=lambda h: h.log_prior + h.log_bayes)
    assert lead.members == (0,)
    again = laplace(e, lead)
    assert again.fit is not None
    assert again.log_bayes == pytest.approx(lead.log_bayes, rel=0.3)


def test_a_pair_never_outweighs_its_better_half_without_a_reason():
    """Nothing is gained by a second effect that the readings do not ask for: Occam's factor."""
    e = evidence()
    both = {h.members: h.log_bayes for h in pairs(e, singles(e))}
    one = dict(enumerate(single_evidence(e)))
    assert both[(0, 2)] < one[0] + max(one[2], 0.0) + 3.0


def test_inclusion_adds_up_over_hypotheses():
    hypotheses = [Weighed((0,), "", np.log(0.2)), Weighed((0, 1), "", np.log(0.3)), Weighed(log_prior=np.log(0.5))]
    first, both, _ = probabilities(hypotheses)
    np.testing.assert_allclose(inclusion(hypotheses, 3), [first + both, both, 0.0])


@pytest.mark.parametrize(
    ("nothing", "first", "second", "verdict"),
    [
        (0.9, 0.05, 0.05, "adequate"),
        (0.01, 0.97, 0.02, "named"),
        (0.02, 0.5, 0.48, "group"),
        (0.5, 0.4, 0.1, "adequate"),
    ],
)
def test_the_cheapest_statement_is_made(nothing, first, second, verdict):
    hypotheses = [
        Weighed(log_prior=np.log(nothing)),
        Weighed((0,), "", np.log(first)),
        Weighed((1,), "", np.log(second)),
    ]
    assert decide(evidence(), hypotheses).verdict == verdict


def test_faults_alone_are_data_and_unknown_heat_is_outside():
    fault = [Weighed(log_prior=np.log(0.05)), Weighed((3,), "", np.log(0.95))]
    heat = [Weighed(log_prior=np.log(0.05)), Weighed((), "yoke", np.log(0.95))]
    both = [Weighed(log_prior=np.log(0.02)), Weighed((0, 2), "", np.log(0.98))]
    assert [decide(evidence(), h).verdict for h in (fault, heat, both)] == ["data", "outside", "several"]
    assert 0.5 < SURE < 1.0


@pytest.mark.parametrize(("explained", "verdict"), [(0.95, "group"), (0.5, "outside")])
def test_unknown_heat_is_outside_only_where_nothing_with_a_name_explains_nearly_as_much(explained, verdict):
    nothing, named = Weighed(log_prior=np.log(0.5)), Weighed((0,), "", np.log(0.01), explained * 1000.0)
    heat = Weighed((), "yoke", np.log(0.05), 1000.0)
    assert probabilities([nothing, named, heat])[2] > 0.5
    assert decide(evidence(), [nothing, named, heat]).verdict == verdict


def test_every_two_effects_are_compared_and_those_of_most_weight_kept(monkeypatch):
    e = evidence()
    every = sorted(pairs(e, singles(e)), key=lambda h: -(h.log_prior + h.log_bayes))
    assert len(every) == len(NAMES) * (len(NAMES) - 1) // 2
    monkeypatch.setattr("validation.inference.evidence.PAIRS", 3)
    assert {h.members for h in pairs(e, singles(e))} == {h.members for h in every[:3]}


def test_an_effect_of_the_smallest_detectable_size_is_seen_four_times_in_five():
    """Scores drawn about that amplitude: 0.8 of 4000 pass the threshold, with a deviation of 0.006."""
    e, rng = evidence(), np.random.default_rng(0)
    a, k = smallest_visible(e), 0
    V, sd = e.score.V[k, k], e.parameters[k].prior_sd
    u = a[k] * V + np.sqrt(V) * rng.standard_normal(4000)
    limit = nats_worth(np.log(PRIOR["nothing"].share / e.prior[k]))
    seen = np.mean(one_size(u, np.full(4000, V), np.full(4000, sd), np.ones(4000, int)) > limit)
    assert seen == pytest.approx(0.8, abs=0.03)


def test_doubt_can_only_be_widened():
    assert widened({"bridge": 0.2})["bridge"] == 0.2
    assert set(USUAL) == set(TABLE)
    assert all(line.reason and line.sd > 0 for line in TABLE.values())
    for lines in ({"bridge": 0.01}, {"phlogiston": 1.0}):
        with pytest.raises(InputError, match=r"bridge|phlogiston"):
            widened(lines)


def test_pairs_that_were_not_refitted_know_what_the_refits_of_either_say():
    """A refit that falls 30 nats short of its tangent takes these from pairs that were never refitted; what one gains
    says which pairs to refit."""
    short, more = Weighed((0,), log_bayes=70.0), Weighed((1,), log_bayes=5.0)
    pair, other, done = Weighed((0, 2), log_bayes=72.0), Weighed((1, 2), log_bayes=6.0), Weighed((0, 1))
    fit = evidence().fit
    before = [short, more, pair, other, done]
    after = [
        replace(short, log_bayes=40.0, fit=fit),
        replace(more, log_bayes=9.0, fit=fit),
        pair,
        other,
        replace(done, log_bayes=41.0, fit=fit),
    ]
    assert [h.log_bayes for h in with_gains(before, after)] == [40.0, 9.0, 72.0, 10.0, 41.0]
    assert [h.log_bayes for h in with_shortfalls(before, after)] == [40.0, 9.0, 42.0, 6.0, 41.0]
