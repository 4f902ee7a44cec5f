"""Steady conduction against closed forms, published benchmarks and convergence rates."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve
from skfem import Basis, BilinearForm, ElementTetP1, MeshTet
from skfem.helpers import dot, grad

from fem.matrices.assembly import assemble
from fem.matrices.grids import box, cylinder, ring
from fem.matrices.material import Conductivity, isotropic, laminated
from fem.solvers.multifrontal import analyse, factorise
from fem.solvers.solve import Fluids, Iterative, Solver, only_fixed, steady
from geom.errors import InputError


def named(centres, *choices, default=""):
    """Names by conditions on centres."""
    out = np.full(len(centres), default, dtype=object)
    for condition, name in choices:
        out[condition] = name
    return out


def cube(n):
    x = np.linspace(0.0, 1.0, n + 1)
    return box(x, x, x, lambda c: named(c, default="cube"), lambda c: named(c))


def test_heated_hollow_cylinder():
    """Uniform heat, adiabatic bore, film outside: T(r) by integrating -k r T' = q (r^2 - ri^2) / 2."""
    ri, ro, k, q, h = 0.03, 0.06, 20.0, 4e5, 100.0
    r, z = np.linspace(ri, ro, 13), np.array([0.0, 0.01])
    mesh = ring(r, 144, z, lambda c: named(c, default="iron"), lambda c: named(c, (c[:, 0] > ro - 1e-4, "ambient")))
    field = assemble(mesh, {"iron": isotropic(k)}, {"iron": 3.6e6})
    volume = np.pi * (ro**2 - ri**2) * 0.01
    found = steady(Solver(field), {"iron.outer": h}, {}, q * volume * field.load("iron"), only_fixed(ambient=20.0))
    radius = np.hypot(*field.xyz[:, :2].T)
    surface = 20.0 + q * (ro**2 - ri**2) / (2 * h * ro)
    exact = surface + q / (4 * k) * (ro**2 - radius**2) - q * ri**2 / (2 * k) * np.log(ro / radius)
    assert np.abs(found.T - exact).max() < 1e-3 * (exact.max() - 20.0)


def test_composite_wall_with_contact_is_exact():
    """Piecewise linear with a jump at the contact: in the P1 space, so right to rounding."""
    x = np.linspace(0.0, 0.1, 6)
    y = np.linspace(0.0, 0.02, 3)
    mesh = box(
        x,
        y,
        y,
        lambda c: named(c, (c[:, 0] < 0.04, "a"), default="b"),
        lambda c: named(c, (c[:, 0] < 1e-9, "hot"), (c[:, 0] > 0.1 - 1e-9, "cold")),
    )
    field = assemble(mesh, {"a": isotropic(2.0), "b": isotropic(0.5)}, {"a": 1e6, "b": 1e6})
    found = steady(
        Solver(field),
        {"a.hot": 50.0, "b.cold": 10.0},
        {"a|b": 200.0},
        np.zeros(field.n),
        only_fixed(hot=100.0, cold=0.0),
    )
    flux = 100.0 / (1 / 50 + 0.04 / 2 + 1 / 200 + 0.06 / 0.5 + 1 / 10)
    a, b = field.blocks["a"], field.blocks["b"]
    assert found.T[a.dofs] == pytest.approx(100 - flux / 50 - flux * a.xyz[:, 0] / 2.0, abs=1e-9)
    assert found.T[b.dofs] == pytest.approx(flux / 10 + flux * (0.1 - b.xyz[:, 0]) / 0.5, abs=1e-9)


