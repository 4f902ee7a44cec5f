"""`compare` of a model with an event: it is looked for in held-out tests, and both errors are told."""

from dataclasses import replace

from two_bodies import bench

from measured.case import AddedEffect
from thermoscope.commands.test.compare import comparison_summary, repeated
from validation.comparison.compare import compare

NAME = "convection.constant@body in noon:2000-2600s"


def test_compare_tells_the_error_with_and_without_what_happened_again():
    case = bench((("noon", ((2000.0, 2600.0),)), ("dusk", ((4000.0, 4600.0),))))
    tests = tuple(replace(t, role="calibrate" if t.name == "noon" else "hold-out") for t in case.tests)
    assert repeated(replace(case, tests=tests)) == []
    model = replace(case.model, effects=(AddedEffect(*NAME.split("@", 1)),), values={NAME: 3.0})
    case = replace(case, tests=tests, model=model)
    (found,) = repeated(case)
    document = {**compare(case).document(), "error_budget": {}, "sampling": {}, "repeated_events": [found]}
    assert {"test", "event", "spans", "words", "rmse_K", "elsewhere_rmse_K"} == set(found)
    assert any(part == f"Again: {found['words']}." for part in comparison_summary(document, "bench").parts)
