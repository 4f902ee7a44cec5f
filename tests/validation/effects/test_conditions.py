"""What held in one test or for a while: its gate, its response in closed form, and the posterior that finds it."""

from dataclasses import replace

import numpy as np
import pytest
from everything import machine
from one_body import C, G, P, measured, one_node
from two_bodies import LID, OPEN, bench, two_bodies

from geom.errors import InputError
from lumped.integration.simulate import Record, simulate
from lumped.model.sites import neighbours, washed
from lumped.sources.loss_laws import PowerLoss
from lumped.transfer.laws import InputPower
from measured.case import Case, Channel, Model, Test
from validation import diagnose
from validation.comparison.predict import predict
from validation.effects import Scene, effect, extended, kinds
from validation.effects.during import During
from validation.effects.registry import catalogue, with_effects
from validation.effects.streams.flow import flows
from validation.effects.time_window import Event, checked, event, holds, share
from validation.inference.columns import effect_columns
from validation.inference.conditions import tangent_worth, temporary_effects
from validation.inference.events import event_grams, instants_around, one_test, predicted_repeats, step_scores
from validation.inference.evidence import calibrated_case, candidates, scored
from validation.inference.missing_heat import scan_heat
from validation.inference.score import fit_score
from validation.inference.stretches import Path, best_stretch, hat_scores, merged_pulses, pulses
from validation.revision.revise import add

ONE = Event.of({"day": [(600.0, 900.0)]})
SEVEN = Event.of({"day one": [(600.0 * k, 600.0 * k + 90.25) for k in range(1, 8)], "night.2": [(0.0, 60.0)]})


@pytest.mark.parametrize("one", [ONE, SEVEN])
def test_the_name_of_an_event_says_all_of_it(one):
    assert event(one.name) == one


@pytest.mark.parametrize("name", ["day", "day:600s", "day.600-900s", "run 4", "a & b"])
def test_other_names_are_no_events(name):
    assert event(name) is None


def test_a_share_of_each_sample_adds_up_to_the_span():
    time = np.arange(0.0, 1000.0, 20.0)
    for span in ((100.0, 300.0), (113.0, 119.0), (0.0, 980.0)):
        own = share(time, [span])
        assert np.sum(own * np.gradient(time) * np.where((time == 0) | (time == 980), 0.5, 1.0)) == pytest.approx(
            span[1] - span[0]
        )


@pytest.mark.parametrize(
    ("spans", "says"),
    [([(300.0, 200.0)], "ends"), ([(100.0, 2000.0)], "outside"), ([(100.0, 300.0), (200.0, 400.0)], "overlaps")],
)
def test_an_event_that_cannot_be_is_one_message(spans, says):
    with pytest.raises(InputError, match=says):
        checked(Event.of({"day": spans}), "day", 0.0, 1000.0, "tests/day.events.toml")


def test_instants_of_an_uneven_record_are_short_numbers_inside_of_it():
    """A logger's clock that jitters: no instant beyond the last sample, where adding the event would be refused."""
    time = 3.0 + np.cumsum(np.random.default_rng(0).uniform(13.0, 17.0, 40))
    test = replace(measured("day"), time=time)
    for near in (time[0], 300.0, time[-1]):
        at = instants_around(test, near, 150.0)
        assert at.size >= 8
        assert time[0] <= at[0]
        assert at[-1] <= time[-1]
        inside = at[(at > time[0]) & (at < time[-1])]
        np.testing.assert_array_equal(inside, np.round(inside, 1))  # steps of 15 s
        assert checked(Event.of({"day": [(at[0], at[-1])]}), "day", time[0], time[-1], "a test") is None


def test_a_gate_is_open_in_its_own_test_and_time_alone():
    day, night = measured("day"), measured("night")
    assert np.all(holds("day", day) == 1.0)
    assert np.all(holds("day", night) == 0.0)
    assert holds("day:600-900s", day).sum() == pytest.approx(3.0)
    assert holds("day:600-900s", night).sum() == 0.0


