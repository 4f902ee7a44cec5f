"""What is known already is not computed again, and comes out the same."""

from dataclasses import replace

import numpy as np
import pytest
from playground import Truth, wind

from validation.calibration.calibrate import CachedSegments, calibrated, minimise, residual_noise
from validation.effects import effect
from validation.inference.evidence import calibrated_case, converged, recalibrated, scored
from validation.parameters.unknowns import working

NAMES = ("convection@flange.right", "loss.constant@yoke", "sensor.bias@yoke", "mass@yoke")


@pytest.fixture(scope="module")
def evidence():
    case = Truth(12, wind("flange.right", 12.0)).case()
    return scored(case, [effect(n) for n in NAMES], calibrated_case(case))


def test_a_fit_goes_on_with_the_jacobian_it_has(evidence):
    """Under another noise, from where it stands: the same optimum as with the Jacobian made again."""
    fit = evidence.fit
    held = {p.name: p.value for p in fit.network.parameters} | fit.values
    setting = (fit.network, evidence.tests, fit.unknowns, fit.theta, residual_noise(fit), held)
    kept, made = minimise(*setting, cache=CachedSegments(fit.parts, nearby=False)), minimise(*setting)
    np.testing.assert_allclose(kept.theta, made.theta, rtol=1e-9, atol=1e-12)
    assert kept.objective == pytest.approx(made.objective, rel=1e-12)


def test_calibration_ends_with_the_jacobian_of_where_it_stands(evidence):
    """What goes on from a calibration may rely on it."""
    case = Truth(12, wind("flange.right", 12.0)).case()
    network, unknowns = working(case)
    fit = calibrated(network, evidence.tests, unknowns, case.model.values)
    held = {p.name: p.value for p in network.parameters} | fit.values
    fresh = minimise(network, evidence.tests, unknowns, fit.theta, fit.noise, held, 0)
    np.testing.assert_allclose(fit.parts[0].J, fresh.parts[0].J, atol=1e-10)


def test_nothing_is_fitted_to_its_end_under_another_noise(evidence):
    """From wherever a fit stands: ever more steps of ever finer worth gain less than the evidence is read to."""
    far = replace(evidence.fit, theta=evidence.fit.theta + 0.5 * evidence.fit.unknowns.sd)
    other = recalibrated(replace(evidence, fit=far), residual_noise(evidence.fit))
    end = converged(other).fit
    assert end.objective <= other.fit.objective
    held = {p.name: p.value for p in end.network.parameters} | end.values
    finer = minimise(
        end.network, evidence.tests, end.unknowns, end.theta, end.noise, held, 30, worth=0.005, error=end.error
    )
    assert finer.objective == pytest.approx(end.objective, abs=0.2)
