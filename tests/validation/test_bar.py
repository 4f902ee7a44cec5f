"""What scores are held against must not depend on what is missing."""

import numpy as np
import pytest
from playground import Truth, wind
from validation.bar import SUSPECT, Simulation, bar_of, undisturbed
from validation.evidence import calibrated_case, candidates, scored
from validation.rivals import leading

KINDS = ("convection", "loss.constant", "sensor.bias")


@pytest.fixture(scope="module")
def windy():
    case = Truth(10, wind("flange.right", 12.0)).case()
    return case, scored(case, candidates(case, KINDS), calibrated_case(case))


def test_the_state_is_that_of_the_machine_without_the_effect(windy):
    """Calibrated to the same machine without the wind, the parameters stand nearer to where the bar is taken."""
    case, evidence = windy
    calm = calibrated_case(Truth(10).case())
    taken = undisturbed(case, evidence, leading(evidence, np.ones(len(evidence.effects)), SUSPECT)).fit
    dragged, mended = (np.abs((x.theta - calm.theta) / calm.unknowns.sd) for x in (evidence.fit, taken))
    assert np.max(dragged) > 1.5 * np.max(mended)


def test_a_bar_without_sizes_has_the_linear_ones(windy):
    case, evidence = windy
    bar = bar_of(case, evidence, Simulation(draws=8, workers=1), sizes=False)
    k = evidence.names.index("loss.constant@housing")
    assert bar.sizes["loss.constant@housing"] == pytest.approx(
        (bar.threshold + 0.842) * evidence.score.sd[k] * bar.null.kappa[k], rel=0.2
    )
