"""A verdict does not hang on the sample step: whole records and those of slower loggers say the same."""

from functools import cache

import numpy as np
import pytest
from hidden.cases import edits_of, plan, records_of
from hidden.user import case_of
from steadiness import HABITS, changed, markdown, thinned, thinned_case
from two_bodies import bench, three_tests

from validation import diagnose

SAME = 0.1  # of a probability: the halves of a whole record differ by as much


def restless(effect=None, size=0.0):
    """Two bodies whose load has another level every 160 s: of two hundred seconds no row shows it."""
    return three_tests("restless", effect, size, 0, np.arange(0.0, 6001.0, 20.0), 160.0, 100)


CASES = {"nothing": restless, "loss": lambda: restless("loss.constant@body", 30.0), "lid": bench}


@cache
def odds(name, every):
    """Verdict, and the probability of each cause without when it was."""
    case = CASES[name]()
    found = diagnose(thinned_case(case, every, "means") if every > 1 else case, plan=False)
    share = {}
    for o in found.odds:
        cause = " + ".join(e.partition(":")[0] for e in o.effects) or o.hypothesis
        share[cause] = share.get(cause, 0.0) + o.probability
    return found.verdict, share, found.words


@pytest.mark.parametrize("every", [2, 10])
@pytest.mark.parametrize("name", list(CASES))
def test_a_logger_of_means_gives_the_same_verdict_and_odds(name, every):
    (verdict, whole, _), (again, fewer, words) = odds(name, 1), odds(name, every)
    assert again == verdict
    assert max(fewer, key=fewer.get) == max(whole, key=whole.get)
    for cause, p in whole.items():
        assert fewer.get(cause, 0.0) == pytest.approx(p, abs=SAME), cause
    assert ("inputs change between rows of" in words) == (every == 10 and name != "lid")


def test_heat_that_is_switched_between_two_rows_accuses_no_input():
    """An incubator's heater, seen every 40 s as a mean: unless each step is doubted, it is told to have an offset."""
    label = plan("dev", 3001, ["nothing", "one", "condition", "fault"], ["incubator"])[-1]
    case = case_of(label.case, label.machine, records_of(label), edits_of(label))
    found = diagnose(thinned_case(case, 2, "means"), plan=False)
    assert (label.machine, label.group, found.verdict) == ("incubator", "nothing", "adequate")
    assert found.p_nothing > 0.6


def test_means_of_inputs_keep_their_integrals_and_currents_their_heat():
    test = restless().tests[0]
    fewer = {habit: thinned(test, 10, habit, frozenset(["load"])) for habit in HABITS}
    for habit, t in fewer.items():
        np.testing.assert_array_equal(t.time, test.time[::10])
        assert (t.recorded is None) == (habit != "grid")
    np.testing.assert_array_equal(fewer["instants"].inputs["load"], test.inputs["load"][::10])
    heat = np.mean(fewer["means"].inputs["load"][1:-1] ** 2)
    each = np.concatenate([[0.5], np.ones(9), [0.5]]) / 10.0  # a row half way between two instants counts for both
    exact = np.convolve(test.inputs["load"] ** 2, each, "valid")[5::10][: fewer["means"].time.size - 2]
    assert heat == pytest.approx(np.mean(exact), rel=1e-9)


def test_what_has_changed_is_another_verdict_or_lead_but_not_other_ends():
    whole = {"verdict": "named", "groups": [["flow@fan in road:300-900s"]]}
    assert not changed(whole, {"verdict": "named", "groups": [["flow@fan in road:400-800s"]]})
    assert changed(whole, {"verdict": "named", "groups": [["flow@fan in load:300-900s"]]})
    assert changed(whole, {"verdict": "adequate", "groups": []})


def test_the_table_counts_each_case_against_its_whole_record():
    label = {"group": "nothing", "truth": [], "right": [], "twins": []}
    a = {"case": "x", "verdict": "adequate", "groups": [], "odds": [], "candidates": {}, "label": label}
    rows = [{**a, "habit": h, "every": n, "p_nothing": p} for h, n, p in (("whole", 1, 0.9), ("means", 2, 0.7))]
    assert "| one in 2 | 0 of 1 | 1 of 1 |" in markdown(rows)
    assert "| one in 2 | 0 of 1 before, 0 of 1 now |" in markdown(rows, rows)
