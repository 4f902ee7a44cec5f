"""Radiation and copper loss that depend on temperature: closed forms, Newton's order, energy."""

from importlib import import_module
from inspect import getmembers, isclass
from pkgutil import walk_packages

import numpy as np
import pytest
from named_grids import bar, named
from scipy.optimize import brentq

import fem
from fem.matrices.assembly import assemble
from fem.matrices.grids import box
from fem.matrices.material import CopperLoss, Radiation, Term, isotropic
from fem.solvers.newton import solve_nonlinear, transient
from fem.solvers.solve import Iterative, Solver, only_fixed
from geom.constants import ALPHA_CU, SIGMA, ZERO_C
from geom.errors import InputError

GIVEN = 1e9  # a film so good that its fluid's temperature is the wall's, W/m2/K


def order(steps):
    """Of convergence, from the last three steps that are not rounding."""
    e = [s for s in steps if s > 1e-8][-3:]
    return np.log(e[2] / e[1]) / np.log(e[1] / e[0])


def nafems_t2(n, solver=Solver):
    field = assemble(bar(0.1, n), {"bar": isotropic(55.6)}, {"bar": 1.0})
    films = {"bar.left": GIVEN, "bar.right": 0.0}
    given = only_fixed(left=1000.0 - ZERO_C, right=0.0)
    terms = [Radiation("bar.right", 0.98, 300.0 - ZERO_C)]
    found = solve_nonlinear(solver(field), films, {}, np.zeros(field.n), given, terms, 500.0)
    return found, float(field.face_mean(field.films["bar.right"].trace) @ found.T) + ZERO_C


@pytest.mark.parametrize("n", [1, 16])
def test_nafems_t2_bar_that_radiates(n):
    """NAFEMS T2: 927 K. The profile is linear, so every mesh gives the root of the scalar balance."""
    exact = brentq(lambda T: 55.6 * (1000 - T) / 0.1 - 0.98 * SIGMA * (T**4 - 300**4), 300, 1000)
    found, end = nafems_t2(n)
    assert end == pytest.approx(exact, abs=1e-4)
    assert end == pytest.approx(927.0, abs=0.1)
    assert order(found.steps) == pytest.approx(2.0, abs=0.15)


def test_any_solver_settles():
    assert nafems_t2(8, Iterative)[1] == pytest.approx(nafems_t2(8)[1], abs=1e-6)


def copper_bar(q, n=32):
    """Loss q (W/m3) (1 + alpha (T - 20)), one end at 40 degC, the other insulated: T - 20 + 1 / alpha is a cosine."""
    L, k, alpha = 0.05, 0.6, 0.00393
    field = assemble(bar(L, n), {"bar": isotropic(k)}, {"bar": 1.0})
    found = solve_nonlinear(
        Solver(field),
        {"bar.left": GIVEN, "bar.right": 0.0},
        {},
        np.zeros(field.n),
        only_fixed(left=40.0, right=0.0),
        [CopperLoss("bar", q * field.blocks["bar"].volume, alpha)],
    )
    m = np.sqrt(q * alpha / k)
    theta = (20.0 + 1 / alpha) * np.cos(m * (L - field.xyz[:, 0])) / np.cos(m * L)
    return np.abs(found.T - (theta + 20.0 - 1 / alpha)).max(), found


def test_copper_loss_feeds_back():
    coarse, fine = copper_bar(6e4, 8)[0], copper_bar(6e4, 16)[0]
    error, found = copper_bar(6e4)
    assert error < 3e-3 * (found.T.max() - 40)
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.2)
    assert found.injected > 6e4 * 0.05 * (0.05 / 32) ** 2 * (1 + 0.00393 * 20)
    assert found.energy_balance < 1e-8  # 40 degC through a film of 1e9 W/m2/K are rounded off by 2e-9 of this heat


def test_thermal_runaway_is_refused():
    """Beyond m L = pi / 2 (151 kW/m3 here) no steady state exists."""
    with pytest.raises(InputError, match="not positive definite"):
        copper_bar(1.6e5)


