"""The proper scores: what an answer's odds are worth, by hand."""

from math import log
from types import SimpleNamespace

import pytest
from hidden import odds
from hidden.folders import label_of
from hidden.page import diagram

ONE = {"group": "one", "truth": ["draught@b"], "right": [["a@b"]], "twins": [["c@b"]], "size": 4.0, "machine": "x"}
NOTHING = {"group": "nothing", "truth": [], "right": [], "twins": [], "size": 0.0, "machine": "x"}


def answer(*rows, **more):
    told = [{"hypothesis": h, "effects": [] if h == "nothing" else h.split(" + "), "probability": p} for h, p in rows]
    return {"odds": told, "verdict": "named", "groups": [], "candidates": {}, **more}


SPLIT = answer(("a@b", 0.5), ("c@b", 0.3), ("d@e", 0.15), ("nothing", 0.05))


def test_truth_and_its_twins_count_as_one():
    assert odds.of_truth(ONE, SPLIT) == pytest.approx(0.8)
    assert odds.nats(ONE, SPLIT) == pytest.approx(log(0.8))
    assert odds.nats(ONE, answer(("d@e", 1.0))) == pytest.approx(log(1e-4))


def test_brier_asks_whether_something_is_missing():
    assert odds.brier(ONE, SPLIT) == pytest.approx(0.05**2)
    assert odds.brier(NOTHING, SPLIT) == pytest.approx(0.95**2)
    assert odds.brier(NOTHING, {**SPLIT, "p_nothing": 0.4}) == pytest.approx(0.6**2)


def test_set_holds_the_fewest_that_make_up_90_percent():
    assert [s.hypothesis for s in odds.credible(SPLIT)] == ["a@b", "c@b", "d@e"]
    assert len(odds.credible(answer(("a@b", 0.9), ("d@e", 0.1)))) == 1
    assert odds.in_set(ONE, answer(("d@e", 0.85), ("c@b", 0.1), ("nothing", 0.05)))
    assert not odds.in_set(ONE, answer(("d@e", 0.95), ("c@b", 0.05)))


def test_two_are_right_in_either_order_and_only_together():
    two = {**ONE, "group": "two", "right": [["a@b"], ["d@e"]], "twins": [["c@b"], []]}
    assert odds.of_truth(two, answer(("d@e + c@b", 0.6), ("a@b", 0.4))) == pytest.approx(0.6)


def test_fault_is_right_when_its_channel_is_accused_as_data():
    fault = {**ONE, "group": "fault", "truth": ["sensor.gain@b"]}
    assert odds.of_truth(fault, answer(("sensor.bias@b", 0.6), ("a@b", 0.4))) == pytest.approx(0.6)


def test_unknown_heat_is_right_for_what_no_catalogue_has():
    foreign = {**ONE, "group": "foreign"}
    assert odds.of_truth(foreign, answer(("unknown heat", 0.7), ("a@b", 0.3))) == pytest.approx(0.7)


def test_sure_of_another_is_told_from_sure_of_nothing():
    assert odds.surely_another(ONE, answer(("d@e", 0.95), ("nothing", 0.05)))
    assert not odds.surely_another(ONE, answer(("c@b", 0.95), ("nothing", 0.05)))
    assert odds.surely_nothing(ONE, answer(("nothing", 0.95), ("a@b", 0.05)))
    assert odds.surely_nothing(NOTHING, answer(("nothing", 1.0))) is None


def test_when_a_condition_held():
    label = {**ONE, "group": "condition", "test": "run", "span": [600.0, 900.0]}
    row = {"hypothesis": "a@b in run", "effects": ["a@b in run"], "probability": 1.0}
    told = {**answer(), "odds": [{**row, "begin_s": 540.0, "end_s": 930.0}]}
    assert odds.first_right(label, told)
    assert odds.when_right(label, told)
    assert not odds.when_right(label, {**told, "odds": [{**row, "begin_s": 0.0, "end_s": 930.0}]})
    assert odds.when_right({**label, "span": [0.0, 3600.0]}, {**told, "odds": [row]})
    assert odds.when_right({**label, "span": []}, {**told, "odds": [row]}), "no begin and end: the whole test"
    assert odds.when_right({**label, "span": [], "test": ""}, told) is None, "nobody said in which test it held"


def test_a_folder_may_say_when_its_condition_held():
    truth = {"kind": "condition", "effects": [{"effect": "a@b", "size": "small"}], "test": "run"}
    network = SimpleNamespace(links=(), sources=())
    assert label_of("x", "y", truth, {}, network).span == ()
    assert label_of("x", "y", {**truth, "span_s": [540.0, 930.0]}, {}, network).span == (540.0, 930.0)


def test_a_verdict_without_odds_gives_its_group_nine_tenths():
    claimed = {"verdict": "group", "groups": [["a@b", "d@e"]], "candidates": {"a@b": {}, "d@e": {}, "f@g": {}}}
    rows = {s.hypothesis: s.p for s in odds.said(claimed)}
    assert rows == pytest.approx({"a@b": 0.45, "d@e": 0.45, "nothing": 0.05, "f@g": 0.05})
    quiet = {"verdict": "adequate", "groups": [], "candidates": {"a@b": {}}}
    assert odds.of_truth(NOTHING, quiet) == pytest.approx(0.9)


def test_reliability_of_a_perfect_and_of_a_boastful_answer():
    """Ten statements of 0.9, nine right: calibrated but for the rest. All wrong: off by 0.9."""
    honest = answer(("a@b", 0.97), ("nothing", 0.03))
    assert odds.calibration_error([(ONE, honest)]) == pytest.approx(0.03)
    boast = answer(("d@e", 0.97), ("nothing", 0.03))
    assert odds.calibration_error([(ONE, boast)]) == pytest.approx(0.97)
    assert odds.reliability([(ONE, honest), (ONE, boast)]) == [(0.8, 1.0, 2, pytest.approx(0.97), 0.5)]
    assert diagram([(0.8, 1.0, 2, 0.97, 0.5)]).splitlines()[-1] == "| 80 % to 100 % | 2 | 97 % | 50 % |"


def test_the_places_of_an_exchange_have_no_order():
    said = {"odds": [{"hypothesis": "x@b|a in t", "effects": ["x@b|a in t"]}], "candidates": {"y@d|c": 1.0}}
    assert odds.unordered(said) == {
        "odds": [{"hypothesis": "x@a|b in t", "effects": ["x@a|b in t"]}],
        "candidates": {"y@c|d": 1.0},
    }
    assert odds.unordered("x@b|a + z@c") == "x@a|b + z@c"
