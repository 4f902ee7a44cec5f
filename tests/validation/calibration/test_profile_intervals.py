"""Profile intervals against closed forms, bounds that stay open, stages, starts and going on after an interruption."""

from dataclasses import replace

import numpy as np
import pytest
from one_body import FILM, LOSS, MASS, G, P, measured, one_node

from geom.errors import InputError
from lumped.model.network import Parameter
from measured.case import Case, Model
from validation.calibration.calibrate import minimise
from validation.calibration.intervals import estimates
from validation.calibration.profile import profiles
from validation.calibration.staged_fit import Search, fit_stages
from validation.parameters.unknowns import Unknowns, working
from validation.revision.revise import calibrate


def fitted(*parameters, tests=None):
    network, tests = one_node(*parameters), tests or [measured()]
    unknowns = Unknowns(tuple(parameters))
    return minimise(network, tests, unknowns, np.zeros(len(parameters))), tests


def test_of_a_linear_model_the_profile_is_the_covariance():
    """Readings are linear in the loss and in a bias: the posterior is Gaussian, both intervals are 1.96 sd."""
    bias = Parameter(
        "bias of body", (("bias:body", 1.0),), value=0.0, low=-9, high=9, prior_sd=0.3, mapping="offset", neutral=0.0
    )
    fit, tests = fitted(LOSS, bias)
    found = profiles(fit, tests, {}, ["loss"])["loss"]
    (row, _) = estimates(fit)
    assert found.open == (False, False)
    np.testing.assert_allclose((found.low, found.high), row.ci95, rtol=0.03)


def test_ends_of_a_curved_profile_are_where_the_deviance_says():
    """At both ends the best fit with the film held there is 3.84 worse, by a fit that starts from nothing."""
    fit, tests = fitted(FILM, MASS)
    found = profiles(fit, tests, {}, ["film"])["film"]
    for value in (found.low, found.high):
        held = minimise(fit.network, tests, Unknowns((MASS,)), np.zeros(1), fit.noise, {"film": value})
        objective = held.objective + 0.5 * (np.log(value) / FILM.prior_sd) ** 2
        assert 2.0 * (objective - fit.objective) == pytest.approx(3.84, rel=0.1)


def test_an_end_at_a_bound_is_open():
    near = replace(FILM, high=1.0 + 1e-3)
    fit, tests = fitted(near, MASS)
    found = profiles(fit, tests, {}, ["film"])["film"]
    assert found.open == (False, True)
    assert found.high == pytest.approx(near.high)


def test_what_trades_names_its_partner():
    """Loss and film only show as their quotient once all is steady."""
    time = np.arange(90000.0, 110000.0, 500.0)
    steady = replace(measured(), time=time, initial=20.0 + P / G, boundaries={"ambient": np.full_like(time, 20.0)})
    still = replace(steady.channels[0], y=np.full_like(time, 20.0 + P / G))
    fit, _ = fitted(replace(LOSS, prior_sd=0.5), FILM, tests=[replace(steady, channels=(still,))])
    assert [row.partner for row in estimates(fit)] == ["film", "loss"]


def case(*tests):
    return Case("one", Model(one_node(LOSS, FILM, MASS)), tests)


def test_an_isolating_test_frees_its_own_and_the_others_take_it_as_found():
    both = case(measured("cool", frees=("mass",)), measured("warm"))
    _, unknowns = working(both)
    first, last = fit_stages(both, both.tests, unknowns)
    assert "mass" in first.free
    assert "mass" not in last.free
    assert {"loss", "film"} <= last.free
    done = calibrate(both)
    assert {"mass", "loss", "film"} <= {p.name for p in done.parameters}
    assert done.converged


def test_a_stage_that_frees_nothing_is_an_error():
    with pytest.raises(InputError, match="frees nothing"):
        calibrate(case(measured("cool", frees=("mas",)), measured()))


def test_the_same_seed_gives_the_same_fit():
    """Another seed starts elsewhere and ends at the same optimum, within a tenth of its standard deviation."""
    one, again, other = (calibrate(case(measured(shift=1.0)), search=Search(3, seed)) for seed in (1, 1, 2))
    assert one.model.values == again.model.values
    assert one.model.values["film"] == pytest.approx(other.model.values["film"], rel=0.02)


class CutError(Exception):
    """The plug was pulled."""


def test_an_interrupted_fit_goes_on():
    """From the values kept it needs fewer steps and ends where the uninterrupted one does."""
    off = case(measured(shift=4.0))
    kept, told, full, rest = {}, [], [], []

    def keep(values):
        kept.update(values)
        if len(told) > 1:
            raise CutError

    whole = calibrate(off, progress=full.append)
    with pytest.raises(CutError):
        calibrate(off, progress=told.append, search=Search(keep=keep))
    again = calibrate(off, progress=rest.append, search=Search(begin=kept))
    assert len(rest) < len(full)
    assert again.model.values["film"] == pytest.approx(whole.model.values["film"], rel=0.01)
