"""The model error's columns against machines that really differ by one doubt."""

from dataclasses import replace

import numpy as np
import pytest
from playground import Truth, network

from lumped.model.build import bare_network, node_link, node_source
from lumped.model.network import Parameter
from lumped.transfer.laws import Fixed, InputPower
from measured.case import Channel, Recorded, Test
from measured.doubt import USUAL
from validation.calibration.calibrate import InnerProduct, minimise
from validation.calibration.input_steps import MOST, input_steps
from validation.calibration.model_error import alone, joints, jumps, lumping_errors, model_error, total_sd, with_doubts
from validation.comparison.linearisation import largest_rise, segments
from validation.noise import first_noise
from validation.parameters.unknowns import working


@pytest.fixture(scope="module")
def case():
    whole = Truth(4).case()
    return replace(whole, tests=whole.tests[:2])


def test_a_network_with_neutral_doubts_reads_the_same(case):
    plain = network()
    grown, doubts = with_doubts(plain, USUAL)
    assert doubts
    for a, b in zip(segments(plain, case.tests, {}), segments(grown, case.tests, {}), strict=True):
        np.testing.assert_allclose(a.r, b.r, atol=1e-9)


def test_a_column_is_what_the_doubt_does(case):
    """A bridge of one sigma: small against what it spans, so that the machine with it differs by the column."""
    plain = network()
    a, b, G = lumping_errors(plain, USUAL["bridge"])[0]
    grown, doubts = with_doubts(plain, USUAL, case.tests)
    k = [p.name for p in doubts].index(f"doubt:beside:{a}|{b}")
    error = model_error(plain, case.tests, {}, {**USUAL, "total": 1.0})
    with_it = segments(grown, case.tests, {doubts[k].name: 0.1 * G})
    for s, t in zip(segments(plain, case.tests, {}), with_it, strict=True):
        np.testing.assert_allclose(s.r - t.r, 0.1 * error.of(s)[:, k], atol=0.01 + 0.03 * np.abs(s.r - t.r).max())


def test_doubts_of_a_record_are_bounded_in_sum_and_scaled_together(case):
    """A bound of a hundredth of the largest rise: the columns keep their proportions, and the sum before is told."""
    most = 0.01 * max(largest_rise(c) for t in case.tests for c in t.channels)
    free, tight = (model_error(network(), case.tests, {}, {**USUAL, "total": x}) for x in (1.0, 0.01))
    for test in case.tests:
        for c in test.channels:
            whole, scaled = (x.columns[test.name, c.name][:, : x.model_columns] for x in (free, tight))
            assert total_sd(scaled) == pytest.approx(min(most, total_sd(whole)))
            assert tight.sums[test.name, c.name] == pytest.approx(total_sd(whole))
            np.testing.assert_allclose(scaled * total_sd(whole), whole * total_sd(scaled), atol=1e-9)


@pytest.mark.parametrize("nothing", [0.0, 1e-300])
def test_no_doubt_is_a_share_of_a_link_without_heat(nothing):
    net = bare_network("a row", dict.fromkeys(("left", "part", "right"), 100.0), ("air",))
    links = [node_link(net, "joint", "link", "left", "part", Fixed(nothing))]
    links += [node_link(net, "seat", "link", "part", "right", Fixed(2.0))]
    links += [node_link(net, "film", "film", "part", "air", Fixed(1.0))]
    _, doubts = with_doubts(replace(net, links=links), USUAL)
    assert all(p.prior_sd > 0.0 for p in doubts)


def test_what_a_parameter_moves_is_doubted_once_also_where_its_exponents_are_free(case):
    """The exponents that a fit may bend come as copies that the same parameter moves."""
    net, _ = working(case)
    assert [x for x in (*net.links, *net.sources) if x.origin]
    assert alone(net) >= alone(network())


