"""Transient conduction against the series solution of a cooling slab, and its order in time."""

import numpy as np
import pytest
from scipy.optimize import brentq

from fem.matrices.assembly import assemble
from fem.matrices.grids import box
from fem.matrices.material import isotropic
from fem.solvers.newton import transient
from fem.solvers.solve import Solver, only_fixed

L, k, rho_cp, h = 0.05, 2.0, 2e6, 80.0  # Bi = 2


@pytest.fixture(scope="module")
def slab():
    x, y = np.linspace(0.0, L, 33), np.array([0.0, L / 32])
    name = lambda c: np.full(len(c), "slab", dtype=object)  # noqa: E731
    washed = lambda c: np.where(c[:, 0] > L - 1e-9, "ambient", "").astype(object)  # noqa: E731
    return Solver(assemble(box(x, y, y, name, washed), {"slab": isotropic(k)}, {"slab": rho_cp}))


def cooled(slab, step, steps):
    field = slab.field
    return transient(
        slab, {"slab.outer": h}, {}, np.zeros(field.n), only_fixed(ambient=0.0), np.full(field.n, 100.0), step, steps
    )


def series(x, t):
    """Carslaw and Jaeger 1959, 3.11: sum of 4 sin z / (2 z + sin 2 z) exp(-z^2 Fo) cos(z x / L), z tan z = Bi."""
    Bi, Fo = h * L / k, k / rho_cp * t / L**2
    condition = lambda z: z * np.sin(z) - Bi * np.cos(z)  # noqa: E731
    roots = [brentq(condition, n * np.pi + 1e-9, n * np.pi + np.pi / 2) for n in range(30)]
    return 100 * sum(4 * np.sin(z) / (2 * z + np.sin(2 * z)) * np.exp(-(z**2) * Fo) * np.cos(z * x / L) for z in roots)


def test_slab_cools_along_its_series(slab):
    T = cooled(slab, 10.0, 120)
    x = slab.field.xyz[:, 0]
    for step in (12, 60, 120):
        assert np.abs(T[step] - series(x, 10.0 * step)).max() < 0.1


def test_second_order_in_time(slab):
    end = [cooled(slab, 400.0 / n, n)[-1] for n in (4, 8, 64)]
    coarse, fine = (np.abs(e - end[2]).max() for e in end[:2])
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.4)
