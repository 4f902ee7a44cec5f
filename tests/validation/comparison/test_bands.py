"""Bands: a closed form, what a sensor does to them, and that they hold the truth of another machine."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from lumped.model.build import bare_network, node_link, node_source
from lumped.model.multipliers import parameter_values
from lumped.model.network import Parameter, Row
from lumped.transfer.laws import Fixed
from measured.case import Case, Channel, Model, Test
from measured.doubt import USUAL
from validation.bands import Place, at_end, band_stretches, bands, parameter_posterior
from validation.bands.at_rest import AtRest
from validation.comparison.predict import thermal
from validation.revision.revise import calibrate

G, P, C, HOURS = 2.0, 60.0, 4000.0, 10.0
TIME = np.arange(0.0, 3600.0 * HOURS, 300.0)


def chain():
    """shell - air (G), core - shell (2 G), heat P in the core."""
    net = bare_network("chain", {"core": C, "shell": C}, ("air",))
    links = [
        node_link(net, "film", "film", "shell", "air", Fixed(G)),
        node_link(net, "joint", "link", "core", "shell", Fixed(2.0 * G)),
    ]
    heat = [node_source(net, "heat", "copper", {"core": 1.0}, Fixed(P))]
    own = [("film", 0.3), ("joint", 0.4), ("heat", 0.1)]
    parameters = tuple(Parameter(f"p.{n}", ((n, 1.0),), prior_sd=sd) for n, sd in own)
    return replace(net.extended(links, heat, parameters))


def places(network):
    return [Place(n, Row(np.array([i]), np.ones(1))) for i, n in enumerate(network.states)]


def measured(seen=("shell",), seed=0, factors=(1.0, 1.0, 1.0)):
    """A test whose film, joint and heat are the model's times `factors`: exact solution of the linear network."""
    g, k, p = np.array(factors) * (G, 2.0 * G, P)
    A = np.array([[-k, k], [k, -k - g]]) / C
    values, vectors = np.linalg.eig(A)
    rest = -np.linalg.solve(A, np.array([p / C, 0.0]))
    T = 20.0 + rest - (vectors * np.exp(np.outer(TIME, values))[:, None, :]) @ np.linalg.solve(vectors, rest)
    rng = np.random.default_rng(seed)
    channels = [
        Channel(n, n, Row(np.array([i]), np.ones(1)), T[:, i] + 0.05 * rng.standard_normal(TIME.size), 0.3)
        for i, n in enumerate(("core", "shell"))
        if n in seen
    ]
    air = np.full(TIME.size, 20.0)
    return Test("stand", "calibrate", TIME, {}, {"air": air}, tuple(channels), 20.0), T


def test_stretch_by_stretch_they_are_the_same(monkeypatch):
    """What a long test needs of memory is that of a stretch."""
    network, (test, _) = chain(), measured()
    of = parameter_posterior(Case("chain", Model(network), (test,)))
    whole, last = bands(of, test, places(network)), at_end(of, test)
    monkeypatch.setattr("validation.bands.band.NUMBERS", 1)
    monkeypatch.setattr("validation.comparison.linearisation.SHORTEST", 7)
    monkeypatch.setattr("validation.bands.band.FEWEST", 7)
    parts = list(band_stretches(of, test, places(network)))
    assert max(part.time.size for part in parts) == 7
    assert_allclose(np.concatenate([part.time for part in parts]), TIME)
    for cut, at_once in ((bands(of, test, places(network)), whole), (at_end(of, test), last)):
        pairs = [(cut.y, at_once.y), (cut.sd, at_once.sd)] if at_once is whole else zip(cut, at_once, strict=True)
        for a, b in pairs:
            assert_allclose(a, b, rtol=1e-9, atol=1e-9)


def test_before_a_calibration_the_priors_add_up():
    """At rest (to 0.3 % after 10 h) T_core = air + P (1/G + 1/2G): each prior by its share of the rise."""
    network, (test, _) = chain(), measured()
    few = {k: 1e-9 for k in USUAL} | {"boundary": 0.5}
    known = parameter_posterior(Case("chain", Model(network), (test,), doubt=few))
    found = bands(known, test, places(network))
    shell, joint = P / G, P / (2.0 * G)
    core = np.sqrt((0.3 * shell) ** 2 + (0.4 * joint) ** 2 + (0.1 * (shell + joint)) ** 2 + 0.5**2)
    assert_allclose(found.sd[-1], [core, np.hypot(0.5, np.hypot(0.3, 0.1) * shell)], rtol=5e-3)