def test_contacts_and_bearings_of_one_parameter_differ_more_than_films_of_one():
    """Two seats share a parameter; a gap shares one with what speed adds to it, and films to air share one."""
    net = bare_network("ends", dict.fromkeys(("rotor", "left", "right", "shell"), 100.0), ("air",))
    links = [node_link(net, n, "link", *n.split("-"), Fixed(2.0)) for n in ("left-shell", "right-shell", "rotor-shell")]
    links += [node_link(net, "blown", "link", "rotor", "shell", InputPower(1.0, (("speed", 1.0, 0.8),)))]
    links += [node_link(net, f"film {n}", "film", n, "air", Fixed(1.0)) for n in ("left", "right")]
    heat = [node_source(net, f"friction {n}", "friction", {n: 1.0}, Fixed(5.0)) for n in ("left", "right")]
    heat += [node_source(net, f"iron {n}", "iron", {n: 1.0}, Fixed(5.0)) for n in ("rotor", "shell")]
    shared = {
        "seats": ("left-shell", "right-shell"),
        "gap": ("rotor-shell", "blown"),
        "films": ("film left", "film right"),
        "friction": ("friction left", "friction right"),
        "iron": ("iron rotor", "iron shell"),
    }
    parameters = tuple(Parameter(n, tuple((t, 1.0) for t in of)) for n, of in shared.items())
    net = net.extended(links, heat, parameters)
    assert joints(net) == {"left-shell", "right-shell"}
    size = {p.name.removeprefix("doubt:"): p.prior_sd for p in with_doubts(net, USUAL)[1]}
    lines = {"seats": "joint", "gap": "group", "films": "group", "friction": "bearing", "iron": "split"}
    for group, line in lines.items():
        assert {size[t] for t in shared[group]} == {USUAL[line]}


def test_what_passes_a_neighbour_to_its_wind_is_doubted():
    """The shell has a film of the wind, the flange behind it none: a tenth of it may reach the flange."""
    net = bare_network("end", {"flange": 2000.0, "shell": 4000.0}, ("air",))
    wind = node_link(net, "wind", "film", "shell", "air", InputPower(8.0, (("speed", 10.0, 1.0),)))
    net = net.extended([node_link(net, "joint", "link", "flange", "shell", Fixed(12.0)), wind], (), ())
    time = np.arange(0.0, 100.0, 10.0)
    test = Test("run", "calibrate", time, {"speed": np.full(time.size, 5.0)}, {"air": np.full(time.size, 20.0)}, ())
    grown, doubts = with_doubts(net, USUAL, [test])
    (past,) = (p for p in doubts if p.name.startswith("doubt:past:"))
    assert past.name == "doubt:past:flange|shell|air"
    assert past.prior_sd == pytest.approx(USUAL["bridge"] * 12.0 / (12.0 + 4.0))
    (link,) = (x for x in grown.links if x.name == past.targets[0][0])
    assert (link.places, link.law) == (("flange", "air"), wind.law)


def test_a_flow_meter_may_be_off_in_one_test_alone(case):
    """The kinds of flow come once for all tests, then for each test, where the others have nothing."""
    error, names = model_error(network(), case.tests, {}), [t.name for t in case.tests]
    first = error.names.index(f"flow of air in {names[0]}")
    each = [f"flow of {x} in {n}" for x in ("air", "liquid") for n in names]
    assert error.names[first : first + len(each)] == tuple(each)
    for s in segments(network(), case.tests, {}):
        columns, k = error.of(s), names.index(s.test)
        own = columns[:, first + k]
        np.testing.assert_allclose(own, columns[:, error.names.index("flow of air")])
        assert np.abs(own).max() > 0.01
        assert not columns[:, first + 1 - k].any()


def test_a_boundary_that_moves_is_doubted_by_what_it_does_late():
    """One body of 200 s whose inlet falls by 8 K at once, against two lags in a row in closed form; nothing where the
    inlet stands."""
    net = bare_network("one", {"block": 200.0}, ("inlet",))
    net = replace(net, links=[node_link(net, "film", "film", "block", "inlet", Fixed(1.0))])
    time = np.arange(0.0, 2000.0, 1.0)
    fallen = np.where(time < 500.0, 28.0, 20.0)
    sensor = Channel("T", "block", net.places["block"].mean, fallen)

    def column(inlet):
        test = Test("run", "calibrate", time, {}, {"inlet": inlet}, (sensor,), initial=28.0)
        error = model_error(net, [test], {}, {**USUAL, "total": 1.0})
        return error.of(segments(net, [test], {})[0])[:, error.names.index("inlet late")]

    t = np.arange(0.0, 1500.0, 1.0)
    behind = 8.0 * (200 * np.exp(-t / 200) - 30 * np.exp(-t / 30)) / 170 - 8.0 * np.exp(-t / 200)
    assert np.max(column(fallen)) == pytest.approx(np.max(behind), rel=0.05)
    assert not column(np.full(time.size, 28.0)).any()


def test_model_error_widens_what_a_fit_is_sure_of_and_never_narrows_it(case):
    net, unknowns = working(case)
    noise = first_noise(segments(net, case.tests, {}))
    error = model_error(net, case.tests, {})
    start = np.zeros(len(unknowns.parameters))
    bare, wide = (minimise(net, case.tests, unknowns, start, noise, iterations=3, error=e) for e in (None, error))
    at = minimise(net, case.tests, unknowns, bare.theta, noise, iterations=0, error=error)
    assert np.all(at.sd >= bare.sd * (1 - 1e-9))
    assert wide.objective <= bare.objective + 1e-6


