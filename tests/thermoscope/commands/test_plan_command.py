"""thermoscope show plan: a page with a test and what each hypothesis predicts; one message where there is none."""

import json
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from geom.errors import InputError
from thermoscope.case_folder.folder import load_case
from thermoscope.commands.show.plan import plan
from validation.planning.candidate_tests import Experiment
from validation.revision.predicted_curves import UNCHANGED, PredictedCurves, predicted_curves, schedule
from viz.pages.bench_page import BenchPage, predicted, render

RIVALS = ("convection@flange", "radiation@flange")


def test_the_page_names_a_test_and_every_hypothesis(case, tmp_path):
    """A blower at standstill tells convection from radiation: it separates them most per hour."""
    page, target = tmp_path / "new" / "plan.html", tmp_path / "plan.json"
    assert plan(str(case), RIVALS, None, page, str(target)) == 0
    found, text = json.loads(target.read_text()), page.read_text()
    assert found["hypotheses"] == [UNCHANGED, *RIVALS]
    assert found["test"] == "blower on the machine at standstill"
    assert found["closest_sigma"] > 2
    assert all(word in text for word in ("Tomorrow: blower on the machine at standstill, ", *RIVALS, "flange", "12"))
    assert "http" not in text.replace("http://www.w3.org", "")


@pytest.mark.parametrize(("above_K", "said"), [(-5.0, True), (5.0, False)])
def test_what_no_test_has_read_yet_is_said(case, above_K, said):
    folder = load_case(case)
    found = predicted_curves(folder.case, {"a": folder.case.model})
    peak = max(float(y.max()) for y in found.curves["a"].values())
    text = render(BenchPage("three", found, "town", [], hottest_C=peak + above_K))
    assert (f"would reach {peak:.0f} °C; no test has read more than {peak + above_K:.0f} °C" in text) == said


def test_every_hypothesis_keeps_the_machine_as_cool_as_the_tests_so_far(case):
    """By the hotter one alone the currents would be larger: the page tells those that both permit."""
    folder = load_case(case).case
    model = replace(folder.model, values={**folder.model.values, "loss.copper": 3.0, "link.yoke-air": 0.5})
    factors = {}
    for name, models in {"a": {"a": folder.model}, "b": {"b": model}, "both": {"a": folder.model, "b": model}}.items():
        found = predicted_curves(folder, models, "ambient raised by 20 K")
        factors[name] = found.experiment.current_factor
    assert factors["both"] == pytest.approx(min(factors["a"], factors["b"]), rel=0.01)
    assert factors["both"] < 1.0


def test_the_page_and_the_document_tell_the_currents_that_are_permitted(case, tmp_path):
    """With the ambient raised the record itself would make the machine hotter than it was: it goes on, but smaller."""
    page, target = tmp_path / "plan.html", tmp_path / "plan.json"
    assert plan(str(case), RIVALS, "ambient raised by 20 K", page, str(target)) == 0
    document, text = json.loads(target.read_text()), page.read_text()
    (level,) = document["currents"]
    factor, record = document["current_factor"], load_case(case).case.tests[-1].inputs["current_A"]
    assert 0.5 < factor < 1.0
    assert level["input"] == "current_A"
    assert level["share_of_rms"] == pytest.approx(level["level_A"] / np.sqrt(np.mean(record**2)))
    assert level["share_of_rms"] == pytest.approx(factor)
    assert f"{factor:.2f} of the record" in text
    assert f"Currents: current_A at {level['level_A']:.4g} A, {level['share_of_rms']:.2f} of its rms." in text


@pytest.mark.parametrize(
    ("effects", "test", "words"),
    [((), None, "no diagnosis"), (("convection@flange",), "dance", "unknown test 'dance'"), (("a@b",), None, "a@b")],
)
def test_what_it_cannot_plan_is_one_message(case, tmp_path, effects, test, words):
    with pytest.raises(InputError, match=words):
        plan(str(case), effects, test, tmp_path / "new" / "p.html", None)
    assert not (tmp_path / "new").exists()


def test_a_file_that_is_no_page_is_refused(case, tmp_path):
    with pytest.raises(InputError, match="is not a name"):
        plan(str(case), RIVALS, None, tmp_path / "p.png", None)


def test_the_names_of_hypotheses_cover_no_curve(case):
    folder = load_case(case)
    figure = predicted(predicted_curves(folder.case, {"as it is": folder.case.model, "again": folder.case.model}))
    figure.draw_without_rendering()
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["as it is", "again"]
    assert not any(legend.get_window_extent().overlaps(ax.get_window_extent()) for ax in figure.axes)


def test_one_model_twice_is_not_told_apart(case):
    folder = load_case(case)
    found = predicted_curves(folder.case, {"a": folder.case.model, "b": folder.case.model})
    assert found.closest() == 0
    assert all(found.spread_K(c.name) == 0 for c in found.test.channels)


def test_what_is_read_is_read_where_hypotheses_are_furthest_apart(case):
    """Three curves that part in the middle and meet again: the pair that stays closest says when."""
    folder = load_case(case)
    test, n = folder.case.tests[-1], len(folder.case.tests[-1].time)
    bump = np.sin(np.linspace(0.0, np.pi, n)) ** 2
    curves = {f"{k}": {c.name: 20.0 + k * np.roll(bump, n // 10 * k) for c in test.channels} for k in range(3)}
    found = PredictedCurves(Experiment("hour", lambda time, *held: held), test, curves)
    gaps = [abs(a[test.channels[0].name] - b[test.channels[0].name]) for a, b in combinations(curves.values(), 2)]
    assert found.decisive() == np.argmax(np.min(gaps, axis=0))
    assert 0.2 * n < found.decisive() < 0.8 * n


def test_the_schedule_is_what_the_plan_holds(case):
    """Held inputs in full, in order, without gaps; a record that is driven again is not listed."""
    folder = load_case(case)
    name = "cool-down with wind on and off"
    found = predicted_curves(folder.case, {"a": folder.case.model}, name)
    rows = schedule(found.test, folder.case.tests[-1])
    assert {row[0] for row in rows} == {"vehicle_speed_mps"}
    assert [row[3] for row in rows] == [12.0, 0.0] * 3
    assert rows[0][1] == found.test.time[0]
    assert [a[2] for a in rows[:-1]] == [b[1] for b in rows[1:]]
    assert np.isclose(rows[-1][2], found.test.time[-1])


def test_a_record_in_steps_hides_no_other_steps(case):
    """Half at 15 A and half at 9 A was driven; 20 A, then nothing is planned: both parts are listed."""
    test = load_case(case).case.tests[-1]
    first = np.arange(len(test.time)) < len(test.time) // 2
    before = replace(test, inputs={"current_A": np.where(first, 15.0, 9.0)}, boundaries={})
    planned = replace(before, inputs={"current_A": np.where(first, 20.0, 0.0)})
    assert [(name, value) for name, _, _, value in schedule(planned, before)] == [
        ("current_A", 20.0),
        ("current_A", 0.0),
    ]
    assert schedule(before, before) == []
