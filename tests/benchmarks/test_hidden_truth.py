"""The true machines share nothing with the rooms; their integrator is right, their formulas are the published ones."""

import ast
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from hidden.kinds import KINDS
from hidden.truth.archetype import measured, truly
from hidden.truth.body import Body, Joint, skeleton
from hidden.truth.candidate_tests import CANDIDATE_TESTS, carried_out
from hidden.truth.change import NOTHING
from hidden.truth.draw import Draw
from hidden.truth.films import air, cylinder_still, gap, plate_still
from hidden.truth.machine import Film, Loss, Machine
from hidden.truth.profile import between, fine_times
from hidden.truth.readings import lagged
from hidden.user import network_of
from scipy.integrate import solve_ivp

from measured.case import Test
from validation.planning.candidate_tests import candidate_tests

TRUTH = Path(__file__).parents[2] / "benchmarks" / "hidden" / "truth"
DRIVEN = [
    k for k in KINDS.values() if "vehicle_speed_mps" in k.plans[3].inputs(np.random.default_rng(0), np.arange(9.0))
]
ALLOWED = {"__future__", "collections", "dataclasses", "typing", "numpy", "scipy", "hidden"}


def imports(file):
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        if isinstance(node, ast.ImportFrom):
            yield node.module


@pytest.mark.parametrize("file", sorted(TRUTH.rglob("*.py")), ids=lambda f: f.stem)
def test_truth_shares_no_code_with_the_rooms(file):
    for name in imports(file):
        assert name.split(".")[0] in ALLOWED
        assert not name.startswith("hidden") or name.startswith("hidden.truth")


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda k: k.name)
def test_truth_is_far_finer_than_the_users_network(kind):
    """At least four cells per node with mass; every thermometer and bath is where the user thinks it is."""
    cells = kind.build(Draw(0), NOTHING).skeleton
    network = network_of(kind.name)
    assert cells.C.size >= 4 * np.count_nonzero(network.C > 50.0)
    assert {kind.called.get(t, t) for t in kind.thermometers} <= set(network.places)
    assert set(kind.parts) <= set(network.states)
    assert set(kind.parts.values()) <= set(cells.where)
    _, inputs, _ = truly(kind, kind.plans[0], 0, NOTHING)
    baths = {*kind.baths, *(k[2:] for k in inputs if k.startswith("T_"))}
    assert {kind.called.get(b, b) for b in baths} == set(network.boundaries)


def bar(n=40):
    """A bar heated at one end and held at 20 degC through a large film at the other."""
    s = skeleton([Body("bar", 500.0, n, 2.0, c_slope=0.0)], [])
    heat = Loss("heater", np.array([0]), np.ones(1), lambda T, u: 10.0)
    sink = Film("sink", np.array([n - 1]), "T_ambient", np.ones(1), lambda T, Ta, u: 1e4)
    return Machine(s, (heat, sink))


def test_steady_bar_is_the_closed_form():
    """10 W through 2 K/W: 20 K from end to end, half a cell less at each end; the film adds 1 mK."""
    time = np.arange(0.0, 40000.0, 20.0)
    T = bar().run(time, {"T_ambient": np.full(time.size, 20.0)}, np.full(40, 20.0))[-1]
    assert T[0] - T[-1] == pytest.approx(20.0 * 39 / 40, rel=1e-4)
    assert T[-1] == pytest.approx(20.001, abs=1e-3)


