"""Transient conduction against the series solution of a cooling slab, and its order in time."""

from dataclasses import replace

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


def test_heat_given_is_heat_stored_and_shed(slab):
    """Energy lost by the slab equals the film's heat integrated over time, to the order of the trapezium rule."""
    field, step = slab.field, 5.0
    T = cooled(slab, step, 200)
    stored = (T[0] - T[-1]) @ field.M.sum(0)
    trace = field.films["slab.outer"].trace
    shed = h * T[:, trace.dofs] @ trace.b
    assert stored == pytest.approx(np.trapezoid(shed, dx=step), rel=2e-3)


def ball_series(r, t):
    """Carslaw and Jaeger 1959, 9.4: 4 (sin z - z cos z) / (2 z - sin 2 z) exp(-z^2 Fo) sin(z r / L) / (z r / L)."""
    Bi, Fo = h * L / k, k / rho_cp * t / L**2
    condition = lambda z: z * np.cos(z) - (1 - Bi) * np.sin(z)  # noqa: E731
    roots = [brentq(condition, (n + 0.5 - 0.5 * (Bi < 1)) * np.pi, (n + 1) * np.pi - 1e-9) for n in range(40)]
    at = np.maximum(r, 1e-9) / L
    shape = [4 * (np.sin(z) - z * np.cos(z)) / (2 * z - np.sin(2 * z)) * np.exp(-z * z * Fo) for z in roots]
    return 100 * sum(a * np.sin(z * at) / (z * at) for a, z in zip(shape, roots, strict=True))


def off_the_ball(n):
    """Rms error by volume (K) of a ball that cools from 100 K, Bi = 2, worst of Fo = 0.1 ... 0.6."""
    # A ball of n cells from the centre to the skin: a box whose cubic shells become spheres
    x = np.linspace(-1.0, 1.0, 2 * n + 1)
    cube = box(x, x, x, lambda c: np.full(len(c), "ball", object), lambda c: np.full(len(c), "ambient", object))
    shell = np.abs(cube.points).max(1)
    length = np.linalg.norm(cube.points, axis=1)
    radius = L * shell[:, None] * cube.points / np.where(length > 0, length, 1.0)[:, None]
    field = assemble(replace(cube, points=radius), {"ball": isotropic(k)}, {"ball": rho_cp})
    step = 0.05 * L**2 * rho_cp / k
    T = transient(
        Solver(field),
        {"ball.outer": h},
        {},
        np.zeros(field.n),
        only_fixed(ambient=0.0),
        np.full(field.n, 100.0),
        step / 8,
        96,
    )
    r = np.linalg.norm(field.xyz, axis=1)
    w = field.mean("ball")
    return max(np.sqrt(w @ (T[m] - ball_series(r, m * step / 8)) ** 2) for m in range(16, 97, 16))


def test_ball_cools_along_its_series_and_converges():
    coarse, fine = off_the_ball(4), off_the_ball(8)
    assert fine < 0.3
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.3)
