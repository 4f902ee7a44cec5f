"""The observer against a dense Kalman filter, and on machines whose missing heat and sensor faults are known."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.linalg import expm
from small_case import small_case
from watched import run

from extras.monitor.observer import ProcessNoise, observer
from extras.monitor.observer.hypotheses import FROZEN_S, LOST_S
from extras.monitor.observer.kalman import most_doubtful, of_doubt
from extras.monitor.observer.observer import CORRELATION_S
from extras.monitor.observer.process import Process, bodies_of
from lumped.integration.record import Record
from lumped.model.build import bare_network, node_link
from lumped.model.network import Row
from lumped.transfer.laws import Fixed
from measured.case import Channel
from thermoscope.case_folder.folder import load_case
from validation.bands import parameter_posterior
from validation.comparison.error_budget import model_of

pytestmark = pytest.mark.heavy

AIR = {"ambient": 20.0}


@pytest.fixture(scope="module")
def design(tmp_path_factory):
    """Process and table of doubt of the small case, as it stands before any calibration."""
    folder = load_case(small_case(tmp_path_factory.mktemp("watch"), strength=0.0))
    network, values = model_of(folder)
    tests = [t for t in folder.case.tests if t.role == "calibrate"]
    bodies, table = most_doubtful(
        bodies_of(network), of_doubt(parameter_posterior(folder.case), tests, bodies_of(network))
    )
    return Process(network, values, bodies), table, folder.case.tests[0].channels


def watched(design, truth, y=None, given=(0, 1, 2)):
    process, table, channels = design
    y = truth.y if y is None else y
    sensors, y = [channels[j] for j in given], y[:, list(given)]
    one = observer(process, ProcessNoise(table, 1200.0), sensors, y[0], AIR, 20.0)
    return one, one.follow(truth.record, y)


def test_it_is_the_kalman_filter_of_the_textbook():
    """Two nodes, one sensor, constant coefficients: against matrices written down once more (Simon 2006, 5.1)."""
    net = bare_network("two", {"a": 500.0, "b": 2000.0}, ("air",))
    net = net.extended(
        [node_link(net, "ab", "link", "a", "b", Fixed(2.0)), node_link(net, "bair", "film", "b", "air", Fixed(1.0))]
    )
    W, tau, sigma, h, n = np.array([[400.0, 50.0], [50.0, 100.0]]), 900.0, 0.5, 2.0, 200
    y = 20.0 + 5.0 * np.sin(np.arange(n) / 30.0)
    sensor = Channel("a", "a", Row(np.array([0]), np.ones(1)), y, sigma)
    process = Process(net, {}, ("a", "b"))
    one = observer(process, ProcessNoise(W, tau), [sensor], y[:1], {"air": 20.0}, 0.0)
    mean, P = np.array([*one.filter.x, 0.0, 0.0]), one.filter.S @ one.filter.S.T
    got = one.follow(Record(h * np.arange(n), {}, {"air": np.full(n, 20.0)}), y[:, None])
    C, G = np.diag([500.0, 2000.0]), np.array([[2.0, -2.0], [-2.0, 3.0]])
    A = np.zeros((5, 5))
    A[:2, :2], A[:2, 2:4], A[:2, 4] = -np.linalg.solve(C, G), np.linalg.inv(C), np.linalg.solve(C, [0.0, 20.0])
    exact, keeps = expm(A * h), np.exp(-h / tau)
    implicit = np.linalg.inv(C + h * G)
    Phi = np.block([[implicit @ C, h * implicit], [np.zeros((2, 2)), keeps * np.eye(2)]])
    Q, H, first = np.zeros((4, 4)), np.array([1.0, 0.0, 0.0, 0.0]), True
    Q[2:, 2:] = (1 - keeps**2) * W
    for k in range(n):
        if not first:
            mean = np.concatenate([(exact @ [*mean, 1.0])[:2], keeps * mean[2:]])
            P = Phi @ P @ Phi.T + Q
        R = sigma**2 * (CORRELATION_S if first else CORRELATION_S / h)
        K = P @ H / (H @ P @ H + R)
        mean, P, first = mean + K * (y[k] - mean[0]), P - np.outer(K, H @ P), False
        assert_allclose([*got[k].x, *got[k].heat], mean, atol=2e-3)
        assert_allclose(got[k].S @ got[k].S.T, P, atol=1e-5 * P.max())


def test_nothing_is_said_of_a_machine_that_the_model_knows(design):
    truth = run()
    one, samples = watched(design, truth)
    assert one.events == []
    assert np.abs(np.array([s.x for s in samples]) - truth.T)[600:].max() < 0.5


def test_a_place_without_a_sensor_lies_within_its_band(design):
    truth = run(seed=2)
    _, samples = watched(design, truth, given=(0, 1))
    flange = design[0].network.places["flange"].mean
    T, sd = np.array([s.at(flange) for s in samples]).T
    assert np.mean(np.abs(T - truth.T[:, 2]) < 1.96 * sd) > 0.9


def test_missing_heat_is_found_where_and_when(design):
    """250 W into the flange from 2000 s to 5000 s, eight times what the table of doubt allows there."""
    truth = run(lambda t: 250.0 * (2000.0 < t < 5000.0))
    one, samples = watched(design, truth)
    at = design[0].bodies.index("flange")
    heat, sd = np.array([(s.heat[at], s.heat_sd[at]) for s in samples]).T
    assert abs(heat[4900] - 250.0) < 3.0 * sd[4900] + 25.0
    said = [e for e in one.events if e.where == "flange"]
    assert [e.kind for e in one.events] == ["model"] * len(one.events)
    assert len(said) == 1
    assert 2000.0 < said[0].from_s < 2600.0
    assert 5000.0 < said[0].to_s < 5900.0
    assert said[0].probability > 0.95


@pytest.mark.parametrize(("kind", "by_s"), [("lost", LOST_S), ("frozen", FROZEN_S), ("drifting", 2400.0)])
def test_a_sensor_that_fails_is_dropped_and_said(design, kind, by_s):
    """A slow drift first looks like missing heat, as long as the table of doubt allows that; in the end it does not."""
    truth = run(seed=3)
    # Readings whose yoke sensor fails from 3000 s on; it drifts by a kelvin a minute
    y, late = truth.y.copy(), truth.time > 3000.0
    if kind == "lost":
        y[late & (truth.time < 4000.0), 1] = np.nan
    if kind == "frozen":
        y[late, 1] = y[3000, 1]
    if kind == "drifting":
        y[late, 1] += (truth.time[late] - 3000.0) / 60.0
    one, samples = watched(design, truth, y)
    faults = [e for e in one.events if e.kind != "model"]
    assert [(e.kind, e.where) for e in faults] == [(kind, "T_yoke")]
    assert kind == "drifting" or one.events == faults
    assert faults[0].from_s <= 3000.0 + by_s + 2.0
    assert not [e for e in one.events if e.kind == "model" and e.to_s is None]
    away = np.abs(np.array([s.x for s in samples]) - truth.T)[-500:]
    assert away.max() < 3.0
    if kind == "lost":
        assert 4000.0 < faults[0].to_s < 4100.0
        assert one.states[1].dropped == ""
    else:
        assert one.states[1].dropped == kind


def test_a_sensor_at_rest_is_not_frozen(design):
    """Nothing happens for an hour: equal readings are right."""
    process, table, channels = design
    n = 3600
    record = Record(np.arange(float(n)), {"current_A": np.zeros(n)}, {"ambient": np.full(n, 20.0)})
    y = np.full((n, 3), 20.0)
    one = observer(process, ProcessNoise(table, 1200.0), channels, y[0], AIR, 20.0)
    one.follow(record, y)
    assert one.events == []
    assert n > FROZEN_S


def test_parts_of_a_record_are_the_whole(design):
    truth, (process, table, channels) = run(), design
    _, whole = watched(design, truth)
    one = observer(process, ProcessNoise(table, 1200.0), channels, truth.y[0], AIR, 20.0)
    out = []
    for first in range(0, 900, 300):
        some = slice(max(first - 1, 0), first + 300)
        time = truth.time[some]
        record = Record(time, {"current_A": truth.current[some]}, {"ambient": np.full(time.size, 20.0)})
        out += one.follow(record, truth.y[some])
    assert_allclose([s.x for s in out], [s.x for s in whole[:900]], atol=1e-9)
