"""A verdict that hangs on which instants were looked at is withheld, and says so; what is shown of the odds."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from playground import Truth, wind

from measured.sensors.faults import PlainFaults
from validation.effects import effect
from validation.inference.decide import (
    Decision,
    Posterior,
    decide,
    half_posterior,
    steady_decision,
    united_events,
    united_groups,
)
from validation.inference.evidence import calibrated_case, scored, singles
from validation.inference.hypotheses import Weighed, inclusion, probabilities
from validation.inference.refit import laplace
from validation.inference.result import Remainder
from validation.inference.say import explanations, sentence, unsteady_words

NAMES = ("convection@flange.right", "brush.drop@commutator", "mass@shaft")


@cache
def posterior():
    case = Truth(12, wind("flange.right", 12.0)).case()
    e = scored(case, [effect(n) for n in NAMES], calibrated_case(case))
    return Posterior(e, tuple(laplace(e, h) if h.members else h for h in singles(e)), ())


@pytest.mark.parametrize("first", [0, 1])
def test_half_of_the_instants_say_the_same(first):
    """Model error is slow: half of the readings hold nearly all that the whole record does."""
    all_of_it, half = posterior(), half_posterior(posterior(), first)
    for s, t in zip(all_of_it.evidence.fit.parts, half.evidence.fit.parts, strict=True):
        np.testing.assert_array_equal(t.time, s.time[first::2])
    np.testing.assert_allclose(probabilities(half.hypotheses), probabilities(all_of_it.hypotheses), atol=0.1)
    assert half.best.members == all_of_it.best.members == (0,)
    assert half.best.log_bayes == pytest.approx(all_of_it.best.log_bayes, rel=0.25)


def test_what_was_too_improbable_to_be_refitted_stays_so():
    """Exchanged plugs that the readings contradict, beside an effect that gains next to nothing."""
    p = posterior()
    small = replace(p.best, log_bayes=0.1)
    impossible = Weighed((1,), "", -3.0, -5000.0)
    half = half_posterior(replace(p, hypotheses=(p.hypotheses[0], small, impossible)), 0)
    assert half.hypotheses[-1].log_bayes <= -5000.0


def test_what_stands_on_every_second_sample_is_left_as_it_is():
    def decision(p):
        return decide(p.evidence, p.hypotheses)

    choice = steady_decision(posterior(), decision)
    assert choice == decision(posterior())
    assert unsteady_words(posterior(), choice) == ""


def instants(p):
    return p.evidence.fit.parts[0].time.size


@pytest.mark.parametrize(
    ("on_half", "groups", "says"),
    [
        (
            Decision("named", ((1,),), 0.9),
            ((0, 1),),
            "every second reading alone says brush contact drop at commutator",
        ),
        (Decision("group", ((0, 2),), 0.9), ((0, 2),), "nor can every second reading"),
    ],
)
def test_a_name_that_half_of_the_instants_do_not_give_is_withheld(on_half, groups, says):
    whole = Decision("named", ((0,),), 0.95)
    choice = steady_decision(posterior(), lambda p: whole if instants(p) == instants(posterior()) else on_half)
    assert (choice.verdict, choice.groups, choice.sure) == ("group", groups, 0.95)
    assert says in unsteady_words(posterior(), choice)


@pytest.mark.parametrize(
    ("whole", "withheld"),
    [
        (Decision("named", ((0,),), 0.95), "forced convection by vehicle wind at flange.right"),
        (Decision("outside", (), 0.95), "heat of unknown cause"),
    ],
)
def test_nothing_is_told_where_half_of_the_instants_say_that_nothing_is_missing(whole, withheld):
    half = Decision("adequate", (), 0.4)
    choice = steady_decision(posterior(), lambda p: whole if instants(p) == instants(posterior()) else half)
    assert (choice.verdict, choice.groups, choice.sure) == ("adequate", (), 0.95)
    told = unsteady_words(posterior(), choice)
    assert told == f"; {withheld} is not named, since every second reading alone says nothing is missing"


@pytest.mark.parametrize(("nats", "verdict"), [(60.0, "named"), (45.0, "named"), (24.0, "adequate")])
def test_what_both_halves_find_together_is_paid_for_once(nats, verdict):
    """Five short openings that cost 20 nats to say, of which either half shows about a half; temper 1.5 to 2."""
    p = posterior()
    nothing, lid = (replace(h, loud=-np.inf) for h in (p.hypotheses[0], p.best))

    def decision(q):
        share = instants(q) / instants(p)
        weighed = (replace(h, log_bayes=share * h.log_bayes) for h in (nothing, replace(lid, log_bayes=nats)))
        prior = dict(zip((False, True), (h.log_prior for h in q.hypotheses), strict=True))
        return decide(q.evidence, [replace(h, log_prior=prior[bool(h.members)]) for h in weighed])

    few = replace(p, hypotheses=(replace(nothing, log_prior=-0.1), replace(lid, log_prior=-20.0)))
    assert decision(few).verdict == ("adequate" if nats < 30.0 else "named")
    assert steady_decision(few, decision).verdict == verdict


def test_the_order_within_a_group_is_no_other_verdict():
    whole, half = Decision("group", ((0, 1),), 0.9), Decision("group", ((1, 0),), 0.9)
    choice = steady_decision(posterior(), lambda p: whole if instants(p) == instants(posterior()) else half)
    assert choice == whole


def test_one_of_several_is_not_named_where_half_of_the_instants_do_not_name_it():
    whole, half = Decision("several", ((0,), (1,)), 0.9), Decision("several", ((0, 2), (1,)), 0.9)
    choice = steady_decision(posterior(), lambda p: whole if instants(p) == instants(posterior()) else half)
    assert (choice.verdict, choice.groups) == ("several", ((0, 2), (1,)))
    told = unsteady_words(posterior(), choice)
    assert told == "; not all are named: every second reading alone cannot tell them apart"


def test_what_one_group_has_joins_no_other():
    assert united_groups(((0,), (1,)), ((0, 2, 1),)) == ((0, 2), (1,))
    assert united_groups(((0,), (1,)), ((0,), (2,))) == ((0,), (1, 2))


def test_nothing_is_claimed_because_half_of_the_instants_would_claim_it():
    whole, half = Decision("adequate", (), 0.4), Decision("named", ((0,),), 0.9)
    choice = steady_decision(posterior(), lambda p: whole if instants(p) == instants(posterior()) else half)
    assert choice == replace(whole, others=(half, half))
    assert "every second reading alone says forced convection by vehicle wind" in unsteady_words(posterior(), choice)


def test_the_leading_cause_has_the_probability_of_its_row_among_the_candidates():
    p = posterior()
    first = explanations(p)[0]
    assert first.cause == "convection@flange.right"
    assert first.words == "forced convection by vehicle wind at flange.right"
    assert first.probability == inclusion(p.hypotheses, len(p.evidence.effects)).max()
    assert first.alone <= first.probability
    P, names = probabilities(p.hypotheses), p.evidence.names
    for cause, _, where_it_is in first.partners:
        both = sum(
            x for h, x in zip(p.hypotheses, P, strict=True) if {cause, first.cause} <= {names[k] for k in h.members}
        )
        assert where_it_is * first.probability == pytest.approx(both)


@pytest.mark.parametrize(
    ("effect_name", "model_K", "told"),
    [
        ("", 0.0, "nothing with a name is missing (60 %); T is 6.4 K off in b, and nothing explains it"),
        (
            "",
            6.0,
            "6.0 of the 6.4 K at T in b are forgiven as slow; no evidence of a missing effect (nothing missing: 60 %)",
        ),
        ("mass@core", 0.0, "no evidence of a missing effect (nothing missing: 60 %)"),
    ],
)
def test_an_adequate_model_is_not_said_to_miss_nothing_where_a_sensor_stays_off(effect_name, model_K, told):
    left = Remainder("T", "b", 6.4, model_K, "slow", effect_name, 0.1, 1.0, "")
    assert sentence("adequate", posterior(), Decision("adequate", (), 0.4), (), (), PlainFaults(), [left]) == told


def test_what_is_more_likely_than_not_and_has_no_name_cannot_be_told():
    rows = [SimpleNamespace(words="a fan at feet", probability=0.23)]
    told = sentence("adequate", posterior(), Decision("adequate", (), 0.54), rows, (), PlainFaults())
    assert told == "whether something is missing cannot be told: nothing 46 %, a fan at feet 23 %"


def test_every_hypothesis_is_told_once():
    rows = explanations(posterior())
    assert abs(sum(row.probability for row in rows) - 1.0) < 1e-12
    assert len({row.cause for row in rows}) == len(rows)


def test_one_event_with_ends_a_sample_apart_is_one_thing():
    """The lid is named; a fan at another time and the same lid an hour later are other things."""
    lid, late, other, fan = (
        effect(f"convection.constant@{place} in b:{span}s")
        for place, span in (("a", "100-300"), ("a", "120-300"), ("a", "3700-3900"), ("b", "100-300"))
    )
    e = SimpleNamespace(effects=(lid, late, other, fan), tests=())
    every = [Weighed(members, log_bayes=b) for members, b in (((), 0.0), ((1,), 9.0), ((0,), 10.0), ((2,), 8.0))]
    every += [Weighed((1, 3), log_bayes=9.5), Weighed((0, 3), log_bayes=9.4), Weighed((), "a")]
    one = united_events(e, every)
    assert [h.members for h in one] == [(0,), (0, 3), (2,), (), ()]
    before, after = probabilities(every), dict(zip([(h.members, h.heat) for h in one], probabilities(one), strict=True))
    assert np.isclose(after[(0,), ""], before[1] + before[2])
    assert np.isclose(after[(0, 3), ""], before[4] + before[5])
    assert np.isclose(after[(), "a"], before[6])


def test_what_held_nearly_all_of_a_test_is_what_held_in_the_test():
    whole, most, half = (effect(f"blockage@a in b{span}") for span in ("", ":100-5900s", ":100-2900s"))
    e = SimpleNamespace(effects=(whole, most, half), tests=(SimpleNamespace(name="b", time=np.array([0.0, 6000.0])),))
    every = [Weighed(members, log_bayes=b) for members, b in (((), 0.0), ((1,), 9.0), ((0,), 8.0), ((2,), 7.0))]
    assert [h.members for h in united_events(e, every)] == [(1,), (2,), ()]


def test_heat_of_unknown_cause_that_is_more_probable_than_any_name_stands_first():
    p, choice = posterior(), Decision("group", ((0, 1),), 0.95)
    rows = [
        SimpleNamespace(effect=name, words=name, probability=odds, twin=None) for name, odds in zip(NAMES, (0.2, 0.1))
    ]
    heat = Weighed((), "shaft", p.best.log_prior, p.best.log_bayes + 3.0)
    words = sentence("group", replace(p, hypotheses=(*p.hypotheses, heat)), choice, rows, (), PlainFaults())
    assert words.startswith("heat of unknown cause at shaft (")
    assert f"or {NAMES[0]} (20 %) or {NAMES[1]} (10 %); these tests" in words
    assert sentence("group", p, choice, rows, (), PlainFaults()).startswith(NAMES[0])


def test_what_nothing_gains_by_a_noise_of_its_own_is_no_gain_under_that_noise():
    """Half of the readings hold less of that gain; a rival that has only the louder noise does not get the rest."""
    p = posterior()
    best = replace(p.best, log_bayes=p.best.log_bayes - 1000.0)
    rival = replace(p.single[2], log_bayes=-1000.0, loud=-1.0)
    half = half_posterior(replace(p, hypotheses=(p.hypotheses[0], best, rival)), 0)
    assert half.hypotheses[-1].loud < 5.0


def test_one_half_that_is_a_little_less_sure_takes_no_name_from_the_other():
    """Nothing has a third in one half and next to nothing in the other, and in the whole."""
    whole = Decision("named", ((0,),), 0.98)
    less = Decision("adequate", (), 0.66)
    halves = iter([whole, less, less])

    def decision(p):
        return whole if instants(p) == instants(posterior()) else next(halves)

    choice = steady_decision(posterior(), decision)
    assert choice.groups == ((0,),)
    assert choice.verdict == "group"
    assert unsteady_words(posterior(), choice).endswith("every second reading alone says nothing is missing")
