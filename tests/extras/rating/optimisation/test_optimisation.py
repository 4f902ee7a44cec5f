"""Design problems of one node against closed forms; the searched set against a brute-force grid."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from extras.rating.design.machine_keys import MachineFile
from extras.rating.optimisation.electrics import Driven, auxiliary_power, electrics_of, way_of
from extras.rating.optimisation.problem import AUXILIARY, COPPER, PEAK, SETTLING, Problem
from extras.rating.optimisation.rest import losses, rest, without_feedback
from extras.rating.optimisation.search import Design, Effort, nsga2, pareto_set, unsga3
from extras.rating.optimisation.space import Space, Variable, errors, learned
from extras.rating.points import HotSpots
from geom.errors import InputError, MissingDependency
from geom.machine_file import load_machine
from lumped.circuits.hydraulics import Duct, friction, pressure_drop, pumping_power
from lumped.drives.drive import Controller, SeriesMachine, Vehicle
from lumped.integration.simulate import Record, simulate
from lumped.machine.outer import cowl_of
from lumped.machine.shapes import fins_of
from lumped.model.build import bare_network, node_link, node_source
from lumped.model.network import Row
from lumped.transfer.laws import Fixed, InputPower, Linear
from lumped.transfer.properties import air, ethylene_glycol

C, G, R, ALPHA, AIR = 1000.0, 2.0, 0.01, 0.004, 20.0
ROW = Row(np.array([0]), np.ones(1))


def body(alpha=ALPHA, film=None):
    """R I^2 (1 + alpha (T - 20)) in a body; a film to air of G per unit flow^0.8."""
    net = bare_network("body", {"body": C}, ("air",))
    blown = film or InputPower(G, (("flow", 1.0, 0.8),))
    copper = InputPower(R, (("current_A", 1.0, 2.0),), Linear(alpha, AIR))
    return net.extended(
        [node_link(net, "film", "film", "body", "air", blown)],
        [node_source(net, "loss:copper", "copper", {"body": 1.0}, copper)],
    )


def problem(variables=None, limit=120.0, **others):
    space = Space(variables or (Variable("flow", 0.5, 2.0, 1.0),))
    spot = HotSpots("body", limit, np.array([0]), np.ones((1, 1)))
    given = {"flow": 1.0, "current_A": 100.0}
    return Problem(body(), {}, given, {"air": AIR}, space, (spot,), 1, **others)


def test_a_rest_and_its_settling_are_the_closed_form():
    """G dT = R I^2 (1 + alpha dT);  tau = C / (G - R I^2 alpha);  settled after 3 tau (ln 20)."""
    found = rest(body(), {}, {"flow": 1.0, "current_A": 100.0}, {"air": AIR})
    P = R * 100.0**2
    assert_allclose(found.z[0] - AIR, P / (G - P * ALPHA), rtol=1e-9)
    assert_allclose(found.settling(ROW), C / (G - P * ALPHA) * np.log(20.0), rtol=1e-3)
    assert_allclose(
        losses(body(), {}, {"current_A": 100.0, "flow": 1.0}, found.z, ("copper",)), G * (found.z[0] - AIR), rtol=1e-9
    )


def test_settling_is_that_of_a_run():
    """Two nodes, the slow one behind the fast one: the linear answer is the run."""
    net = bare_network("two", {"a": 200.0, "b": 5000.0}, ("air",))
    links = [node_link(net, "ab", "link", "a", "b", Fixed(3.0)), node_link(net, "ba", "link", "b", "air", Fixed(1.5))]
    two = net.extended(links, [node_source(net, "heat", "copper", {"a": 1.0}, Fixed(60.0))])
    t = rest(two, {}, {}, {"air": AIR}).settling(ROW)
    time = np.linspace(0.0, 2.0 * t, 4001)
    T = simulate(two, Record(time, {}, {"air": AIR}, AIR), rows=[ROW]).y[:, 0]
    end = AIR + 60.0 / 3.0 + 60.0 / 1.5
    assert_allclose(t, time[np.flatnonzero(end - T > 0.05 * (end - AIR))[-1]], rtol=2e-3)


def test_a_machine_that_runs_away_is_judged_at_the_limit():
    """R I^2 alpha > G: no rest. With the resistance of 120 degC it is G dT = R I^2 (1 + 100 alpha), above the limit."""
    hot = rest(body(), {}, {"flow": 1.0, "current_A": 250.0}, {"air": AIR})
    assert hot is None or not hot.stable
    p = problem()
    done = replace(p, inputs={**p.inputs, "current_A": 250.0}).judged({"flow": 1.0})
    assert_allclose(done.places["body"] - AIR, R * 250.0**2 * 1.4 / G, rtol=1e-9)
    assert not done.feasible
    assert done.why == "runaway"
    cold = rest(without_feedback(body(), 120.0), {}, {"flow": 1.0, "current_A": 50.0}, {"air": AIR})
    assert_allclose(cold.z[0] - AIR, R * 2500.0 * 1.4 / G, rtol=1e-9)


def test_what_a_series_machine_takes():
    """Published: 955 N m at 511 A, 220 V; R_a + R_f follows from the ratings, and so does the rated voltage."""
    ratings = {"power_W": 100e3, "speed_rpm": 1000.0, "voltage_V": 220.0, "current_A": 511.0}
    found = electrics_of(True, ratings, {})
    assert_allclose(found.current(955.0), 511.0, rtol=1e-3)
    assert_allclose(found.current(955.0 / 4), 511.0 / 2, rtol=1e-3)
    excess = found.excess({"current_A": 511.0, "speed_rpm": 1000.0}, found.series.R * 511.0**2)
    assert_allclose(list(excess.values()), 0.0, atol=1e-9)
    assert electrics_of(False, {"torque_Nm": 10.0, "current_A": 5.0}, {}).current(4.0) == 2.0
    with pytest.raises(InputError, match="nothing says what current a torque takes"):
        electrics_of(False, {}, {}).current(4.0)


@pytest.mark.parametrize(("name", "length"), [("series-dc-100kw-jacket-one", 24), ("series-dc-100kw-jacket-two", 4)])
def test_the_pump_takes_pressure_times_flow(name, length):
    """A zigzag of 24 channels is one duct 24 times as long with 46 bends; two jackets side by side share the flow."""
    machine = load_machine(name)
    jackets = [p.name for p in machine.fluids if p.material != "air"]
    way, share = way_of(machine, jackets[0]), 8.0 / 60000.0 / len(jackets)
    z0, z1 = machine.part(jackets[0]).span
    assert way.bends == (46 if length == 24 else 0)
    if length == 24:
        assert_allclose(way.length, 24 * (z1 - z0))
    side = way.section**0.5
    duct = replace(Duct(side, side, way.length, way.bends, way.coil), width=way.section / side)
    same = pressure_drop(duct, share, ethylene_glycol(40.0, 0.5))
    power = auxiliary_power(machine, {"flow_l_min": 8.0, "current_A": 1.0, "speed_rpm": 1000.0})
    assert 0.5 < power / pumping_power(same, 8.0 / 60000.0) < 2.0  # a square of the same section
    assert auxiliary_power(machine, {"flow_l_min": 16.0}) > 2.0**2.5 * power


def test_a_fan_follows_the_cube_of_its_flow():
    machine = load_machine("series-dc-100kw-air")
    one, two = (auxiliary_power(machine, {"fan_flow_m3h": q}) for q in (138.0, 276.0))
    assert 2.0**2.6 < two / one <= 2.0**3.01  # a little less: friction falls with Re


def test_a_fan_on_the_shaft_works_on_the_air_between_the_fins():
    """Pressure along one channel times the flow of all; higher fins move more air; the cube of the speed."""
    machine = load_machine("tefc-industrial")
    cowl, fins = cowl_of(machine), fins_of(machine)
    power = auxiliary_power(machine, {"speed_rpm": cowl.at_rpm}, 40.0)
    mean_square = np.mean(np.linspace(1.0, cowl.end_share, 100_001) ** 2)
    duct = Duct(fins.spacing, fins.height, 1.0)
    channel = replace(duct, width=fins.spacing * fins.number)
    flow = cowl.air_speed * channel.width * channel.height
    Re = cowl.air_speed * fins.hydraulic_diameter / air(40.0).nu
    loss = (
        friction(Re, 2.5e-6 / fins.hydraulic_diameter) * fins.length * mean_square / fins.hydraulic_diameter
        + 0.57
        + 1.0
    )
    by_hand = loss * 0.5 * air(40.0).rho * cowl.air_speed**2 * flow / 0.5
    assert power == pytest.approx(by_hand, rel=1e-3)  # 0.57: a sharp entrance, Miller 1990; 1: what leaves
    half = auxiliary_power(machine, {"speed_rpm": 0.5 * cowl.at_rpm}, 40.0)
    assert 2.0**2.6 < power / half < 2.0**3.01
    file = MachineFile.read(Path("tefc-industrial"))
    taller = file.at({"geometry.housing.fin_height_mm": 1.5e3 * fins.height})
    assert auxiliary_power(taller, {"speed_rpm": cowl.at_rpm}, 40.0) > 1.3 * power


def test_corrections_are_learned_and_their_error_is_that_of_others():
    shares = [np.array([0.5, 0.0]), np.array([0.0, -0.5])]
    known = learned(shares, [{"q": 1.02}, {"q": 0.99}])
    assert_allclose([known.ratio("q", s) for s in shares], [1.02, 0.99])
    assert known.ratio("other", shares[0]) == 1.0
    assert_allclose(errors(known, [np.zeros(2)], [{"q": 1.01}])["q"], 1.0 - 1.0 / 1.01)


class Pumped(Problem):
    """A problem whose auxiliary power is the cube of its flow, over a channel that may be narrowed."""

    def judged(self, named):
        done = super().judged({"flow": named["flow"] / named.get("height", 1.0) ** 0.5})
        # What the flow of `problem` costs (W): its cube
        power = (10.0 * named["flow"] ** 3) / named.get("height", 1.0) ** 2
        return replace(done, objectives={**done.objectives, AUXILIARY: power})


VARIABLES = (Variable("flow", 0.5, 2.0, 1.0), Variable("height", 0.5, 2.0, 1.0))
REFERENCE = np.array([200.0, 400.0])


def two():
    p = problem(VARIABLES, 140.0)
    return Pumped(p.network, p.values, p.inputs, p.boundaries, p.space, p.spots, 1, aimed=(PEAK, AUXILIARY))


@pytest.fixture(scope="module")
def grid():
    """1600 designs on a grid, and the problem."""
    p = two()
    return p, [p.of(np.array([a, b])) for a in np.linspace(0.5, 2.0, 40) for b in np.linspace(0.5, 2.0, 40)]


@pytest.mark.parametrize("method", [nsga2, unsga3])
def test_the_search_covers_what_a_brute_force_grid_covers(grid, method):
    """Hypervolume within 2 % of that of 1600 designs on a grid."""
    from pymoo.indicators.hv import HV

    p, designs = grid
    able = np.array([[d.objectives[PEAK], d.objectives[AUXILIARY]] for d in designs if d.feasible])
    found = pareto_set(p, method, Effort(40, 25))
    volume = HV(ref_point=REFERENCE)
    ours = np.array([[d.performance.objectives[o] for o in p.aimed] for d in found])
    assert_allclose(volume(ours), volume(able), rtol=0.02)
    assert all(d.performance.feasible for d in found)


def test_no_design_of_a_pareto_set_is_beaten():
    found = pareto_set(two(), nsga2, Effort(16, 6))
    F = np.array([[d.performance.objectives[o] for o in (PEAK, AUXILIARY)] for d in found])
    assert len(F) > 5
    assert not any(np.all(f >= F, axis=1).sum() > 1 for f in F)
    assert np.all(np.diff(F[:, 0]) > 0)


def test_a_design_that_is_no_machine_counts_as_infeasible():
    def impossible(values):
        raise InputError("the channel is wider than the jacket", "jacket")

    p = problem(machine_at=impossible)
    done = p.of(np.array([1.0]))
    assert not done.feasible
    assert "wider than the jacket" in done.why
    with pytest.raises(InputError, match="no design is possible: jacket: the channel is wider"):
        pareto_set(p, nsga2, Effort(8, 1))


def test_designs_are_judged_on_a_cluster_as_here():
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(2) as pool:
        there = pareto_set(two(), nsga2, Effort(16, 3), pool)
    here = pareto_set(two(), nsga2, Effort(16, 3))
    assert [d.performance for d in there] == [d.performance for d in here]
    assert isinstance(here[0], Design)
    assert set(here[0].performance.objectives) == {PEAK, SETTLING, COPPER, AUXILIARY}


def test_a_cycle_at_constant_speed_takes_the_current_of_its_torque():
    """40 km/h on 4 % for an hour: T at the shaft by the vehicle's formula, I = sqrt(T / L_af)."""
    machine = SeriesMachine.from_ratings(100e3, 1000.0, 220.0, 511.0)
    vehicle = Vehicle(9000.0, 0.48, 4.52)
    time = np.arange(0.0, 3601.0, 1.0)
    wanted = np.minimum(time / 30.0, 1.0) * 40.0 / 3.6
    cycle = Driven(machine, vehicle, Controller(), time, wanted, np.full(time.size, 0.04))
    inputs, lag = cycle.inputs({})
    steady = machine.current(vehicle.wheel_torque(40.0 / 3.6, 0.04) / vehicle.efficiency)
    assert_allclose(inputs["current_A"], steady, rtol=0.02)
    assert_allclose(inputs["speed_rpm"], 40.0 / 3.6 / vehicle.wheel_radius * vehicle.gear * 30 / np.pi, rtol=0.02)
    assert max(lag.values()) < 0.0
    weak = cycle.inputs({"controller.Kp": 0.5, "controller.Ki": 0.001})[1]
    assert max(weak.values()) > 0.0


def test_without_pymoo_the_message_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pymoo", None)
    with pytest.raises(MissingDependency, match=r"pip install 'thermoscope\[optimise\]'"):
        pareto_set(two(), nsga2, Effort(8, 1))