def test_woodbury_is_the_inverse_of_noise_and_model_error(case):
    parts, error = segments(network(), case.tests, {}), model_error(network(), case.tests, {})
    few = [s for s in parts if s.test == parts[0].test][:2]
    measure, noise = InnerProduct(few, first_noise(few), error), first_noise(few)
    root = [np.linalg.inv(noise.whiten(s, np.eye(s.r.size))) for s in few]
    D = np.vstack([error.of(s) for s in few])
    n = few[0].r.size
    S = np.zeros((D.shape[0],) * 2)
    S[:n, :n], S[n:, n:] = root[0] @ root[0].T, root[1] @ root[1].T
    r = np.concatenate([s.r for s in few])
    assert measure.square(few) == pytest.approx(r @ np.linalg.solve(S + D @ D.T, r), rel=1e-6)


def test_losses_that_follow_the_load_unsaid_are_doubted():
    """Iron by a tenth at the largest load of all tests, with its own law; copper, and what reads the load, are not."""
    net = bare_network("two", {"winding": 300.0, "core": 5000.0}, ("ambient",))
    copper = node_source(net, "copper", "copper", {"winding": 1.0}, InputPower(80.0, (("current_A", 10.0, 2.0),)))
    iron = node_source(net, "iron", "iron", {"core": 1.0}, InputPower(40.0, (("speed_rpm", 1000.0, 1.5),)))
    stray = node_source(net, "stray", "iron", {"core": 1.0}, InputPower(5.0, (("current_A", 10.0, 2.0),)))
    net = net.extended([node_link(net, "film", "film", "core", "ambient", Fixed(2.0))], [copper, iron, stray], ())
    time = np.arange(0.0, 100.0, 10.0)
    inputs = {"current_A": np.linspace(0.0, 20.0, time.size), "speed_rpm": np.linspace(3000.0, 0.0, time.size)}
    test = Test("run", "calibrate", time, inputs, {"ambient": np.full(time.size, 20.0)}, ())
    grown, doubts = with_doubts(net, USUAL, [test])
    assert {p.name: p.prior_sd for p in doubts if "*" in p.name} == {"doubt:iron*current_A": USUAL["load"]}
    law = next(s.law for s in grown.sources if s.name == "iron*current_A")
    np.testing.assert_allclose(law.factor(inputs), iron.law.factor(inputs) * (inputs["current_A"] / 20.0) ** 2)
    assert not any("*" in p.name for p in with_doubts(net, USUAL)[1])  # without tests there is no largest load