def test_joint_passes_heat_side_by_side():
    """Two isothermal bodies of 2 and 1 J/K through 3 W/K: the difference decays with 3 (1/2 + 1/1) per second."""
    s = skeleton(
        [Body("a", 2.0, 4, 1e-6, c_slope=0.0), Body("b", 1.0, 2, 1e-6, c_slope=0.0)], [Joint("ab", "a", "b", 3.0)]
    )
    time = np.arange(0.0, 0.5, 0.001)
    T = Machine(s, ()).run(time, {"none": np.zeros(time.size)}, np.r_[np.full(4, 30.0), np.full(2, 20.0)])
    assert T[-1, 0] - T[-1, -1] == pytest.approx(10.0 * np.exp(-4.5 * time[-1]), rel=2e-3)


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda k: k.name)
def test_own_integrator_against_a_stiff_solver(kind):
    """Seven minutes of the roughest test, current steps in it: where thermometers sit, within the 0.1 K they resolve of
    scipy's BDF at 1e-6."""
    machine, plan = kind.build(Draw(3), NOTHING), kind.plans[3]
    at, _, driving = truly(kind, plan, 3, NOTHING)
    time = fine_times(at, kind.logger.fine)[:84]
    given = {k: v[: time.size] for k, v in driving.items()}
    start = np.full(machine.skeleton.C.size, 22.0)
    ours = machine.run(time, given, start)

    def slope(t, T):
        return machine.slope(T, {k: float(between(np.array(t), time, k, v)) for k, v in given.items()})

    their = solve_ivp(slope, (0.0, time[-1]), start, "BDF", time[::8], rtol=1e-6, atol=1e-6, max_step=12.0).y.T
    read = [machine.skeleton.cell(s.body, s.position) for s in kind.thermometers.values()]
    assert np.abs(ours[::8] - their)[:, read].max() < 0.1


def test_air_is_that_of_the_tables():
    """Incropera, table A.4, 350 K: k 30.0e-3, mu 208.2e-7; nu by the ideal gas at 1 atm."""
    k, nu, beta, _ = air(np.array(350.0 - 273.15))
    assert float(k) == pytest.approx(30.0e-3, rel=0.01)
    assert float(nu) == pytest.approx(208.2e-7 * 287.05 * 350.0 / 101325.0, rel=0.01)
    assert float(beta) == pytest.approx(1 / 350)


def test_still_air_films_are_the_published_examples():
    """Incropera 9.4: pipe of 0.1 m, 165 in 23 degC, h = 7.29 W/m2/K; 9.2: glass of 0.71 m, 232 in 23 degC, 7.0."""
    pipe = cylinder_still(np.array(165.0), np.array(23.0), 0.1)
    glass = plate_still(np.array(232.0), np.array(23.0), 0.71)
    assert float(pipe) == pytest.approx(7.29, rel=0.04)
    assert float(glass) == pytest.approx(7.0, rel=0.04)


def test_lag_of_a_ramp_is_the_closed_form():
    """A first-order lag tau follows a ramp r t with r (t - tau (1 - exp(-t / tau)))."""
    time = np.arange(0.0, 300.0, 6.0)
    np.testing.assert_allclose(
        lagged(time, 0.1 * time, 20.0), 0.1 * (time - 20.0 * -np.expm1(-time / 20.0)), atol=1e-12
    )


def test_gap_at_standstill_only_conducts():
    k = air(np.array(60.0))[0]
    assert float(gap(np.array(60.0), 0.0, 0.06, 1e-3)) == pytest.approx(float(k) / 1e-3, rel=1e-6)


def test_same_seed_same_readings():
    kind, short = KINDS["tefc"], (replace(KINDS["tefc"].plans[0], minutes=15.0),)
    one, two = (measured(kind, 5, NOTHING, short)[0] for _ in range(2))
    for name, y in one.readings.items():
        np.testing.assert_array_equal(y, two.readings[name])


@pytest.mark.parametrize("kind", DRIVEN, ids=lambda k: k.name)
@pytest.mark.parametrize("name", CANDIDATE_TESTS)
def test_asked_for_tests_are_what_they_say(kind, name):
    """Standing means no speed and no rotor current; an even current keeps its heat; nothing else is made up."""
    plan, at, rng = carried_out(name, kind.plans[3]), np.arange(0.0, 4500.0, 30.0), np.random.default_rng
    driven, asked = kind.plans[3].inputs(rng(0), at), plan.inputs(rng(0), at)
    assert asked.keys() == driven.keys()
    if "standstill" in name:
        assert not asked["speed_rpm"].any()
        assert not asked.get("rotor_A", np.zeros(1)).any()
    if "standstill" in name and "cooling down" not in name:
        assert np.ptp(asked["current_A"]) == 0.0
        assert np.sum(asked["current_A"] ** 2) == pytest.approx(np.sum(driven["current_A"] ** 2))
    if "without current" in name or "no load" in name:
        assert not any(v.any() for k, v in asked.items() if k.endswith("_A"))
        assert asked["speed_rpm"].all()


