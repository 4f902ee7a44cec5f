"""What is said of a model beside the plain ones."""

from dataclasses import replace

import pytest
from two_bodies import bench

from thermoscope.case_folder.stored_comparison import yardstick_document
from thermoscope.commands.test.compare import comparison_summary
from validation.comparison.compare import errors
from validation.yardstick.words import model_error, sentence, warning
from validation.yardstick.yardstick import yardstick


@pytest.fixture(scope="module")
def case():
    whole = bench(held=())
    return replace(whole, tests=(*whole.tests[:2], replace(whole.tests[2], role="hold-out")))


@pytest.fixture(scope="module")
def measure(case):
    return yardstick(case)


def with_film(case, factor):
    return errors(replace(case, model=replace(case.model, values={"link.film": factor})))


def test_a_right_model_has_nothing_left_to_learn(case, measure):
    right = errors(case)
    assert "still to be learnt" not in sentence(measure, right)
    assert warning(measure, right) == ""


def test_a_wrong_film_leaves_something_to_learn_and_says_how_much(case, measure):
    wrong = with_film(case, 1.5)
    left = model_error(measure, wrong) - min(measure.errors.values())
    assert f"About {left:.1f} K is still to be learnt" in sentence(measure, wrong)


def test_a_model_worse_than_none_is_told_so(case, measure):
    wrong = with_film(case, 0.02)
    assert model_error(measure, wrong) > measure.errors["persistence"]
    assert warning(measure, wrong).startswith("Worse than no model at all")


def test_a_model_that_no_physics_beats_is_told_so_before_all_else(case, measure):
    wrong = with_film(case, 1.5)
    plain = {"persistence": 2.0, "black_box": 0.5, "free_network": 0.4}
    scaled = replace(measure, hold_out={kind: model_error(measure, wrong) * K for kind, K in plain.items()})
    said = f"Worse than a model without physics: {model_error(measure, wrong):.2f} K, where that leaves "
    assert warning(scaled, wrong).startswith(said)
    assert warning(replace(scaled, hold_out=dict.fromkeys(measure.errors, model_error(measure, wrong))), wrong) == ""
    document = yardstick_document(scaled, wrong, case)
    assert next(iter(document["yardstick"])) == "warning"
    summary = comparison_summary(
        {**document, **wrong.document(), "error_budget": {}, "sampling": {}}, "bench", "A doubt."
    )
    assert summary.sentence.startswith(said)
    assert "A doubt." in summary.sentence


def test_both_are_judged_on_the_held_out_tests_alone(case, measure):
    result = errors(case)
    (unseen,) = [t for t in result.tests if t.role == "hold-out"]
    assert model_error(measure, result) == pytest.approx(unseen.rmse_K)