def test_what_jumps_between_samples_is_doubted_by_what_its_square_would_gain():
    """A current that is on or off from line to line; one that is straight; a speed, whose square makes no heat."""
    net, time = network(), np.arange(0.0, 1000.0, 10.0)
    on = (time // 50 % 2 == 0).astype(float)
    inputs = {"current_A": 100.0 * on, "speed_rpm": 1000.0 * on}
    test = Test("run", "calibrate", time, inputs, {"ambient": np.full(time.size, 20.0)}, ())
    steps, straight = ((on[1:] ** 2 + on[:-1] ** 2) / 2.0).sum(), np.where(np.diff(on), 1.0 / 3.0, on[1:]).sum()
    assert jumps(net, test, USUAL) == {"current_A": pytest.approx(np.sqrt(steps / straight))}
    ramp = replace(test, inputs={**inputs, "current_A": np.linspace(0.0, 100.0, time.size)})
    assert jumps(net, ramp, USUAL) == {}


def heated(time, on_s):
    """A body that a loss warms from some instant on, and a sensor on it; rows at some times."""
    net = bare_network("one", {"body": 2000.0}, ("ambient",))
    loss = node_source(net, "loss", "constant", {"body": 1.0}, InputPower(100.0, (("power", 1.0, 1.0),)))
    net = net.extended([node_link(net, "film", "film", "body", "ambient", Fixed(2.0))], [loss], ())
    fine = np.unique(np.concatenate([time, [on_s - 1e-3, on_s + 1e-3]]))
    power = (fine > on_s).astype(float)
    row = net.places["body"].mean
    sensor = Channel("body", "body", row, 0.0 * time, 0.01)
    test = Test(
        "run", "calibrate", time, {"power": np.interp(time, fine, power)}, {"ambient": 20.0 + 0.0 * time}, (sensor,)
    )
    exact = replace(test, recorded=Recorded(fine, {"power": power}, time, test.inputs))
    return net, test, exact


def test_a_step_between_two_rows_is_doubted_by_what_its_time_makes():
    """Of all times between two rows that of a load's step is open: one column has what that comes to (1 / sqrt(12))."""
    time = np.arange(0.0, 3000.0, 100.0)
    error = model_error(heated(time, 1050.0)[0], [heated(time, 1050.0)[1]], {})
    (column,) = error.columns["run", "body"][:, -error.steps :].T
    late = []
    for at in np.linspace(1000.5, 1099.5, 34):
        net, _, exact = heated(time, at)
        late.append(-segments(net, [exact], {})[0].r)
    after = time > 1100.0
    np.testing.assert_allclose(np.abs(column[after]), np.std(late, axis=0)[after], rtol=0.05)
    assert error.names[-1] == "input steps near 1000 s of run"


def test_steps_are_doubted_where_the_clock_is_not_and_never_scaled_down():
    """Rows of a second say when to the second, a coarse sensor does not feel it; more time between rows leaves a larger
    doubt, whatever the sum."""
    assert input_steps(heated(np.arange(0.0, 300.0, 1.0), 100.5)[1]) == []
    net, slow, _ = heated(np.arange(0.0, 3600.0, 60.0), 1000.0)
    coarse = model_error(net, [replace(slow, channels=(replace(slow.channels[0], sigma_K=99.0),))], {})
    assert not coarse.columns["run", "body"][:, coarse.model_columns :].any()
    sizes = []
    for step in (20.0, 60.0, 180.0):
        net, test, _ = heated(np.arange(0.0, 3600.0, step), 1000.0)
        error = model_error(net, [test], {}, {**USUAL, "total": 1e-9})
        assert total_sd(error.columns["run", "body"][:, : -error.steps]) < 1e-6
        sizes.append(total_sd(error.columns["run", "body"][:, -error.steps :]))
    np.testing.assert_allclose(np.array(sizes[1:]) / sizes[:-1], 3.0, rtol=0.2)


def test_neighbouring_steps_of_a_restless_input_are_moved_together():
    """More steps than are moved by themselves: the squares of a group come to one; falls go the other way."""
    time = np.arange(0.0, 6000.0, 60.0)
    _, test, _ = heated(time, 100.0)
    restless = replace(test, inputs={"power": np.arange(time.size) % 2.0})
    steps = [s for s in input_steps(restless) if not s.hidden]
    assert len(steps) == MOST
    assert sum(s.row.size for s in steps) == time.size - 1
    for s in steps:
        assert np.sum(s.share**2) == pytest.approx(1.0)
        np.testing.assert_array_equal(np.sign(s.share), np.where(s.row % 2, -1.0, 1.0))


def test_what_no_row_shows_is_doubted_where_steps_come_by_chance():
    """Levels held for four rows hide nothing; a new one in every row may well hide another, in any row."""
    time = np.arange(0.0, 3000.0, 60.0)
    _, test, _ = heated(time, 100.0)
    rng = np.random.default_rng(3)
    shown = replace(test, inputs={"power": np.repeat(rng.uniform(0.0, 1.0, 13), 4)[: time.size]})
    assert not [s for s in input_steps(shown) if s.hidden]
    unseen = replace(test, inputs={"power": rng.uniform(0.0, 1.0, time.size)})
    hidden = [s for s in input_steps(unseen) if s.hidden]
    np.testing.assert_array_equal(np.concatenate([s.row for s in hidden]), np.arange(time.size - 1))


def test_a_level_between_two_rows_is_as_large_as_its_doubt():
    """Levels of a minute each seen every four: what the rows miss in the body's warmth is within two of its doubts on
    average, and not a tenth of them. A sum of independent misses grows as the doubts do."""
    fine = np.arange(0.0, 7201.0, 10.0)
    late, doubts = [], []
    for seed in range(8):
        level = np.random.default_rng(seed).uniform(0.0, 1.0, 200)
        net, test, _ = heated(np.arange(0.0, 7201.0, 240.0), 100.0)
        power = level[(fine / 97.0).astype(int)]
        test = replace(test, inputs={"power": np.interp(test.time, fine, power)})
        exact = replace(test, recorded=Recorded(fine, {"power": power}, test.time, test.inputs))
        error = model_error(net, [test], {})
        late.append(segments(net, [test], {})[0].r - segments(net, [exact], {})[0].r)
        doubts.append(error.columns["run", "body"][:, -error.steps :])
    true = float(np.sqrt(np.mean(np.square(late))))
    said = float(np.mean([total_sd(d) for d in doubts]))
    assert 0.5 < said / true < 2.0