@pytest.mark.parametrize("kind", DRIVEN, ids=lambda k: k.name)
def test_what_is_carried_out_is_what_was_planned(kind):
    """The true machine's inputs are those with which the diagnosis foretold what the test would show."""
    rng, four_hours = np.random.default_rng, np.arange(0.0, 14400.0, 30.0)
    at = np.arange(0.0, 60.0 * kind.plans[3].minutes, 30.0)
    base = Test("driven", "validate", at, kind.plans[3].inputs(rng(0), at), {}, (), 20.0)
    for factor, (experiment, _) in product((1.0, 0.7), candidate_tests(base, network_of(kind.name))):
        if experiment.name in CANDIDATE_TESTS:
            test = replace(experiment, current_factor=factor).modified(base, network_of(kind.name))
            asked = carried_out(experiment.name, kind.plans[3], factor).inputs(rng(0), four_hours)
            for key, planned in test.inputs.items():
                np.testing.assert_allclose(asked[key], planned, err_msg=f"{experiment.name}: {key}")


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda k: k.name)
def test_what_a_part_gives_up_another_receives(kind):
    """Conduction, films between cells and the textbook's bridges move heat and make none; a stream carries it out."""
    machine, rng = kind.build(Draw(0), NOTHING), np.random.default_rng(0)
    T = 50.0 + 10.0 * rng.standard_normal(machine.skeleton.C.size)
    q = machine.skeleton.conduction(T)
    assert abs(q.sum()) < 1e-9 * np.abs(q).sum()
    _, _, driving = truly(kind, kind.plans[3], 1, NOTHING)
    u = {k: float(np.median(v)) for k, v in driving.items()}
    for term in machine.terms:
        if isinstance(term, Film) and not isinstance(term.fluid, str):
            q = np.zeros(T.size)
            term.into(q, T, u)
            assert abs(q.sum()) < 1e-9 * max(np.abs(q).sum(), 1e-9), term.name


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda k: k.name)
def test_heat_stored_is_heat_made_less_heat_given_off(kind):
    """Twelve minutes of a driven test: the integral of C dT against that of all heat, trapezoids of 5 or 10 s, 1 %."""
    machine, plan = kind.build(Draw(4), NOTHING), replace(kind.plans[3], minutes=12.0)
    at, _, driving = truly(kind, plan, 4, NOTHING)
    time = fine_times(at, kind.logger.fine)
    T = machine.run(time, driving, np.full(machine.skeleton.C.size, 25.0))
    given = [dict(zip(driving, map(float, row), strict=True)) for row in zip(*driving.values(), strict=True)]
    flow = [machine.heat(x, u).sum() for x, u in zip(T, given, strict=True)]
    stored = np.sum(0.5 * (machine.skeleton.capacity(T[1:]) + machine.skeleton.capacity(T[:-1])) * np.diff(T, axis=0))
    made = sum(np.abs(machine.heat(T[0], u)).sum() for u in given) * kind.logger.fine
    assert stored == pytest.approx(np.trapezoid(flow, time), abs=0.01 * made)


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda k: k.name)
def test_nothing_of_an_effect_is_no_effect(kind):
    """At zero amplitude every effect, lasting or passing, leaves the machine's heat as it was, but for rounding."""
    draw, base = Draw(2), kind.build(Draw(2), NOTHING)
    T = 50.0 + 10.0 * np.random.default_rng(2).standard_normal(base.skeleton.C.size)
    _, _, driving = truly(kind, kind.plans[3], 1, NOTHING)
    u = {k: float(np.median(v)) for k, v in driving.items()}
    for hidden in (*kind.missing, *kind.passing):
        none = hidden.make(0.0)
        signals = {k: float(s(np.array([900.0]))[0]) for k, s in none.signals.items()}
        still = base.heat(T, u)
        moved = kind.build(draw, none).heat(T, {**u, **signals}) - still
        assert np.abs(moved).max() < 1e-12 * np.abs(still).max(), hidden.name
