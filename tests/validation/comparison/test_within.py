"""One sign, one rms, one rule: the same in the comparison, in dots, curves, bars and pages."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from one_body import measured, one_node

from extras.workbench import tables
from extras.workbench.appearance import Appearance
from measured.case import Case, Model
from measured.doubt import USUAL, widened
from validation.comparison.compare import Comparison as Errors, channel_error, compare, errors
from validation.comparison.uncertainty import COVERAGE
from viz.colours import VERDICT
from viz.data import Comparison, sensors
from viz.pages import report


def case(off=0.0, sigma=0.3, doubt=USUAL) -> Case:
    """A body that reads `off` more than its model says."""
    test = measured()
    model = np.asarray(test.channels[0].y, float)
    channel = replace(test.channels[0], y=model + off, sigma_K=sigma)
    return Case("one", Model(one_node()), (replace(test, channels=(channel,)),), doubt=doubt)


def row(of: Case, **more):
    return compare(of, **more).tests[0].channels[0]


def test_the_limit_is_the_expanded_uncertainty_of_reading_inputs_and_arithmetic():
    found = row(case())
    assert found.limit_K == pytest.approx(COVERAGE * np.sqrt(0.3**2 + found.u_input_K**2 + found.u_numeric_K**2))
    assert found.u_input_K > 0.1, "the room is off by half a kelvin"


def test_what_the_models_own_numbers_may_be_wrong_by_counts_as_an_expanded_uncertainty():
    plain, budgeted = row(case()), row(case(), budgets={"warm": {case().tests[0].channels[0].name: 4.0}})
    assert budgeted.u_numeric_K == pytest.approx(2.0)
    assert budgeted.limit_K > plain.limit_K


def test_a_wider_doubt_of_the_case_is_a_wider_limit():
    assert row(case(doubt=widened({"boundary": 5.0}))).limit_K > 2 * row(case()).limit_K


def test_an_input_no_law_reads_moves_nothing():
    one = case()
    more = replace(
        one,
        tests=(
            replace(one.tests[0], inputs={**one.tests[0].inputs, "vehicle_speed_mps": np.ones(one.tests[0].time.size)}),
        ),
    )
    assert row(more).limit_K == row(one).limit_K


def test_errors_alone_are_not_judged():
    found = errors(case()).tests[0].channels[0]
    assert found.verdict == "unknown"
    assert found.rmse_K == row(case()).rmse_K


@pytest.mark.parametrize("off", [-3.0, -0.5, 0.5, 3.0])
def test_table_dot_curve_bar_and_page_say_the_same(off):
    one = case(off)
    found: Errors = compare(one)
    (test,), mine = one.tests, found.tests[0].channels[0]
    (channel,) = test.channels
    shown = Comparison(test, {channel.name: channel.y - mine.bias_K}, found.limits[test.name])
    (dot,) = sensors(shown, {channel.name: (0.0, 0.0, 0.0)})
    look = Appearance(found.document(), {test.name: shown})
    (bar,) = tables.channels(look, test.name, 1.0)
    assert mine.bias_K == pytest.approx(off, abs=0.02), "measured - model: positive where the machine is hotter"
    assert dot.residual_K == pytest.approx(mine.bias_K)
    assert shown.rmse(channel) == pytest.approx(mine.rmse_K, abs=0.02)
    assert mine.verdict == ("within" if abs(off) < mine.limit_K else "over")
    assert (mine.verdict == "within") == (dot.verdict == "within") == (bar["tone"] == "within")
    colour = shown.residual_curve(channel).colour
    assert colour == VERDICT[dot.verdict]
    if off > mine.limit_K:
        assert dot.verdict == bar["tone"] == "hot"
    page = report._sensors(SimpleNamespace(comparison=found.document(), curves=[shown]))
    assert f">{mine.verdict}{'' if dot.verdict == 'within' else f' ({dot.verdict})'}<" in page
    assert f"{mine.limit_K:.3g}" in page


def test_one_rms_of_a_test():
    """Over all time that was read: half as many readings of the same hour count as much, half an hour counts half."""
    one = measured().channels[0]
    few = replace(one, y=np.where(np.arange(len(one.y)) % 2, np.nan, one.y))
    time = measured().time
    short = replace(one, y=np.where(2 * np.arange(len(one.y)) < len(one.y), one.y, np.nan))
    a, b = channel_error(one, time, one.y - 1.0), channel_error(few, time, one.y - 2.0)
    c = channel_error(short, time, one.y - 2.0)
    both = Errors("two", 0, (), (compare(case()).tests[0],))
    pooled = [replace(both.tests[0], channels=of).rmse_K for of in ((a, b), (a, c))]
    assert pooled == pytest.approx([np.sqrt((1.0 + 4.0) / 2.0), np.sqrt((2.0 * 1.0 + 4.0) / 3.0)], rel=0.02)
