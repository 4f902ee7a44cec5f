"""Channel operators against closed forms."""

import gc
from dataclasses import replace

import numpy as np
import pytest
from everything import machine, warm_test
from one_body import measured, one_node

from lumped.model.network import Parameter
from lumped.numerics.terms import Forcing
from measured.sensors.operators import lag
from validation.comparison.predict import Watch, predict
from validation.parameters.unknowns import nuisances

TIME = np.arange(0.0, 600.0, 10.0)


def lagged(time, T, tau):
    out = T[:, None].copy()
    lag(time, out, np.array([tau]))
    return out[:, 0]


@pytest.mark.parametrize("time", [TIME, np.sort(np.concatenate([TIME, [3.0, 55.0]]))], ids=["even", "uneven"])
def test_lag_of_a_ramp(time):
    """y = t - tau (1 - exp(-t / tau)), exact for any step."""
    np.testing.assert_allclose(lagged(time, time, 40.0), time - 40.0 * (1.0 - np.exp(-time / 40.0)), atol=1e-9)


def operator(target, value=0.0):
    return Parameter(target, ((target, 1.0),), value, mapping="offset", neutral=0.0)


@pytest.mark.parametrize("head", ["bias", "gain", "stem", "drift", "lag", "boundary", "initial", "delay"])
def test_tangents_pass_through_the_operator(head):
    """The derivative of a reading by its operator, at a point where other operators act too."""
    net, test = machine(), warm_test(machine())
    name = {"boundary": "ambient", "initial": "warm", "delay": "warm"}.get(head, "yoke")
    p, other = operator(f"{head}:{name}"), operator("gain:yoke ", 0.0)
    net = replace(net, parameters=(*net.parameters, p, other, operator("bias:housing", 1.0)))
    size = 2.0 if head in ("lag", "delay") else 0.1
    J = predict(net, test, {p.name: size}, [p]).J[:, :, 0]
    up, down = (predict(net, test, {p.name: size + h}).y for h in (0.02, -0.02))
    assert np.abs(J).max() > 1e-4
    np.testing.assert_allclose(J, (up - down) / 0.04, atol=0.02 * np.abs(J).max())


def test_bias_gain_and_stem():
    net, test = machine(), warm_test(machine())
    plain = predict(net, test, {}).y[:, 3]
    net = replace(
        net, parameters=(*net.parameters, operator("bias:yoke"), operator("gain:yoke"), operator("stem:yoke"))
    )

    def with_(name, value):
        return predict(net, test, {name: value}).y[:, 3]

    np.testing.assert_allclose(with_("bias:yoke", 2.0), plain + 2.0)
    np.testing.assert_allclose(with_("gain:yoke", 0.1), 20.0 + 1.1 * (plain - 20.0))
    stem = lagged(test.time, 0.9 * predict_without_lag(net, test) + 0.1 * 20.0, 10.0)
    np.testing.assert_allclose(with_("stem:yoke", 0.1), stem)


def predict_without_lag(net, test):
    channels = tuple(replace(c, lag_s=0.0) for c in test.channels)
    return predict(net, replace(test, channels=channels), {}).y[:, 3]


HEADS = (
    "bias:yoke",
    "gain:yoke",
    "stem:housing",
    "drift:yoke",
    "lag:yoke",
    "boundary:ambient",
    "initial:warm",
    "delay:warm",
    "swap:yoke|housing",
)


@pytest.mark.parametrize(("delay", "stop"), [(0.0, 50), (23.0, 7)])
def test_a_test_looked_at_in_stretches_is_the_test_as_a_whole(delay, stop):
    """Readings and tangents by heat and by every operator, with a clock that is right, or late by several samples."""
    net, test = machine(), warm_test(machine())
    own = [operator(target) for target in HEADS]
    net = replace(net, parameters=(*net.parameters, *own))
    values = {p.name: 0.02 for p in own} | {"delay:warm": delay, "lag:yoke": 5.0}
    tangents = (*net.parameters[:3], *own)
    whole, watch = predict(net, test, values, tangents), Watch(net, test, values, tangents)
    parts = [watch.until(min(n + stop, len(test.time))) for n in range(0, len(test.time), stop)]
    np.testing.assert_allclose(np.concatenate([p.y for p in parts]), whole.y, rtol=1e-11)
    np.testing.assert_allclose(np.concatenate([p.J for p in parts]), whole.J, atol=1e-7 * np.abs(whole.J).max())


def test_a_lag_is_bounded_by_the_test_where_it_is_least():
    """No reading comes before its heat, in any test: a fit may take off no more than the smallest declared lag."""
    network = one_node()
    late, prompt = measured("late"), measured("prompt")
    late = replace(late, channels=tuple(replace(c, lag_s=19.5) for c in late.channels))
    for tests in ((late, prompt), (prompt, late)):
        assert [p.low for p in nuisances(network, tests) if p.name.startswith("lag of")] == [0.0]


def test_runs_that_are_over_leave_no_course_of_their_inputs_behind():
    """What drives a large network over a record takes far more memory than its readings, so it goes with the run."""

    def courses():
        gc.collect()
        return {id(x) for x in gc.get_objects() if type(x) is Forcing}  # asks no weak proxy of others for its class

    net, test = machine(), warm_test(machine())
    before = courses()
    for bias in (0.1, 0.2, 0.3):
        predict(net, test, {net.parameters[0].name: bias})
    assert courses() <= before
