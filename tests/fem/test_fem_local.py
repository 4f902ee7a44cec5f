"""Parts solved for alone: what they must agree with, and what they are good for."""

import numpy as np
import pytest

from fem.matrices.assembly import assemble
from fem.matrices.grids import ring
from fem.matrices.material import isotropic, laminated
from fem.solvers.local import local_solutions, of_unit_energy
from fem.solvers.solve import Solver

CONTACTS = {"core|yoke": 500.0}


@pytest.fixture(scope="module")
def field():
    r = np.concatenate([np.linspace(0.02, 0.05, 5), np.linspace(0.05, 0.07, 4)[1:]])
    mesh = ring(
        r,
        24,
        np.linspace(0.0, 0.12, 9),
        lambda c: np.where(c[:, 0] < 0.05, "core", "yoke").astype(object),
        lambda c: np.where(c[:, 0] > 0.069, "ambient", "air").astype(object),
    )
    return assemble(mesh, {"core": laminated(28.0, 3.0), "yoke": isotropic(40.0)}, {"core": 3.6e6, "yoke": 3.7e6})


@pytest.fixture(scope="module")
def films(field):
    return dict.fromkeys(field.films, 40.0)


def test_between_neighbours_of_a_solution_a_part_without_loss_is_that_solution(field, films):
    K = field.stiffness(films, CONTACTS)
    T = Solver(field).factor(K)(field.load("core"))[:, None]
    found = local_solutions(field, T, np.zeros((field.n, 0)), [(films, CONTACTS)], 1, np.random.default_rng(0))["yoke"]
    drawn_factor = np.random.default_rng(0).standard_normal()
    assert found[:, 0] == pytest.approx(drawn_factor * T[field.block("yoke").dofs, 0], rel=1e-9)


def test_every_field_of_own_loads_has_unit_energy(field, films):
    K = field.stiffness(films, CONTACTS)
    S = of_unit_energy(Solver(field).factor(K)(np.column_stack([field.load("core"), field.load("yoke")])), K)
    loads = np.column_stack([field.load("core"), field.load("yoke")])
    found = local_solutions(field, S, loads, [(films, CONTACTS)], 3, np.random.default_rng(0))["yoke"][:, 3:]
    dofs = field.block("yoke").dofs
    faces = [face for face, film in field.films.items() if film.trace.part == "yoke"]
    assert found.shape[1] == 1 + len(faces)
    assert np.einsum("ij,ij->j", found, K[dofs][:, dofs] @ found) == pytest.approx(1.0, rel=1e-9)
