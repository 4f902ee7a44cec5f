"""Middles of some edges only: against the field that has all of them, and on a mesh where they were not found."""

import numpy as np
import pytest

from fem.matrices.assembly import assemble
from fem.matrices.bends import Bends
from fem.matrices.grids import box
from fem.matrices.material import isotropic
from fem.solvers.bending_edges import linear_losses
from fem.solvers.solve import Solver, only_fixed, steady

K, Q, HOT, H = 0.8, 2e5, 20.0, 1e9
EVERY = Bends.everywhere(["slab"])


def slab(cells, bends):
    """Of 20 mm, heated, its two faces at 20 degC: the temperature bends along z alone."""
    side, z = np.linspace(0.0, 0.01, cells + 1), np.linspace(0.0, 0.02, cells + 1)

    def fluid(c):
        return np.where((c[:, 2] < 1e-9) | (c[:, 2] > 0.02 - 1e-9), "plate", "none").astype(object)

    mesh = box(side, side, z, lambda c: np.full(len(c), "slab", object), fluid)
    return assemble(mesh, {"slab": isotropic(K)}, {"slab": 2e6}, bends=bends)


def mean(field):
    films = {name: H if film.fluid == "plate" else 0.0 for name, film in field.films.items()}
    load = field.losses({"slab": Q * field.block("slab").volume})
    return field.mean("slab") @ steady(Solver(field), films, {}, load, only_fixed(plate=HOT, none=HOT)).T


def along(kind):
    """Bends of the edges of a slab of two cells: those along the axis or those in its plane."""
    edges = slab(2, EVERY).block("slab").bending
    return Bends({"slab": np.column_stack([edges, edges[:, 3] == kind])})


@pytest.mark.parametrize("cells", [2, 4])
def test_middles_along_the_heat_do_what_all_of_them_do(cells):
    """Found on two cells, they serve on four."""
    few, every, bare = slab(cells, along(0.0)), slab(cells, EVERY), slab(cells, None)
    assert mean(few) == pytest.approx(mean(every), abs=1e-9)
    assert few.n - bare.n == cells * (cells + 1) ** 2 < 0.4 * (every.n - bare.n)


def test_middles_across_the_heat_do_nothing():
    """Nothing bends there; films of 1e9 W/m2/K let the skin move by less than 1e-6 K."""
    assert mean(slab(2, along(1.0))) == pytest.approx(mean(slab(2, None)), abs=1e-6)


def test_a_straight_edge_loses_nothing_where_the_heat_goes_across_it():
    field = slab(2, EVERY)
    z = field.block("slab").xyz[:, 2] / 0.02
    lost = linear_losses(field, field.block("slab").K, z**2, z[:, None] ** 2)[len(field.block("slab").points) :, 0]
    level = field.block("slab").bending[:, 3] > 0.0
    assert abs(lost[level]).max() < 1e-12 < abs(lost[~level]).min()
