"""Quadratic elements against closed forms, against linear ones, and what both must keep."""

import numpy as np
import pytest

from fem.matrices.assembly import assemble
from fem.matrices.grids import box, ring
from fem.matrices.material import isotropic, laminated
from fem.solvers.solve import Solver, only_fixed, steady

K, Q, HOT, H = 0.8, 2e5, 20.0, 1e9


def slab(cells: int, quadratic: bool):
    """A heated slab of 20 mm, its two faces held at 20 degC: the rise in the middle is q L^2 / 8 k, its mean 2/3."""
    z = np.linspace(0.0, 0.02, cells + 1)
    side = np.linspace(0.0, 0.01, 3)

    def fluid(c):
        return np.where((c[:, 2] < 1e-9) | (c[:, 2] > 0.02 - 1e-9), "plate", "none").astype(object)

    mesh = box(side, side, z, lambda c: np.full(len(c), "slab", object), fluid)
    return assemble(mesh, {"slab": isotropic(K)}, {"slab": 2e6}, ["slab"] if quadratic else [])


def solved(field):
    films = {name: H if film.fluid == "plate" else 0.0 for name, film in field.films.items()}
    fluids = only_fixed(plate=HOT, none=HOT)
    return steady(Solver(field), films, {}, field.losses({"slab": Q * field.block("slab").volume}), fluids)


def test_both_kinds_converge_to_the_same_and_quadratic_ones_faster():
    exact = Q * 0.02**2 / (12 * K)
    off = {
        kind: [abs(f.mean("slab") @ solved(f).T - HOT - exact) for f in (slab(4, kind), slab(8, kind))]
        for kind in (True, False)
    }
    assert off[False][1] == pytest.approx(off[False][0] / 4, rel=0.1)
    assert off[True][1] < 0.05 * off[False][1]


@pytest.fixture(scope="module")
def both():
    r = np.linspace(0.02, 0.05, 5)
    mesh = ring(
        r,
        16,
        np.linspace(0.0, 0.06, 5),
        lambda c: np.full(len(c), "core", object),
        lambda c: np.full(len(c), "air", object),
    )
    made = [assemble(mesh, {"core": laminated(28.0, 3.0)}, {"core": 3e6}, kind) for kind in ([], ["core"])]
    return [field.block("core") for field in made]


def test_volume_heat_and_uniform_temperature_are_those_of_linear_elements(both):
    linear, quadratic = both
    one = np.ones(quadratic.n)
    assert quadratic.volume == pytest.approx(linear.volume, rel=1e-12)
    assert quadratic.M.sum() == pytest.approx(linear.M.sum(), rel=1e-12)
    assert np.abs(quadratic.K @ one).max() < 1e-12 * quadratic.K.diagonal().max()
    assert abs(quadratic.K - quadratic.K.T).max() < 1e-12 * quadratic.K.diagonal().max()


def test_a_field_linear_in_space_has_the_same_energy_mean_and_point_values(both):
    linear, quadratic = both
    slope = np.array([3.0, -2.0, 5.0])
    T, own = quadratic.xyz @ slope, linear.xyz @ slope
    energy = own @ linear.K @ own
    assert energy == pytest.approx(T @ quadratic.K @ T, rel=1e-10)
    assert quadratic.w @ T == pytest.approx(linear.w @ own, abs=1e-12)
    corner = np.array([0.1, 0.2, 0.3, 0.4])
    for block, values in ((linear, own), (quadratic, T)):
        nodes, weights = block.elements.row(7, corner)
        assert weights @ values[nodes] == pytest.approx(corner @ block.xyz[block.tets[7]] @ slope)


def test_heat_through_a_contact_balances_whichever_side_is_quadratic():
    """Two heated rings, the outer one cooled: what leaves the inner one is its own loss."""
    r = np.linspace(0.02, 0.06, 5)
    mesh = ring(
        r,
        12,
        np.linspace(0.0, 0.05, 4),
        lambda c: np.where(c[:, 0] < 0.04, "coil", "yoke").astype(object),
        lambda c: np.where(c[:, 0] > 0.05, "ambient", "air").astype(object),
    )
    k, capacity = {"coil": isotropic(0.5), "yoke": isotropic(30.0)}, {"coil": 2e6, "yoke": 3e6}
    found = []
    for kind in (["coil"], ["yoke"], ["coil", "yoke"], []):
        field = assemble(mesh, k, capacity, kind)
        films = {name: 50.0 if film.fluid == "ambient" else 0.0 for name, film in field.films.items()}
        load = field.losses({"coil": 30.0, "yoke": 5.0})
        T = steady(Solver(field), films, {"coil|yoke": 400.0}, load, only_fixed(ambient=20.0, air=20.0)).T
        touch = field.contacts["coil|yoke"]
        assert 400.0 * (touch.a.b @ T[touch.a.dofs] - touch.b.b @ T[touch.b.dofs]) == pytest.approx(30.0, rel=1e-9)
        found.append(field.mean("coil") @ T)
    assert found[0] == pytest.approx(found[2], abs=0.2)
    assert found[3] < found[0] - 0.5