def errors_of_cosine(n):
    """L2 and H1 errors for T = cos(pi x) cos(pi y) cos(pi z), a solution of -div grad T + T = (3 pi^2 + 1) T."""
    field = assemble(cube(n), {"cube": isotropic(1.0)}, {"cube": 1.0})
    block = field.blocks["cube"]
    exact = np.cos(np.pi * block.xyz).prod(1)
    u = spsolve(sp.csc_array(block.K + block.M), (3 * np.pi**2 + 1) * (block.M @ exact))
    basis = Basis(MeshTet(block.xyz.T.copy(), block.tets.T.astype(np.int64)), ElementTetP1(), intorder=4)
    x, uh = basis.global_coordinates().value, basis.interpolate(u)
    c, s = np.cos(np.pi * x), np.sin(np.pi * x)
    slope = -np.pi * np.stack([s[0] * c[1] * c[2], c[0] * s[1] * c[2], c[0] * c[1] * s[2]])
    L2 = np.sqrt(((uh - c.prod(0)) ** 2 * basis.dx).sum())
    H1 = np.sqrt((((uh.grad - slope) ** 2).sum(0) * basis.dx).sum())
    return L2, H1


def test_convergence_rates():
    coarse, fine = errors_of_cosine(8), errors_of_cosine(16)
    rate = np.log2(np.array(coarse) / np.array(fine))
    assert rate == pytest.approx([2.0, 1.0], abs=0.15)


def orthotropic_error(n):
    """r^m cos(theta), m = sqrt(k_theta / k_r), solves conduction in an annulus; given on both circles."""
    k, r = Conductivity(2.0, 18.0, 5.0), np.linspace(0.5, 1.0, n + 1)
    mesh = ring(r, 12 * n, np.array([0.0, 0.1]), lambda c: named(c, default="ring"), lambda c: named(c))
    block = assemble(mesh, {"ring": k}, {"ring": 1.0}).blocks["ring"]
    x = cylinder(block.xyz)
    exact = x[:, 0] ** 3 * np.cos(x[:, 1])
    given = (x[:, 0] < 0.5 + 1e-9) | (x[:, 0] > 1.0 - 1e-9)
    K = sp.csr_array(block.K)
    inner = spsolve(sp.csc_array(K[~given][:, ~given]), -K[~given][:, given] @ exact[given])
    return np.sqrt(np.mean((inner - exact[~given]) ** 2))


def test_orthotropic_annulus_converges_to_closed_form():
    coarse, fine = orthotropic_error(4), orthotropic_error(8)
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.35)
    assert fine < 2e-3


def nafems_t4(n):
    x, y = np.linspace(0.0, 0.6, 3 * n + 1), np.linspace(0.0, 1.0, 5 * n + 1)
    mesh = box(
        x,
        y,
        np.array([0.0, 0.02]),
        lambda c: named(c, default="plate"),
        lambda c: named(c, (c[:, 1] < 1e-9, "base"), (c[:, 0] > 0.6 - 1e-9, "air"), (c[:, 1] > 1 - 1e-9, "air")),
    )
    field = assemble(mesh, {"plate": isotropic(52.0)}, {"plate": 1.0})
    given = only_fixed(base=100.0, air=0.0)
    found = steady(Solver(field), {"plate.base": 1e9, "plate.air": 750.0}, {}, np.zeros(field.n), given)
    at = np.hypot(field.xyz[:, 0] - 0.6, field.xyz[:, 1] - 0.2) < 1e-6
    return float(found.T[at].mean())


def test_nafems_t4_plate_with_convection():
    """NAFEMS T4: 18.25 degC on the right edge at 0.2 m; the corner below is singular."""
    values = [nafems_t4(n) for n in (4, 8, 16)]
    assert abs(values[2] - 18.25) < abs(values[0] - 18.25)
    assert values[2] == pytest.approx(18.25, abs=0.1)


def test_stiffness_is_what_scikit_fem_assembles():
    k = Conductivity(3.0, 7.0, 0.4)
    mesh = ring(np.linspace(1, 2, 4), 12, np.linspace(0, 1, 4), lambda c: named(c, default="p"), named)
    block = assemble(mesh, {"p": k}, {"p": 2.0}).blocks["p"]

    @BilinearForm
    def conduction(u, v, w):
        K = np.moveaxis(k.tensor(np.moveaxis(w.x, 0, -1).reshape(-1, 3)).reshape(*w.x.shape[1:], 3, 3), (2, 3), (0, 1))
        return dot(np.einsum("ij...,j...->i...", K, grad(u)), grad(v))

    basis = Basis(MeshTet(block.xyz.T.copy(), block.tets.T.astype(np.int64)), ElementTetP1(), intorder=0)
    assert abs(conduction.assemble(basis) - block.K).max() < 1e-12


