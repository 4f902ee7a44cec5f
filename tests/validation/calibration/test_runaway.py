"""A step of a fit, or a hypothesis, at whose values the machine would run away is passed by; it ends nothing."""

from dataclasses import replace

import numpy as np
import pytest
from playground import Truth, network

from geom.errors import NoSolution
from validation.calibration import calibrate
from validation.calibration.calibrate import calibrated
from validation.inference import refit
from validation.inference.hypotheses import Weighed, weights
from validation.parameters.unknowns import working


@pytest.fixture
def case():
    return Truth(3).case(network())


def test_a_step_into_a_runaway_is_made_shorter(case, monkeypatch):
    """The fit that meets a runaway on its first step ends where the undisturbed one does."""
    net, unknowns = working(case)
    tests = case.training().tests[:1]
    free = calibrated(net, tests, unknowns, case.model.values, 1)
    plain, met = calibrate.segments, []

    def once(network, tests, values, parameters=(), **more):
        if len(parameters) == 0 and not met:
            met.append(values)
            raise NoSolution("thermal runaway")
        return plain(network, tests, values, parameters, **more)

    monkeypatch.setattr(calibrate, "segments", once)
    found = calibrated(net, tests, unknowns, case.model.values, 1)
    assert met
    assert found.objective == pytest.approx(free.objective, rel=1e-3)


def test_a_hypothesis_that_runs_away_everywhere_is_as_good_as_excluded(monkeypatch):
    def wild(*_, **__):
        raise NoSolution("thermal runaway")

    monkeypatch.setattr(refit, "first_refit", wild)
    monkeypatch.setattr(refit, "starts", lambda *_: [np.zeros(1)])
    h = refit.laplace(None, Weighed((0,), "", -1.0, 5.0))
    assert h.fit is None
    assert weights([Weighed(), replace(h, log_prior=0.0)])[1] < -100.0
