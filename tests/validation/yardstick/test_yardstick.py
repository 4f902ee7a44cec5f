"""The plain models beside ours: what they find where the answer is known, and what may not move them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import lsq_linear
from two_bodies import bench

from measured.case import Test
from validation.comparison.compare import errors
from validation.yardstick.free_network import nonnegative
from validation.yardstick.yardstick import yardstick

TRUTH = {"joint": 4.0, "film": 2.0, "heat": 80.0}  # W/K, W/K, W: as `two_bodies` declares them


@pytest.fixture(scope="module")
def sound():
    """Two bodies on a bench on which nothing happens; the last test is held out."""
    case = bench(held=())
    return replace(case, tests=(*case.tests[:2], replace(case.tests[2], role="hold-out")))


@pytest.fixture(scope="module")
def measure(sound):
    return yardstick(sound)


def numbers(measure):
    return {f"{name} {kind}": e for name, of in measure.tests.items() for kind, e in of.items()}


def test_a_free_network_finds_the_links_and_losses_of_a_linear_machine(measure):
    found = {(t.place, t.kind, t.other): t.value for t in measure.terms}
    assert found["core", "link", "body"] == pytest.approx(TRUTH["joint"], rel=0.05)
    assert found["body", "link", "ambient"] == pytest.approx(TRUTH["film"], rel=0.05)
    assert sum(t.value for t in measure.terms if t.kind == "loss" and t.place == "core") == pytest.approx(80.0, rel=0.1)


def test_no_other_link_is_needed(measure):
    assert {(t.place, t.other) for t in measure.terms if t.kind == "link"} == {
        ("core", "body"),
        ("body", "core"),
        ("body", "ambient"),
    }


def test_a_free_network_predicts_a_linear_machine_to_the_noise_of_its_sensors(measure):
    noise = 0.05  # K, that `bench` adds; the first reading starts the run, so it counts twice
    assert measure.hold_out["free_network"] < 2.0 * noise


def test_readings_that_mean_nothing_teach_no_plain_model(sound):
    """A sensor that froze in the first test: with its readings, and with what is left once they are gone."""
    core, body = 1, 0
    noon, *others = sound.tests
    y = noon.channels[core].y.copy()
    y[20:] = y[20]
    stuck, gone = (
        replace(noon, channels=(noon.channels[body], replace(noon.channels[core], y=values)))
        for values in (y, np.where(np.arange(y.size) < 20, y, np.nan))
    )
    both = [yardstick(replace(sound, tests=(test, *others))) for test in (stuck, gone)]
    assert both[0].left_out == both[1].left_out


def test_persistence_is_what_the_readings_stray_from_their_first(sound, measure):
    test = sound.tests[2]
    y = np.column_stack([c.y for c in test.channels])
    stays = np.sqrt(np.mean((y - y[0]) ** 2))
    assert measure.hold_out["persistence"] <= stays * 1.5
    assert measure.tests[test.name]["persistence"] == measure.hold_out["persistence"]


def test_what_is_added_to_a_model_asks_for_no_other_yardstick(sound, measure):
    assert yardstick(replace(sound, model=replace(sound.model, values={"link.joint": 2.0}))) is measure
    assert yardstick(replace(sound, tests=sound.tests[:2])) is not measure


def test_what_is_held_out_teaches_nothing(sound, measure):
    wild = sound.tests[2]
    wild = replace(wild, channels=tuple(replace(c, y=c.y[::-1] + 50.0) for c in wild.channels))
    other = yardstick(replace(sound, tests=(*sound.tests[:2], wild)))
    assert other.left_out == measure.left_out
    assert other.terms == measure.terms
    assert other.hold_out["free_network"] > measure.hold_out["free_network"]


def test_the_order_of_tests_and_sensors_changes_nothing(sound, measure):
    turned = tuple(replace(t, channels=t.channels[::-1]) for t in sound.tests[::-1])
    assert numbers(yardstick(replace(sound, tests=turned))) == pytest.approx(numbers(measure), rel=1e-3)


def thinned(test: Test) -> Test:
    return replace(
        test,
        time=test.time[::2],
        inputs={n: u[::2] for n, u in test.inputs.items()},
        boundaries={n: u[::2] for n, u in test.boundaries.items()},
        channels=tuple(replace(c, y=c.y[::2]) for c in test.channels),
    )


def test_half_the_rows_say_the_same(sound, measure):
    half = yardstick(replace(sound, tests=tuple(thinned(t) for t in sound.tests)))
    assert half.hold_out["persistence"] == pytest.approx(measure.hold_out["persistence"], rel=0.02)
    assert half.hold_out["free_network"] == pytest.approx(measure.hold_out["free_network"], abs=0.1)


def test_a_test_counts_by_its_time_not_by_its_rows(sound):
    """One of two tests in a quarter of the instants: what both leave together is the same."""
    mild, wild = sound.tests[0], sound.tests[1]
    far = tuple(replace(c, y=c.y + 30.0 * (mild.time > mild.time[0])) for c in wild.channels)
    both = replace(sound, tests=(mild, replace(wild, channels=far)))
    fewer = replace(sound, tests=(thinned(thinned(mild)), both.tests[1]))
    assert yardstick(fewer).left_out["persistence"] == pytest.approx(yardstick(both).left_out["persistence"], rel=0.02)
    assert errors(fewer).rmse_K == pytest.approx(errors(both).rmse_K, rel=0.02)


def test_the_only_test_is_judged_by_its_thirds(sound):
    alone = yardstick(replace(sound, tests=sound.tests[:1]))
    assert set(alone.tests) == {sound.tests[0].name}
    assert not alone.hold_out
    assert alone.left_out["free_network"] < alone.left_out["persistence"]


def test_gaps_in_a_sensor_are_not_errors(sound, measure):
    test = sound.tests[2]
    y = test.channels[0].y.copy()
    y[40:60] = np.nan
    gapped = replace(test, channels=(replace(test.channels[0], y=y), *test.channels[1:]))
    other = yardstick(replace(sound, tests=(*sound.tests[:2], gapped)))
    assert other.hold_out["free_network"] == pytest.approx(measure.hold_out["free_network"], rel=0.1)


def test_held_out_tests_of_other_sensors_say_nothing(sound, measure):
    other = tuple(replace(c, name=f"other {c.name}") for c in sound.tests[2].channels)
    apart = yardstick(replace(sound, tests=(*sound.tests[:2], replace(sound.tests[2], channels=other))))
    assert not apart.hold_out
    assert apart.errors["persistence"] > 0.0


def test_where_nothing_may_be_fitted_there_is_no_yardstick(sound):
    unseen = tuple(replace(t, role="hold-out") for t in sound.tests)
    assert yardstick(replace(sound, tests=unseen)) is None


@pytest.mark.parametrize(("rows", "terms"), [(1, 12), (3, 12), (30, 12), (200, 60), (40, 1), (5, 0)])
def test_what_is_not_negative_is_as_close_as_scipy_finds(rows, terms):
    """With noise, with columns of many sizes, and with a column twice."""
    rng = np.random.default_rng(rows)
    A = rng.standard_normal((rows, terms)) * 10.0 ** rng.uniform(-6, 6, terms)
    if terms > 2:
        A[:, 1] = A[:, 0]
    b = A @ np.maximum(rng.standard_normal(terms), 0.0) + rng.standard_normal(rows)
    found = nonnegative(A.T @ A, A.T @ b)
    assert found.min(initial=0.0) >= 0.0
    if terms:
        scale = np.linalg.norm(A, axis=0)
        least = np.linalg.norm(lsq_linear(A / scale, b, (0.0, np.inf), method="bvls", tol=1e-14).fun)
        assert np.linalg.norm(A @ found - b) == pytest.approx(least, rel=1e-6, abs=1e-6 * np.linalg.norm(b))