@pytest.fixture(scope="module")
def calibrated():
    test, T = measured(factors=(1.3, 0.7, 1.1))
    case = Case("chain", Model(chain()), (test,))
    return replace(case, model=calibrate(case).model), T


def test_a_place_without_a_sensor_is_less_sure(calibrated):
    case, T = calibrated
    found = bands(parameter_posterior(case), case.tests[0], places(case.model.network))
    core, shell = found.sd[-1]
    assert shell < 0.1 * np.ptp(T[:, 1])  # slope and place of its sensor leave 6 %
    assert core > 2.0 * shell
    assert np.all(np.abs(T - found.y)[-1] < found.half95[-1])


def test_what_trades_in_the_fit_does_not_widen_what_was_measured(calibrated):
    """The shell reads a quotient of heat and film: without their correlation it would seem less sure than it is."""
    case, _ = calibrated
    known = parameter_posterior(case)
    apart = replace(known, covariance=np.diag(np.diag(known.covariance)))
    tied, loose = (bands(k, case.tests[0], places(case.model.network)).sd[-1, 1] for k in (known, apart))
    assert tied < 0.8 * loose


def test_at_rest_the_band_is_that_of_a_long_record(calibrated):
    """20 time constants of the chain; a constant load."""
    case, _ = calibrated
    known, core = parameter_posterior(case), places(case.model.network)[0]
    time = np.linspace(0.0, 400_000.0, 400)
    long = Test("rest", "hold-out", time, {}, {"air": np.full(time.size, 20.0)}, (), 20.0)
    network = thermal(known.network)
    values = parameter_values(network, known.values)
    sd = AtRest(known, network).sd(values, {}, {"air": 20.0}, core.row)
    assert_allclose(sd, bands(known, long, [core]).sd[-1, 0], rtol=0.03)


def test_the_start_is_as_sure_as_its_doubt(calibrated):
    case, _ = calibrated
    found = bands(parameter_posterior(case), case.tests[0], places(case.model.network))
    assert np.all(found.sd[0] <= USUAL["start"] + 0.01)


def test_all_states_at_the_end_are_those_of_the_band(calibrated):
    """A field is a sum over states: its band needs their covariance, the slow share comes on top."""
    case, _ = calibrated
    known, test = parameter_posterior(case), case.tests[0]
    first, last, R = at_end(known, test)
    found = bands(known, test, places(case.model.network))
    assert_allclose(first, found.y[0], rtol=1e-12)
    assert_allclose(last, found.y[-1], rtol=1e-12)
    slow = np.array([known.slow(p.row) for p in places(case.model.network)]) * (last - first)
    assert_allclose(np.sqrt(np.sum(R**2, axis=1) + slow**2), found.sd[-1], rtol=1e-9)
    assert (R[0] @ R[1]) ** 2 < 0.99 * (R[0] @ R[0]) * (R[1] @ R[1])  # core and shell are not unsure alike


def test_bands_stay_where_they_were_when_fitted_tests_leave_the_case():
    """What a fit told of each parameter stands in its interval, whether its readings are still there or not."""
    network, (test, _) = chain(), measured(("core", "shell"))
    other = replace(measured(("core", "shell"), seed=1)[0], name="other")
    case = Case("chain", Model(network), (test, other))
    case = replace(case, model=calibrate(case).model)
    tests = (case.tests, case.tests[:1], (replace(test, name="new", channels=()),))
    both, one, none = (parameter_posterior(replace(case, tests=some)) for some in tests)
    sd = [
        [float(np.sqrt(of.covariance[i, i])) for i in (of.names.index(p.name) for p in network.parameters)]
        for of in (both, one, none)
    ]
    assert max(sd[0]) < 0.5 * max(p.prior_sd for p in network.parameters)
    assert_allclose(sd[1], sd[0], rtol=0.2)
    assert_allclose(sd[2], sd[0], rtol=0.2)