def warm_cube():
    """A coil beside iron, with every kind of term: solver, films, contacts, load, fluids, terms."""
    x = np.linspace(0.0, 0.1, 5)
    mesh = box(
        x, x, x, lambda c: named(c, (c[:, 0] < 0.05, "coil"), default="iron"), lambda c: named(c, default="ambient")
    )
    field = assemble(mesh, {"coil": isotropic(1.0), "iron": isotropic(30.0)}, {"coil": 3e6, "iron": 3.6e6})
    terms = [CopperLoss("coil", 40.0), Radiation("coil.outer", 0.9, 20.0), Radiation("iron.outer", 0.5, 20.0)]
    films, contacts = {"coil.outer": 5.0, "iron.outer": 8.0}, {"coil|iron": 500.0}
    return Solver(field), films, contacts, 10.0 * field.load("iron"), only_fixed(ambient=20.0), terms


def test_warming_ends_where_newton_settles():
    solver, films, contacts, load, fluids, terms = warm_cube()
    start = np.full(solver.field.n, 20.0)
    T = transient(solver, films, contacts, load, fluids, start, step=5000.0, steps=20, terms=terms)
    assert np.abs(T[-1] - solve_nonlinear(*warm_cube()).T).max() < 1e-3


def test_unphysical_terms_are_refused():
    with pytest.raises(InputError, match="emissivity"):
        Radiation("x", 1.3, 20.0)
    field = assemble(bar(0.1, 2), {"bar": isotropic(1.0)}, {"bar": 1.0})
    with pytest.raises(InputError, match="unknown face 'x'"):
        Radiation("x", 0.3, 20.0).heat(field, np.zeros(field.n))


TERMS = [Radiation("bar.left", 0.7, 30.0), CopperLoss("bar", 3.0)]


def test_every_term_is_tried():
    """What takes heat out and has a slope, in any module of the room."""
    modules = [import_module(m.name) for m in walk_packages(fem.__path__, "fem.")]
    found = {
        c
        for m in modules
        for _, c in getmembers(m, isclass)
        if c.__module__ == m.__name__ and c is not Term and hasattr(c, "heat") and hasattr(c, "slope")
    }
    assert found == {type(term) for term in TERMS}


@pytest.mark.parametrize("term", TERMS, ids=lambda term: type(term).__name__)
def test_a_slope_is_the_derivative(term):
    """Against a central difference."""
    field = assemble(bar(0.1, 3, across=2), {"bar": isotropic(2.0)}, {"bar": 1.0})
    T, d = np.random.default_rng(0).uniform(20, 90, (2, field.n))
    e = 1e-4
    difference = (term.heat(field, T + e * d) - term.heat(field, T - e * d)) / (2 * e)
    assert np.abs(difference).max() > 0.0
    assert difference == pytest.approx(term.slope(field, T) @ d, abs=1e-7 * np.abs(difference).max())


@pytest.mark.parametrize(
    ("term", "watts"),
    [(TERMS[0], 0.7 * SIGMA * 1e-4 * (333.15**4 - 303.15**4)), (TERMS[1], -3.0 * (1 + ALPHA_CU * 40.0))],
    ids=lambda x: type(x).__name__,
)
def test_a_term_takes_what_it_says_at_one_temperature(term, watts):
    """60 degC throughout: what a face radiates, what a winding makes."""
    field = assemble(bar(0.1, 3, 0.01), {"bar": isotropic(2.0)}, {"bar": 1.0})
    assert term.heat(field, np.full(field.n, 60.0)).sum() == pytest.approx(watts, rel=1e-12, abs=1e-12)


def cooled_by_radiation(step, steps):
    """Lumped body in a void at 0 K: T = T0 (1 + 3 eps sigma A T0^3 t / C)^(-1/3). Largest error and fall (K)."""
    field = assemble(bar(0.01, 2, 0.01), {"bar": isotropic(1e5)}, {"bar": 3e6})
    area, C = 1e-4, field.blocks["bar"].capacity
    T0 = 800.0
    T = transient(
        Solver(field),
        {"bar.left": 0.0, "bar.right": 0.0},
        {},
        np.zeros(field.n),
        only_fixed(left=0.0, right=0.0),
        np.full(field.n, T0 - ZERO_C),
        step,
        steps,
        terms=[Radiation("bar.left", 0.8, -ZERO_C)],
    )
    exact = T0 * (1 + 3 * 0.8 * SIGMA * area * T0**3 * step * np.arange(steps + 1) / C) ** (-1 / 3) - ZERO_C
    return np.abs(T.mean(1) - exact).max(), exact[0] - exact[-1]


def test_a_body_cools_by_radiation_alone():
    (coarse, _), (fine, fall) = cooled_by_radiation(80.0, 25), cooled_by_radiation(40.0, 50)
    assert fall > 300
    assert fine < 2e-4 * fall
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.3)
