"""When exactly: ends of what holds for a while, in long records and whatever the order of the tests."""

from dataclasses import replace

import numpy as np
import pytest
from two_bodies import bench, two_bodies

from lumped.integration.simulate import Record, simulate
from measured.case import Case, Channel, Model, Test
from validation.effects import effect
from validation.effects.time_window import Event
from validation.inference.decide import is_same_event
from validation.inference.events import further_repeats, refit_ends, timed_event
from validation.inference.evidence import calibrated_case, pair_evidence, scored, single_evidence
from validation.inference.hypotheses import Weighed, is_rare, repeats_price
from validation.inference.refit import laplace

DAY, STEP_S = 10800.0, 10.0


def day_case(spans, size, length=DAY):
    """A day of a sample every ten seconds in which two bodies cool more while a lid is open."""
    rng, net = np.random.default_rng(1), two_bodies()
    lid = effect(f"convection.constant@body in {Event.of({'day': spans}).name}")
    truth, time = lid.extend(net), np.arange(0.0, length, STEP_S)
    load = rng.uniform(0.3, 1.0, 10)[(time / (length / 10.0)).astype(int)]
    test = Test("day", "calibrate", time, {"load": load}, {"ambient": np.full_like(time, 20.0)}, (), 20.0)
    rows = [net.places[p].mean for p in ("body", "core")]
    y = simulate(truth, Record(time, test.signals, test.boundaries, 20.0), {lid.name: size}, rows).y
    y = y + 0.05 * rng.standard_normal(y.shape)
    channels = tuple(Channel(p, p, r, y[:, i], 0.3) for i, (p, r) in enumerate(zip(("body", "core"), rows)))
    return Case("day", Model(net), (replace(test, channels=channels),))


@pytest.mark.parametrize(
    "size", [5.0, 40.0]
)  # W/K; by the larger one the body is halfway to the room's temperature at the end
def test_ends_in_a_day_are_found_to_the_sample(size):
    """Begun some minutes off, which is where windows of a long record put them; blocks of the fit are one minute."""
    case = day_case([(5000.0, 5090.0)], size)
    wrong = effect("convection.constant@body in day:4700-5400s")
    evidence, where = scored(case, [wrong], calibrated_case(case)), wrong.event
    for _ in range(3):
        fit = laplace(evidence, Weighed((0,))).fit
        where = refit_ends(evidence, fit, evidence.effects[0], where, {"day": 400.0})
        moved = effect(f"convection.constant@body in {where.name}")
        evidence = scored(case, [moved], evidence.fit)
    assert np.array(where.spans["day"]) == pytest.approx(np.array([(5000.0, 5090.0)]), abs=2.0 * STEP_S)


@pytest.mark.parametrize("wrong", ["4960-5050", "5050-5140", "4960-5140"])
def test_ends_some_samples_off_are_found_by_tangents_alone(wrong):
    """The size and the bodies' capacities bend to wrong ends, and move with them."""
    case = day_case([(5000.0, 5090.0)], 17.0)
    off = effect(f"convection.constant@body in day:{wrong}s")
    evidence = scored(case, [off], calibrated_case(case))
    where = refit_ends(evidence, laplace(evidence, Weighed((0,))).fit, off, off.event, {})
    assert np.array(where.spans["day"]) == pytest.approx(np.array([(5000.0, 5090.0)]), abs=STEP_S)


def test_a_repeat_half_as_long_is_found_in_a_long_day():
    """Two openings of two minutes are known; one of a minute lies between knots a quarter of an hour apart."""
    spans = [(6000.0, 6130.0), (14000.0, 14130.0), (37050.0, 37120.0)]
    case = day_case(spans, 6.0, 8.0 * DAY)
    two = effect(f"convection.constant@body in {Event.of({'day': spans[:2]}).name}")
    evidence = scored(case, [two], calibrated_case(case))
    more = further_repeats(evidence, laplace(evidence, Weighed((0,))).fit, two, two.event)
    assert np.array(more.spans["day"]) == pytest.approx(np.array(spans), abs=4.0 * STEP_S)


