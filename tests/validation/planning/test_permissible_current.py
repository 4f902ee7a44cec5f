"""A planned test makes no place hotter than the tests at hand made it, and has no less current than it may."""

from dataclasses import replace

import numpy as np
import pytest
from playground import network, stand

from lumped.integration.simulate import simulate
from measured.case import Test
from validation.comparison.predict import record
from validation.planning.candidate_tests import candidate_tests
from validation.planning.permissible_current import (
    BEARABLE_C,
    MARGIN,
    current_levels,
    heat_limits,
    permissible_factor,
    permissible_tests,
)

MODEL = network()
HOT = 330.0  # A: some nodes pass BEARABLE_C in the test at hand, others do not
HELD = "DC heating at standstill"
RECORDED = "fan flow halved midway"
WARM = "ambient raised by 20 K"


def driven(current=HOT, every=1, hours=1.0):
    """A test at hand, of which only the inputs count;  every : how many of its samples are left"""
    time = np.arange(0.0, 3600.0 * hours, 10.0)
    inputs = stand(current, 700.0)(time, np.random.default_rng(1))
    part = slice(None, None, every)
    air = {"ambient": np.full_like(time, 20.0)[part]}
    return Test("driven", "calibrate", time[part], {k: v[part] for k, v in inputs.items()}, air, ())


def planned(test, model=MODEL, before=None):
    """Name -> candidate test and plan.  before : another test at hand that says what the machine has borne"""
    limits = heat_limits(model, {}, [before or test])
    return {e.name: (e, plan) for e, plan in permissible_tests(test, model, [limits])}


def hottest(test, model=MODEL):
    """(n_node,) degC, by a run of its own at the precision of pictures."""
    return simulate(model, record(test, {}), {}, keep_states=True).z[:, : len(model.states)].max(axis=0)


NAMES = [e.name for e, _ in candidate_tests(driven(), MODEL)]


@pytest.mark.parametrize("name", NAMES)
def test_nothing_gets_hotter_than_it_was_and_the_current_is_no_less_than_it_may(name):
    before = hottest(driven())
    assert np.any(before > BEARABLE_C)
    assert np.any(before < BEARABLE_C)
    experiment, plan = planned(driven())[name]
    here = hottest(plan)
    assert here.max() <= before.max()
    assert np.all((here <= before) | (here <= BEARABLE_C))
    if experiment.current_factor < 1.0:
        more = plan.scaled({"current_A": 1.0 + MARGIN})  # twice the margin in heat, and half of it is aimed at
        there = hottest(more)
        assert np.any((there > before) & (there > BEARABLE_C))


def test_a_test_that_stays_cool_keeps_its_currents():
    cool = driven(60.0)
    plans = planned(cool, before=driven())
    assert {e.current_factor for e, _ in plans.values()} == {1.0}
    for experiment, plan in candidate_tests(cool, MODEL):
        np.testing.assert_array_equal(plans[experiment.name][1].inputs["current_A"], plan.inputs["current_A"])


def test_nothing_but_currents_is_changed():
    plans = planned(driven())
    for experiment, plan in candidate_tests(driven(), MODEL):
        kept, factor = plans[experiment.name][1], plans[experiment.name][0].current_factor
        np.testing.assert_allclose(kept.inputs["current_A"], factor * plan.inputs["current_A"])
        for key in plan.inputs.keys() - {"current_A"}:
            np.testing.assert_array_equal(kept.inputs[key], plan.inputs[key])
        np.testing.assert_array_equal(kept.boundaries["ambient"], plan.boundaries["ambient"])


@pytest.mark.parametrize("name", [HELD, RECORDED, WARM])
def test_every_second_sample_permits_the_same(name):
    """Within the margin of the search: half of it in current, on either side."""
    fine, coarse = (planned(driven(every=k))[name][0].current_factor for k in (1, 2))
    assert fine < 1.0
    assert coarse == pytest.approx(fine, rel=MARGIN)


def test_names_of_parts_do_not_matter():
    def called(name):
        return f"x{MODEL.states.index(name)}" if name in MODEL.states else name

    def renamed(item):
        new = {"place": called(item.place)} if hasattr(item, "place") else {"places": tuple(map(called, item.places))}
        return replace(item, **new)

    other = replace(
        MODEL,
        states=tuple(map(called, MODEL.states)),
        links=tuple(map(renamed, MODEL.links)),
        sources=tuple(map(renamed, MODEL.sources)),
        capacity_group=tuple(map(called, MODEL.capacity_group)),
        places={called(n): replace(p, name=called(n), part=called(n)) for n, p in MODEL.places.items()},
        parameters=(),
    )
    ours, theirs = ({n: e.current_factor for n, (e, _) in planned(driven(), m).items()} for m in (MODEL, other))
    assert ours == theirs


