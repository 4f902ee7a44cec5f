"""Bars whose answer is published or in closed form: NAFEMS T3, a fin, a prescribed flux."""

import numpy as np
import pytest
from named_grids import bar

from fem.matrices.assembly import assemble
from fem.matrices.material import isotropic
from fem.solvers.newton import transient
from fem.solvers.solve import Solver, only_fixed, steady

GIVEN = 1e9  # stands for a given wall temperature, W/m2/K


def nafems_t3(n):
    """Temperature (degC) at 0.08 m after 32 s on 5 n cells, with steps that shrink with the cells."""
    field = assemble(bar(0.1, 5 * n), {"bar": isotropic(35.0)}, {"bar": 7200.0 * 440.5})
    films, ends = {"bar.left": GIVEN, "bar.right": GIVEN}, only_fixed(left=0.0, right=0.0)
    steps = 8 * n
    T = transient(
        Solver(field),
        films,
        {},
        np.zeros(field.n),
        ends,
        np.zeros(field.n),
        32.0 / steps,
        steps,
        drive=lambda t: (1.0, {"left": 0.0, "right": 100 * np.sin(np.pi * t / 40)}),
    )
    return float(T[-1][np.abs(field.xyz[:, 0] - 0.08) < 1e-9].mean())


def test_nafems_t3_bar_with_a_sine_at_its_end():
    """NAFEMS T3: 36.60 degC; errors fall with the mesh at second order."""
    values = np.array([nafems_t3(n) for n in (2, 4, 8)])
    coarse, fine = np.diff(values)
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.3)
    assert values[-1] == pytest.approx(36.60, abs=0.06)
    assert values[-1] + fine / 3 == pytest.approx(36.60, abs=0.01)


def test_fin():
    """Slender bar in air, hot at its root: P = k A m (T_root - T_air) tanh(m L), m^2 = h U / (k A); Bi = 1e-3."""
    L, width, k, h = 0.1, 0.005, 200.0, 40.0
    field = assemble(bar(L, 60, width, 2, sides="air"), {"bar": isotropic(k)}, {"bar": 1.0})
    films = {"bar.left": GIVEN, "bar.right": 0.0, "bar.air": h}
    found = steady(Solver(field), films, {}, np.zeros(field.n), only_fixed(left=100.0, right=0.0, air=20.0))
    m = np.sqrt(h * 4 * width / (k * width**2))
    exact = 20 + 80 * np.cosh(m * (L - field.xyz[:, 0])) / np.cosh(m * L)
    assert np.abs(found.T - exact).max() < 2e-3 * 80
    trace = field.films["bar.air"].trace
    shed = h * float(trace.b @ found.T[trace.dofs] - 20 * trace.area)
    assert shed == pytest.approx(k * width**2 * m * 80 * np.tanh(m * L), rel=1e-3)


def test_prescribed_flux():
    """100 W/m2 in at one end: a linear profile, in the P1 space."""
    field = assemble(bar(0.2, 7, 0.01), {"bar": isotropic(4.0)}, {"bar": 1.0})
    load = 100.0 * field.films["bar.left"].trace.area * field.flux("bar.left")
    found = steady(Solver(field), {"bar.left": 0.0, "bar.right": 50.0}, {}, load, only_fixed(left=0.0, right=10.0))
    exact = 10 + 100 / 50 + 100 * (0.2 - field.xyz[:, 0]) / 4.0
    assert np.abs(found.T - exact).max() < 1e-9