def test_losses_inject_exactly_their_watts():
    field = assemble(cube(3), {"cube": isotropic(1.0)}, {"cube": 1.0})
    assert field.load("cube", lambda x: x[:, 0] ** 2).sum() == pytest.approx(1.0, abs=1e-15)


def two_rings(contact_gap=0.03):
    r = np.concatenate([np.linspace(0.02, contact_gap, 3), np.linspace(contact_gap, 0.05, 4)[1:]])
    return ring(
        r,
        24,
        np.linspace(0, 0.1, 5),
        lambda c: named(c, (c[:, 0] < contact_gap, "core"), default="yoke"),
        lambda c: named(c, (c[:, 0] > 0.049, "ambient"), (c[:, 0] < 0.0205, "bore"), default="air"),
    )


def rings():
    return assemble(two_rings(), {"core": laminated(28, 3), "yoke": isotropic(40)}, {"core": 3.6e6, "yoke": 3.6e6})


def test_energy_balance_with_air_that_is_carried_through():
    """Air enters one node at 10 degC, flows to the next and out; films and stream carry what goes in."""
    field = rings()
    films = {face: 40.0 for face in field.films}
    mcp = 5.0
    fluids = Fluids(
        ("bore", "air"), np.array([[mcp, 0.0], [-mcp, mcp]]), np.array([mcp * 10.0, 0.0]), {"ambient": 20.0}
    )
    load = 300.0 * field.load("core") + 50.0 * field.load("yoke")
    found = steady(Solver(field), films, {"core|yoke": 800.0}, load, fluids)
    shed = sum(40.0 * f.trace.b @ (found.T[f.trace.dofs] - 20.0) for f in field.films.values() if f.fluid == "ambient")
    assert shed + mcp * (found.u[1] - 10.0) == pytest.approx(350.0, rel=1e-9)
    assert found.energy_balance < 1e-9


def test_iterative_and_direct_agree():
    field = rings()
    films, load = dict.fromkeys(field.films, 30.0), 100.0 * field.load("core")
    given = only_fixed(ambient=20.0, bore=30.0, air=10.0)
    direct, iterative = (steady(s(field), films, {"core|yoke": 300.0}, load, given) for s in (Solver, Iterative))
    assert np.abs(iterative.T - direct.T).max() < 1e-7
    assert iterative.energy_balance < 1e-9


def test_matrix_is_symmetric_positive_definite():
    field = rings()
    K = field.stiffness(dict.fromkeys(field.films, 5.0), {"core|yoke": 100.0})
    assert abs(K - K.T).max() < 1e-14
    assert np.linalg.eigvalsh(K.toarray()).min() > 0


def test_multifrontal_solves_what_was_asked():
    field = rings()
    K = field.stiffness(dict.fromkeys(field.films, 5.0), {"core|yoke": 100.0})
    x = np.random.default_rng(3).normal(size=(field.n, 7))
    assert factorise(K, analyse(K, field.xyz))(K @ x) == pytest.approx(x, abs=1e-9)


def test_a_part_that_hangs_in_the_air_is_refused():
    field = assemble(cube(4), {"cube": isotropic(1.0)}, {"cube": 1.0})
    with pytest.raises(InputError, match="nothing takes heat from cube"):
        steady(Solver(field), {}, {}, field.load("cube"), only_fixed())


def test_missing_conductivity_is_named():
    with pytest.raises(InputError, match="no conductivity for yoke"):
        assemble(two_rings(), {"core": isotropic(1.0)}, {"core": 1.0, "yoke": 1.0})