def test_the_hotter_the_machine_was_the_more_is_permitted():
    factors = [[e.current_factor for e, _ in planned(driven(), before=driven(c)).values()] for c in (240, 300, 360)]
    assert np.all(np.diff(factors, axis=0) >= 0.0)
    assert np.all(np.diff(factors, axis=0)[:, NAMES.index(HELD)] > 0.0)


def test_what_is_permitted_is_the_current_and_not_the_factor():
    """The same test asked for with more current ends at the same one."""
    plan = dict((e.name, p) for e, p in candidate_tests(driven(), MODEL))[HELD]
    limits = heat_limits(MODEL, {}, [driven()])
    levels = [c * permissible_factor(lambda x, c=c: limits.excess(plan.scaled({"current_A": c * x}))) for c in (1, 1.3)]
    assert levels[1] == pytest.approx(levels[0], rel=MARGIN)


def test_every_model_is_asked():
    """One with weaker films, or with more heat, each against what it says of the test at hand: the least counts."""
    models = [heat_limits(MODEL, values, [driven()]) for values in ({}, {"loss.copper.poles": 1.0, "fan.flow": 2.0})]
    alone = [permissible_tests(driven(), MODEL, [m], HELD)[0][0].current_factor for m in models]
    both = permissible_tests(driven(), MODEL, models, HELD)[0][0].current_factor
    assert abs(alone[0] - alone[1]) > MARGIN * min(alone)
    assert both == pytest.approx(min(alone), rel=MARGIN)


def test_a_test_that_is_too_hot_without_current_is_not_asked_for():
    """Its friction alone makes the bearings hotter than the machine ever was."""
    assert HELD in planned(driven(), before=driven(current=40.0))
    cold = replace(driven(), inputs={**driven().inputs, "current_A": np.zeros(360), "speed_rpm": np.full(360, 50.0)})
    assert "spin without current" not in planned(driven(), before=cold)


def test_a_machine_without_currents_keeps_its_tests():
    bare = replace(MODEL, sources=tuple(s for s in MODEL.sources if s.kind != "copper"), parameters=())
    test = driven()
    test = replace(test, inputs={k: v for k, v in test.inputs.items() if k != "current_A"})
    left = [e.name for e, _ in permissible_tests(test, bare, [heat_limits(bare, {}, [test])])]
    assert left == [e.name for e, _ in candidate_tests(test, bare)]


@pytest.mark.parametrize(("rise", "feedback"), [(90.0, 0.0), (400.0, 0.0), (90.0, 0.3), (90.0, 2.0)])
def test_the_factor_is_the_closed_form(rise, feedback):
    """One body at rest: a x^2 / (1 - b x^2) with resistance that grows; it runs away where b x^2 passes 1."""
    limit, tried = 60.0, []

    def excess(x):
        tried.append(x)
        left = 1.0 - feedback * x**2
        return np.array([rise * x**2 / left - limit if left > 0.0 else np.inf])

    exact = np.sqrt(limit / (rise + feedback * limit))
    found = permissible_factor(excess)
    assert (1.0 - MARGIN) * exact <= found <= exact
    assert len(tried) <= (5 if feedback < 1.0 else 8)  # two ends and three steps; halves first, out of a runaway


def test_the_first_place_at_its_limit_counts():
    """Two places of unlike limits: where their excesses cross, the other one becomes the hotter."""
    rise, limit = np.array([100.0, 60.0]), np.array([80.0, 24.0])
    found = permissible_factor(lambda x: rise * x**2 - limit)
    assert found == pytest.approx(np.sqrt(0.4), rel=MARGIN)


def test_currents_are_told_in_ampere_and_as_share_of_their_rms():
    before = driven()
    rms = float(np.sqrt(np.mean(before.inputs["current_A"] ** 2)))
    plans = planned(before)
    for name, level_A in ((HELD, rms), ("heating at standstill, then cooling down", 1.3 * rms), (RECORDED, rms)):
        experiment, plan = plans[name]
        (level,) = current_levels(plan, before, MODEL)
        assert level.input == "current_A"
        assert level.level_A == pytest.approx(experiment.current_factor * level_A)
        assert level.share_of_rms == pytest.approx(level.level_A / rms)
    assert current_levels(plans["spin without current"][1], before, MODEL) == ()
