"""A verdict that its own numbers contradict is withheld, and the sentence names what would have to differ."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from two_bodies import bench

from validation import diagnose
from validation.calibration.model_error import machine_rise
from validation.comparison.linearisation import Segment, allowed
from validation.consistency import doubts_check, free_network_check, persistence_check, record_errors, refit_check
from validation.diagnosis import infer
from validation.effects.time_window import Event
from validation.inference.decide import Decision, consistent_decision
from validation.inference.result import Check, Remainder
from validation.inference.say import OFF, remainder
from validation.revision.revise import add
from validation.scope import Scope

SLIPS = ("sensor.loose", "sensor.slip")


def moved_probe(share):
    """Nothing is missing, but in one test the core's probe sat between core and air.  share : of the way to the air"""
    case = bench(())

    def elsewhere(test):
        if test.name != "dusk":
            return test
        probe = next(c for c in test.channels if c.name == "core")
        moved = replace(probe, y=probe.y + share * (20.0 - probe.y))
        return replace(test, channels=tuple(moved if c is probe else c for c in test.channels))

    return replace(case, tests=tuple(map(elsewhere, case.tests)))


@pytest.mark.parametrize(("share", "accepted"), [(0.5, True), (0.0, False)])
def test_a_probe_that_sat_elsewhere_in_one_test_is_set_aside_if_it_did(share, accepted):
    done = add(moved_probe(share), "sensor.loose@core in dusk")
    assert done.accepted is accepted, done.why


def test_what_a_probe_read_elsewhere_costs_its_fault_nothing():
    """Of the readings that the fault explains none is predicted: the others are as well as before."""
    (left_out,) = [c for c in add(moved_probe(0.5), "sensor.loose@core in dusk").checks if c.check == "left out"]
    assert not left_out.partial
    assert left_out.limit < 0.0


@pytest.fixture(scope="module")
def found():
    return diagnose(moved_probe(0.5), plan=False, scope=Scope(without=SLIPS))


@pytest.fixture(scope="module")
def posterior():
    return infer(moved_probe(0.5), scope=Scope(without=SLIPS))


def test_a_probe_that_was_loose_for_a_while_is_judged_by_what_it_read_before_and_after():
    span = Event.of({"dusk": [(1000.0, 3000.0)]})
    done = add(moved_probe(0.5), f"sensor.loose@core in {span.name}")
    assert {c.check for c in done.checks} >= {"left out", "no change"}


@pytest.mark.parametrize("share", [1.0, 0.2])
def test_a_record_is_off_by_no_more_than_parameters_that_follow_the_readings_leave(posterior, share, monkeypatch):
    """The most probable fit lets doubts forgive what parameters could mend; what is told is the lesser error."""
    case = moved_probe(0.5)
    fit = posterior.evidence.fit
    less = replace(fit, parts=tuple(replace(s, r=share * s.r) for s in fit.parts))
    monkeypatch.setattr("validation.inference.say.followed", lambda *_: less)
    told = {
        (r.channel, r.record): r for r in remainder(case, posterior, Decision("adequate", (), 0.3), posterior.single)
    }
    for s in less.parts:
        error = float(np.sqrt(np.mean(s.r**2)))
        row = told.get((s.channel, s.test))
        assert row is None or row.error_K == pytest.approx(error)
        assert row is not None or error <= OFF * s.weight or s.channel in {channel for channel, _ in told}
    assert ("core", "dusk") in told or share < 1.0


def test_a_probe_between_part_and_air_has_a_name():
    found = diagnose(moved_probe(0.5), plan=False)
    assert found.verdict == "data"
    assert found.groups[0] == ("sensor.loose@core in dusk",)
    (row,) = [c for c in found.candidates if c.effect == found.groups[0][0]]
    assert row.value == pytest.approx(0.5, abs=0.1)


def test_a_record_far_beyond_its_uncertainty_is_not_adequate(found):
    """Half of a rise of 14 K at a sensor of 0.3 K, which no effect explains."""
    assert found.verdict == "outside"
    assert found.words.startswith("as asked, without sensor.loose, sensor.slip; core in dusk reads ")
    assert "times its uncertainty: nothing in the catalogue explains it" in found.words
    assert "in that test the sensor or its place differed" in found.words
    assert found.named == ()