def test_heat_for_a_while_is_the_closed_form():
    """One body at rest takes a W from 1000 s to 3000 s: a / G (e^-(t - 3000) G/C - e^-(t - 1000) G/C) afterwards."""
    bare, a = one_node(), 30.0
    test = replace(measured("day", samples=2000), time=10.0 * np.arange(2000))
    test = replace(
        test, boundaries={"ambient": np.full(2000, 20.0)}, channels=(replace(test.channels[0], y=np.zeros(2000)),)
    )
    held = effect("loss.constant@body in day:1000-3000s").extend(bare)
    rise = predict(held, test, {held.parameters[-1].name: a}).y - predict(bare, test, {}).y
    late = test.time > 3100.0
    want = a / G * (np.exp(-(test.time - 3000.0) * G / C) - np.exp(-(test.time - 1000.0) * G / C))
    assert rise[late, 0] == pytest.approx(want[late], abs=2e-3 * a / G)
    assert rise[test.time < 900.0, 0] == pytest.approx(0.0, abs=5e-3)  # two runs of other steps, wrong by mK each


@pytest.mark.parametrize("base", ["loss.constant@body", "convection.constant@body", "input.factor@speed"])
@pytest.mark.parametrize("lasting_first", [True, False])
def test_an_effect_that_lasts_and_the_same_in_one_test_act_each_by_its_own_amplitude(base, lasting_first):
    """Both were in the network under names of one: the amplitude of what lasts acted in the one test alone."""
    bare = one_node()
    bare = replace(bare, sources=(replace(bare.sources[0], law=InputPower(P, (("speed", 10.0, 1.0),))),))
    names = (base, f"{base} in day")
    both = extended(bare, map(effect, names if lasting_first else names[::-1]))
    for test in (replace(measured(n), inputs={"speed": np.full(200, 8.0)}) for n in ("day", "night")):
        np.testing.assert_array_equal(predict(both, test, {}).y, predict(bare, test, {}).y)
        for name in names:
            alone = predict(effect(name).extend(bare), test, {name: 0.1}).y
            np.testing.assert_allclose(predict(both, test, {name: 0.1}).y, alone, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize(
    "base", ["loss.constant@body", "convection.constant@body", "blockage@body", "input.factor@speed"]
)
def test_a_condition_of_a_test_is_the_effect_itself_there_and_nothing_elsewhere(base):
    """Amplitudes small enough for the copies of laws that bend."""
    bare = one_node()
    bare = replace(bare, sources=(replace(bare.sources[0], law=InputPower(P, (("speed", 10.0, 1.0),))),))
    tests = {n: replace(measured(n), inputs={"speed": np.full(200, 8.0)}) for n in ("day", "night")}
    lasting, held = effect(base).extend(bare), effect(f"{base} in day").extend(bare)
    a = -0.1 if base.startswith("blockage") else 0.1
    for name, test in tests.items():
        want = predict(
            lasting if name == "day" else bare, test, {lasting.parameters[-1].name: a} if name == "day" else {}
        )
        got = predict(held, test, {held.parameters[-1].name: a})
        assert got.y == pytest.approx(want.y, abs=1e-6)


BOTH = Event.of({n: [(measured(n).time[0], measured(n).time[-1])] for n in ("day", "dusk")})


def test_a_boundary_offset_in_several_tests_is_one_in_each_of_them():
    """As the name of an event says it, which rounds its times; with its tangent."""
    bare = one_node()
    several = effect(f"ambient.offset@ambient in {BOTH.name}").extend(bare)
    for name, one in ((n, effect(f"ambient.offset@ambient in {n}").extend(bare)) for n in ("day", "dusk", "night")):
        test, want, got = measured(name), one.parameters[-1], several.parameters[-1]
        alone, both = predict(one, test, {want.name: 2.0}, [want]), predict(several, test, {got.name: 2.0}, [got])
        acts = name != "night"
        assert both.y == pytest.approx(alone.y if acts else predict(bare, test, {}).y)
        assert pytest.approx(alone.J if acts else np.zeros_like(alone.J)) == both.J
        assert np.abs(alone.J).max() > 0.9


def test_a_boundary_offset_for_a_part_of_a_test_is_refused():
    """It would change nothing."""
    case = Case("one", Model(one_node()), (measured("day"),))
    with pytest.raises(InputError, match=r"'ambient\.offset@ambient' cannot hold for a while; a boundary in a whole"):
        add(case, "ambient.offset@ambient in day:600-900s")


def test_a_test_that_is_not_there_is_one_message():
    with pytest.raises(InputError, match="unknown test or event 'noon'"):
        effect("loss.constant@body in noon", Scene(one_node(), tests=("day", "night")))


def test_pulses_are_the_steps_of_a_curve():
    knots, rng = 60.0 * np.arange(60), np.random.default_rng(0)
    q = np.where((knots >= 600.0) & (knots < 1200.0), 7.0, 0.0) - np.where(
        (knots > 2400.0) & (knots < 2800.0), 9.0, 0.0
    )
    found = pulses(knots, q + 0.5 * rng.standard_normal(60), np.ones(60))
    assert [round(level) for _, level in found] == [7, -9]
    assert [span for span, _ in found] == [pytest.approx((570.0, 1170.0)), pytest.approx((2430.0, 2790.0))]


def test_neighbours_of_one_sign_are_one_pulse():
    assert merged_pulses([((0.0, 10.0), 1.0), ((10.0, 20.0), 3.0), ((20.0, 30.0), -1.0)]) == [
        ((0.0, 20.0), pytest.approx(2.0)),
        ((20.0, 30.0), -1.0),
    ]


def test_all_stretches_by_cumulated_sums_are_those_weighed_one_by_one():
    case = bench()
    fit = calibrated_case(case)
    e = scored(case, candidates(case, ["convection.constant"]), fit)
    found = hat_scores(e, scan_heat(fit, e.tests), fit.values)
    for path in (Path("body"), Path("body", "ambient"), Path("body", "core")):
        one = best_stretch(found, path, "noon")
        assert found.weigh(one.event, path).log_bayes == pytest.approx(one.log_bayes, rel=1e-6)
        begin, end = one.event.spans["noon"][0]
        for other in ((begin, end - 180.0), (begin + 180.0, end)):
            if other[0] < other[1]:
                assert found.weigh(Event.of({"noon": [other]}), path).log_bayes <= one.log_bayes + 1e-9


def test_a_lid_open_for_ten_minutes_is_named_with_its_times():
    found = diagnose(bench(), plan=False)
    best = found.odds[0]
    assert found.verdict == "named"
    assert best.effects[0].startswith("convection.constant@body in noon:")
    assert best.tests == ("noon",)
    assert (best.begin_s, best.end_s) == pytest.approx(LID, abs=40.0)
    assert found.events[0].value == pytest.approx(OPEN, rel=0.2)


@pytest.mark.heavy
def test_a_lid_open_three_times_is_one_event():
    spans = ((1000.0, 1400.0), (2400.0, 2800.0), (4000.0, 4400.0))
    best = diagnose(bench((("noon", spans),), 5.0), plan=False).odds[0]
    (name,) = [e for e in best.effects if "noon" in e]
    told = event(name.split(" in ")[1])
    assert name.startswith("convection.constant@body")
    assert np.array(told.spans["noon"]) == pytest.approx(np.array(spans), abs=40.0)


def test_a_repeat_that_the_others_do_not_predict_is_left_out():
    spans = [(1000.0, 1400.0), (2400.0, 2800.0), (4000.0, 4400.0)]
    case = bench((("noon", tuple(spans)),), 5.0)
    fit = calibrated_case(case)
    e = scored(case, candidates(case, ["convection.constant"]), fit)
    lid = effect("convection.constant@body")
    more = Event.of({"noon": [*spans, (5200.0, 5600.0)], "dusk": [(1000.0, 1400.0)]})
    assert predicted_repeats(e, lid, more, fit.values) == Event.of({"noon": spans})
    assert predicted_repeats(e, lid, Event.of({"noon": spans[:1]}), fit.values) == Event.of({"noon": spans[:1]})


def test_losses_of_a_part_that_are_higher_in_one_test_are_named_as_such():
    """Two declared losses at the core, both 1.4 times in noon: neither of them alone, and no weaker cooling."""
    case, tests = bench(()), []

    def both(factor):
        net = two_bodies()
        (heat,) = net.sources
        laws = [PowerLoss(((factor * 80.0, (("load", 1.0, p),)),)) for p in (1.0, 3.0)]
        return replace(net, sources=(replace(heat, law=laws[0]), replace(heat, name="loss:more", law=laws[1])))

    for test in case.tests:
        truth = both(1.4 if test.name == "noon" else 1.0)
        record, rows = Record(test.time, test.signals, test.boundaries, 20.0), [c.row for c in test.channels]
        y = simulate(truth, record, {}, rows).y
        y = y + 0.05 * np.random.default_rng(len(tests)).standard_normal(y.shape)
        channels = tuple(replace(c, y=y[:, i]) for i, c in enumerate(test.channels))
        tests.append(replace(test, channels=channels))
    found = diagnose(replace(case, model=Model(both(1.0)), tests=tuple(tests)), plan=False)
    assert found.odds[0].effects == ("loss.factor.all@core in noon",)
    assert found.odds[0].probability > 0.5  # a meter of the load that was off there is the other way to say it


def test_an_answer_counts_as_its_odds_of_being_right():
    from measured.doubt import USUAL
    from validation.diagnosis import infer
    from validation.inference.hypotheses import probabilities
    from validation.inference.question import information, with_answers

    post = infer(bench((("noon", ((0.0, 5980.0),)),), 0.6), ["convection.constant"])
    e, own = post.evidence, [bool(h.members) and "noon" in post.evidence.name(h) for h in post.hypotheses]
    P = probabilities(post.hypotheses)
    yes, right = P[own].sum(), 1.0 - USUAL["answer"]
    Q = probabilities(with_answers(e, post.hypotheses, {"noon": True}))
    assert Q[own].sum() == pytest.approx(right * yes / (right * yes + (1.0 - right) * (1.0 - yes)))
    assert information(0.5) > information(0.9) > information(1.0) == pytest.approx(0.0)


def test_tests_contradict_each_other_where_one_is_different():
    from validation.inference.contradiction import contradiction

    for held, words in (((("noon", ((0.0, 5980.0),)),), "noon contradicts"), ((), "agree")):
        case = bench(held, 2.0)
        assert words in contradiction(calibrated_case(case), case.tests).words


def test_masses_and_joints_cannot_differ_between_tests():
    from validation.inference.contradiction import can_differ

    net = two_bodies()
    able = {p.name: can_differ(net, p) for p in net.parameters}
    assert able == {
        "capacity.body": False,
        "capacity.core": False,
        "link.joint": False,
        "link.film": True,
        "loss.heat": True,
    }


@pytest.mark.heavy
def test_a_declared_loss_too_high_above_a_load_is_said_in_words():
    """In truth a third of the heat is missing above a load of 0.7, in three tests that go from low to high."""
    net, cases = two_bodies(), []
    law = "law@loss:heat|load>0.7"
    truth = effect(law).extend(net)
    rng = np.random.default_rng(3)
    for name in ("noon", "dawn", "dusk"):
        time = np.arange(0.0, 9000.0, 30.0)
        load = rng.permutation(np.linspace(0.1, 1.0, 9))[(time / 1000.0).astype(int)]
        around = {"ambient": np.full_like(time, 20.0)}
        test = Test(name, "calibrate", time, {"load": load}, around, (), 20.0)
        rows = [net.places[p].mean for p in ("body", "core")]
        y = simulate(truth, Record(time, test.signals, around, 20.0), {law: -0.33}, rows).y
        y = y + 0.05 * rng.standard_normal(y.shape)
        channels = tuple(Channel(p, p, r, y[:, i], 0.3) for i, (p, r) in enumerate(zip(("body", "core"), rows)))
        cases.append(replace(test, channels=channels))
    found = diagnose(Case("bench", Model(net), tuple(cases)), plan=False)
    assert found.odds[0].effects[0].startswith("law@loss:heat|load>0.")
    assert "the declared loss heat is" in found.words
    assert "% too high where load is above" in found.words


def test_an_instant_that_may_be_a_begin_and_an_end_has_the_score_of_a_step_there():
    """Instants around both ends of a short stretch overlap; the sums of tests that it does not move are kept."""
    case = bench((("noon", ((600.0, 1200.0),)),), 1.0)
    fit, film = calibrated_case(case), effect("convection.constant@body")
    rest = Event.of({"noon": [(3000.0, 3600.0)], "dusk": [(1000.0, 1900.0)]})
    elsewhere = event_grams(fit, case.tests, film, rest, fit.values)
    elsewhere.pop("noon")
    parts = one_test(fit, "noon"), film, case.tests[0]
    once, twice = (
        step_scores(*parts, np.array(at), fit.values, rest.spans["noon"], list(elsewhere.values()))
        for at in ([600.0, 900.0, 1200.0], [600.0, 900.0, 900.0, 1200.0])
    )
    order = [0, 1, 1, 2, 3]
    assert abs(once[0][1]) > 1.0
    np.testing.assert_allclose(twice[0], once[0][order])
    np.testing.assert_allclose(twice[1], once[1][np.ix_(order, order)])
    steps = [Event.of({"noon": [(t, 6000.0)]}) for t in (600.0, 900.0, 1200.0)]
    effects = [During.of(film, e.name) for e in (*steps, rest)]
    whole = fit_score(fit, effect_columns(fit, case.tests, effects, fit.values))
    np.testing.assert_allclose(once[0], whole.u, rtol=1e-6)
    np.testing.assert_allclose(once[1], whole.V, rtol=1e-6)


def test_what_strays_little_for_a_while_is_weighed_by_its_evidence():
    """Three times a lid is open so little that no reading moves by three times what a model may be wrong by."""
    spans = [(1000.0, 1800.0), (2600.0, 3400.0), (4200.0, 5000.0)]
    case = bench((("noon", tuple(spans)),), 0.4)
    fit, film = calibrated_case(case), effect("convection.constant@body")
    evidence, name = scored(case, [film], fit), Event.of({"noon": spans}).name
    (row,) = tangent_worth(evidence, [film], name, 0.05, fit.values)
    parts = effect_columns(fit, case.tests, [row.effect], fit.values)
    size = fit_score(fit, parts).amplitude[0]
    assert max(np.max(np.abs(size * s.J[:, -1])) / s.weight for s in parts) < 3.0
    assert row.worth > 0.0


def test_an_effect_on_trial_joins_nothing():
    """Where others can be does not depend on what else is asked about."""
    net = machine()
    larger = extended(net, catalogue(Scene(net)))
    assert neighbours(larger) == neighbours(net)
    assert [washed(larger, b) for b in net.boundaries] == [washed(net, b) for b in net.boundaries]


def test_two_stretches_of_one_effect_both_act():
    net = machine()
    for base in temporary_effects(Scene(net)):
        both = [During.of(base, Event.of({"day": [span]}).name) for span in ((60.0, 90.0), (120.0, 150.0))]
        targets = [len(p.targets) for p in extended(net, both).parameters[-2:]]
        assert targets == [len(extended(net, [e]).parameters[-1].targets) for e in both]


def test_every_stretch_of_a_flow_copies_its_films_and_streams_once():
    """Not the copies of the others as well: with a dozen of them there would be four thousand."""
    net = machine()
    base = effect(f"flow@{kinds()['flow'].places(Scene(net))[0]}")
    events = [Event.of({"day": [(60.0 * k, 60.0 * k + 30.0)]}) for k in range(12)]
    sizes = [len(extended(net, [During.of(base, e.name) for e in events[:n]]).links) for n in (0, 1, 12)]
    assert sizes[1] > sizes[0]
    assert sizes[2] - sizes[0] == 12 * (sizes[1] - sizes[0])


@pytest.mark.parametrize("order", [("convection.constant", "blockage"), ("convection.constant", "blockage", "fouling")])
def test_what_blocks_a_face_blocks_the_film_that_an_effect_brought(order):
    """Half of a film of G and half of an added one of G: the rise is that of one film of G, as before them."""
    bare = one_node()
    film, block, *_ = inside = [effect(f"{kind}@body") for kind in order]
    adopted = with_effects(bare, inside, ())
    on_trial = with_effects(bare, [], inside)
    amplitudes = {film.name: G, block.name: -0.5}
    right = predict(bare, measured("day"), {}).y
    assert predict(adopted, measured("day"), amplitudes).y == pytest.approx(right, abs=1e-6)
    assert predict(on_trial, measured("day"), amplitudes).y[-1, 0] < right[-1, 0] - 1.0, "on trial each stands alone"


def test_a_record_of_three_rows_is_diagnosed():
    """There is one instant at which a sensor may have come loose."""

    def few(test):
        at = np.linspace(0, test.time.size - 1, 3).astype(int)
        air = {n: np.broadcast_to(np.asarray(u, float), test.time.shape)[at] for n, u in test.boundaries.items()}
        read = tuple(replace(c, y=c.y[at]) for c in test.channels)
        return replace(
            test, time=test.time[at], inputs={n: u[at] for n, u in test.inputs.items()}, boundaries=air, channels=read
        )

    case = bench(())
    assert diagnose(replace(case, tests=tuple(map(few, case.tests))), plan=False).verdict == "adequate"


def test_when_a_sensor_came_loose_is_told_to_the_sample():
    """A fit looks at blocks of readings; within one of them the others fit the slip better than its first sample."""
    sound, slip, step = bench(()), 3310.0, 2.0

    def logged(test):
        time = np.arange(0.0, 6000.0, step)
        room = np.interp(time, test.time, test.boundaries["ambient"])
        read = [np.interp(time, test.time, c.y) for c in test.channels]
        if test.name == "dusk":
            read[0] = np.where(time >= slip, room + 0.5 * (read[0] - room), read[0])
        channels = tuple(replace(c, y=y) for c, y in zip(test.channels, read, strict=True))
        load = test.inputs["load"][np.searchsorted(test.time, time, "right") - 1]
        return replace(test, time=time, inputs={"load": load}, boundaries={"ambient": room}, channels=channels)

    case = replace(sound, tests=tuple(map(logged, sound.tests)))
    ((lead, *_),) = diagnose(case, plan=False).groups
    begin, _ = event(effect(lead).condition).spans["dusk"][0]
    assert effect(lead).base.name == "sensor.loose@body"
    assert begin == pytest.approx(slip, abs=step)


def test_a_test_may_have_a_colon_in_its_name():
    net = machine()
    flow = flows(net)[0].name
    named, plain = (extended(net, [effect(f"fan.stop@{flow}:{t}:50")]) for t in ("asked: half the flow", "road"))
    assert len(named.links) == len(plain.links) > len(net.links)
