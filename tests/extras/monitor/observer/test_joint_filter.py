"""What an observer learns from recordings: constants of a simulated machine, and tangents against differences."""

from dataclasses import replace

import numpy as np
from numpy.testing import assert_allclose
from watched import run

from extras.monitor.observer.constants import Constants, with_motion
from extras.monitor.observer.joint_filter import JointFilter, _Terms
from extras.monitor.observer.kalman import ProcessNoise
from lumped.model.build import bare_network, node_link, node_source
from lumped.model.network import Parameter, Row
from lumped.transfer.laws import Fixed, InputPower, Linear, Power
from measured.case import Channel, Test
from measured.doubt import USUAL

G = {"wy": 8.0, "yf": 6.0, "ya": 3.0, "fa": 1.5}


def network(of=G, loss=0.02):
    """The machine of `watched.py`, every number a parameter; `of` may be wrong."""
    net = bare_network("three", {"winding": 2000.0, "yoke": 6000.0, "flange": 3000.0}, ("ambient",))
    ends = {"wy": ("winding", "yoke"), "yf": ("yoke", "flange"), "ya": ("yoke", "ambient"), "fa": ("flange", "ambient")}
    copper = InputPower(loss, (("current_A", 1.0, 2.0),), Linear(0.00393, 20.0))
    net = net.extended(
        [node_link(net, n, "link", *ends[n], Fixed(of[n])) for n in G],
        [node_source(net, "copper", "copper", {"winding": 1.0}, copper)],
    )
    return replace(net, parameters=tuple(Parameter(n, ((n, 1.0),), prior_sd=0.3) for n in (*G, "copper")))


def recorded(seed, named=("winding", "yoke", "flange")):
    truth = run(seed=seed, step=10.0)
    channels = [Channel(n, n, Row(np.array([j]), np.ones(1)), truth.y[:, j], 0.1) for j, n in enumerate(named)]
    inputs, air = dict(truth.record.inputs), dict(truth.record.boundaries)
    return Test(f"t{seed}", "calibrate", truth.time, inputs, air, tuple(channels), {n: 20.0 for n in named})


def test_wrong_constants_are_learned_beside_missing_heat():
    """Two conductances are off by a quarter: the readings bring them back, the right ones stay where they are."""
    tests = [recorded(1), recorded(2)]
    net = network({**G, "wy": 6.0, "ya": 3.8})
    constants = Constants(with_motion(net, tests), {}, tests[0].channels, USUAL)
    one = JointFilter(constants, ("winding", "yoke", "flange"), ProcessNoise(4.0 * np.eye(3), 1200.0))
    for test in tests:
        one.over(test)
    values, sd = constants.values(one.w), np.sqrt(np.diag(one.P))
    assert abs(values["wy"] - 8.0 / 6.0) < 0.08
    assert abs(np.log(values["ya"] / (3.0 / 3.8))) < 2.5 * sd[2]
    assert all(sd[:5] < 0.5 * constants.sd[:5])
    assert abs(np.log(values["copper"])) < 0.1


def test_tangents_of_the_constants_are_differences():
    """Heat over capacity by every constant of the model, with laws that bend, at an instant."""
    net = network()
    net = net.extended([node_link(net, "film", "film", "flange", "ambient", Fixed(0.4, Power(0.25)))])
    groups = [Parameter(f"capacity {n}", ((f"capacity:{n}", 1.0),), prior_sd=0.1) for n in ("winding", "yoke")]
    net = replace(net, parameters=(*net.parameters, Parameter("film", (("film", 1.0),), prior_sd=0.3), *groups))
    constants = Constants(net, {}, (), USUAL)
    terms, w, f = _Terms(constants), 0.1 * np.arange(8.0), np.array([1.0, 1, 1, 1, 1, 4000.0])
    f[:5] = [8.0, 6.0, 3.0, 1.5, 0.4]
    f[5] = 0.02 * 80.0**2
    z = np.array([70.0, 50.0, 40.0, 20.0, 1.0])

    def rate(x, T=z):
        terms.at(x, f)
        return terms.heat(T)[0] / terms.C

    terms.at(w, f)
    own = terms.by_constants(z, w.size) / terms.C[:, None]
    G_own = terms.heat(z)[1] / terms.C[:, None]
    for j, e in enumerate(1e-5 * np.eye(w.size)):
        assert_allclose(own[:, j], (rate(w + e) - rate(w - e)) / 2e-5, rtol=1e-5, atol=1e-9)
    for j, e in enumerate(1e-3 * np.eye(5)[:3]):
        assert_allclose(-G_own[:, j], (rate(w, z + e) - rate(w, z - e)) / 2e-3, rtol=1e-3, atol=1e-9)


def test_a_conductance_may_follow_the_speed_and_never_falls_below_itself():
    test = replace(recorded(1), inputs={**recorded(1).inputs, "speed_rpm": np.full(600, 1500.0)})
    net = with_motion(network(), [test])
    new = [p for p in net.parameters if p.name.startswith("learned:")]
    assert [p.name for p in new] == [f"learned:{n} by speed_rpm" for n in G]
    assert {(p.low, p.value, p.prior_sd) for p in new} == {(0.0, 0.0, 0.3)}
    constants = Constants(net, {}, (), USUAL)
    assert constants.values(np.full(len(constants.parameters), -0.2))["learned:wy by speed_rpm"] == 0.0
    law = next(x.law for x in net.links if x.name == "wy by speed_rpm")
    assert_allclose(law.factor({"speed_rpm": np.array([1500.0, 3000.0])}), [8.0, 16.0])