def test_names_and_ends_of_events_do_not_follow_the_order_of_the_tests():
    """A lid that is open in two tests, the ends of each span found beside the others."""
    case = bench((("noon", ((1000.0, 1500.0),)), ("dusk", ((3000.0, 3400.0), (4000.0, 4500.0)))), 5.0)
    film, held, events = effect("convection.constant@body"), {"noon": [(950.0, 1550.0)], "dusk": [(2900.0, 3500.0)]}, []
    for tests in (case.tests, case.tests[::-1]):
        fit = calibrated_case(replace(case, tests=tests))
        evidence = scored(replace(case, tests=tests), [film], fit)
        where = Event.of({t.name: held[t.name] for t in tests if t.name in held})
        events.append(timed_event(evidence, film, where, dict.fromkeys(held, 100.0), fit.values))
    assert events[0].event.name == events[1].event.name
    assert events[0].log_share == pytest.approx(events[1].log_share, abs=1e-3)


def test_an_event_is_rare_where_it_is_short_and_at_no_level_of_an_input():
    time = np.arange(0.0, 8000.0, 10.0)
    load = (time % 1000.0 >= 500.0).astype(float)
    test = Test("day", "calibrate", time, {"load": load}, {"ambient": np.full_like(time, 20.0)}, (), 20.0)

    def repeats(first, length, every=1000.0):
        return Event.of({"day": [(first + every * k, first + every * k + length) for k in range(8)]})

    assert is_rare([test], repeats(250.0, 40.0, 950.0)), "at the load now, and without it then"
    assert not is_rare([test], repeats(600.0, 40.0)), "whenever the load is on"
    assert not is_rare([test], repeats(100.0, 40.0)), "whenever it is off"
    assert not is_rare([test], repeats(250.0, 300.0, 950.0)), "a third of the day"
    assert not is_rare([test], Event.of({"day": [(300.0, 320.0), (5000.0, 5200.0)]})), "ten times as long"


def test_when_repeats_were_is_a_part_of_the_evidence():
    """Two more stretches of 80 s in 5980 s: anywhere to half a minute, and half to half as long again."""
    spans = [(1000.0, 1080.0), (2400.0, 2480.0), (4000.0, 4080.0)]
    case = bench((("noon", tuple(spans)),), 5.0)
    lids = [effect(f"convection.constant@body in {Event.of({'noon': x}).name}") for x in (spans, spans[:1])]
    e = scored(case, lids, calibrated_case(case))
    price = 2.0 * np.log((5980.0 / 30.0 + 1.0) * 0.5 * 80.0 / 30.0)
    assert repeats_price(case.tests, lids[0].event) == pytest.approx(price)
    free, both = replace(e), (np.array([0]), np.array([1]))
    free.__dict__["repeats"] = np.zeros(2)
    assert single_evidence(free) - single_evidence(e) == pytest.approx([price, 0.0])
    assert pair_evidence(free, *both) - pair_evidence(e, *both) == pytest.approx(price)
    assert laplace(free, Weighed((0,))).log_bayes - laplace(e, Weighed((0,))).log_bayes == pytest.approx(price)


@pytest.mark.parametrize("size", [5.0, 40.0])
def test_what_repeats_beside_a_known_event_is_found_to_the_sample(size):
    spans = [(1000.0, 1100.0), (2400.0, 2480.0), (4000.0, 4100.0)]
    case = bench((("noon", tuple(spans)),), size)
    two = effect(f"convection.constant@body in {Event.of({'noon': spans[:2]}).name}")
    e = scored(case, [two], calibrated_case(case))
    more = further_repeats(e, laplace(e, Weighed((0,))).fit, two, two.event)
    assert np.array(more.spans["noon"]) == pytest.approx(np.array(spans), abs=40.0)
    assert more.tests == ("noon",)


def test_an_event_that_is_seen_less_often_is_the_same_and_another_is_not():
    two, one, other, long = (
        effect(f"convection.constant@body in noon:{x}s")
        for x in ("1000-1200,3000-3200", "3020-3200", "3150-3400", "900-3300")
    )
    assert is_same_event(two, one)
    assert is_same_event(one, two)
    assert not is_same_event(two, other)
    assert not is_same_event(two, long)