def test_the_document_lists_what_was_checked(found):
    rows = {row["kind"]: row for row in found.document()["checks"]}
    assert set(rows) == {"record", "tests", "persistence", "free network"}
    assert rows["record"]["where"] == "core in dusk"
    core = next(c for t in moved_probe(0.5).tests if t.name == "dusk" for c in t.channels if c.name == "core")
    assert rows["record"]["limit"] == pytest.approx(5 * np.hypot(0.3, allowed(core)))
    assert rows["tests"]["limit"] == 10.0
    assert [rows[kind]["contradicts"] for kind in rows] == [True, True, False, False]
    assert all(row["contradicts"] == (row["number"] > row["limit"]) for row in rows.values())


def test_a_sound_bench_stays_adequate():
    found = diagnose(bench(()), plan=False)
    assert found.verdict == "adequate"
    assert {c.kind for c in found.checks} >= {"record", "persistence"}
    assert not any(c.contradicts for c in found.checks)
    assert all(h.probability < 0.2 for h in found.events)


def test_a_model_that_a_guess_of_no_change_beats_is_told():
    """Bodies that stay as they began, and a model that heats them by 40 K."""
    case = bench(())
    still = [replace(t, channels=tuple(replace(c, y=np.full_like(c.y, 20.0)) for c in t.channels)) for t in case.tests]
    case = replace(case, tests=tuple(still))
    check = persistence_check(case, record_errors(case, case.tests, {}, {}))
    assert check.contradicts
    assert check.limit == pytest.approx(0.0, abs=1e-9)
    assert "a guess of no change predicts" in check.words


def fit(**errors):
    """What a fit leaves in each test (K), at one sensor of 0.5 K."""
    t = np.arange(10.0)
    return SimpleNamespace(
        parts=[Segment(n, "core", t, np.full_like(t, K), np.zeros((10, 0)), 0.5) for n, K in errors.items()]
    )


@pytest.mark.parametrize(
    ("after", "contradicts"),
    [
        ({"a": 1.2, "b": 1.3, "c": 0.1}, True),
        ({"a": 1.2, "b": 0.5, "c": 0.1}, False),
        ({"a": 1.01, "b": 1.01, "c": 0.1}, False),
    ],
)
def test_a_name_whose_refit_is_worse_in_most_tests_is_withheld(after, contradicts):
    """Worse is what a reading of 0.5 K could show: 0.01 K is not."""
    check = refit_check(fit(a=1.0, b=1.0, c=3.0), fit(**after), "convection@core")
    assert check.contradicts == contradicts
    named = Decision("named", ((0,),), 0.99)
    decision = consistent_decision(named, (check,))
    assert (decision.verdict, decision.groups) == (("outside", ()) if contradicts else ("named", ((0,),)))
    assert decision.checks == (check,)


def test_what_is_within_its_limit_changes_nothing():
    choice = Decision("adequate", (), 0.3)
    assert consistent_decision(choice, (Check("record", "core in dusk", 1.5, 1.5, "K", ""),)).verdict == "adequate"


def left_off(taken, error=4.0):
    """A record that is off by `error` K, of which the doubts of the model take some."""
    return Remainder("core", "dusk", error, taken, "joint:core|frame", "", 0.0, 0.0, "")


def test_no_record_is_forgiven_more_than_all_doubts_of_a_sound_machine_come_to():
    """Doubts that together take a twentieth of the machine's largest rise off one record are not doubts."""
    case = bench(())
    limit = case.doubt["total"] * machine_rise(case.usable)
    assert doubts_check(case, [left_off(3.0), left_off(1.01 * limit, 1.1 * limit)]).contradicts
    assert not doubts_check(case, [left_off(0.9 * limit, limit)]).contradicts
    assert "joint:core|frame" in doubts_check(case, [left_off(3.0)]).words
    assert doubts_check(case, [left_off(0.4 * limit, limit)]) is None  # most of it is not forgiven


def test_a_free_network_that_predicts_what_the_model_does_not_even_fit_is_told():
    """Readings of a machine whose core is warmed three times as much as the model says."""
    case = bench(())
    sound = infer(case).evidence.fit
    rows = record_errors(case, case.tests, {}, {})
    assert free_network_check(case, rows, sound) is None
    off = replace(sound, parts=tuple(replace(s, r=s.r + 20.0 * s.weight) for s in sound.parts))
    assert free_network_check(case, rows, off) is None  # as it reads it is right
    far = [replace(r, error=replace(r.error, rmse_K=20.0 * r.u_K)) for r in rows]
    check = free_network_check(case, far, off)
    assert check.contradicts
    assert check.where.partition(" in ")[0] in ("core", "frame")
    assert "a free network predicts tests left out within" in check.words
