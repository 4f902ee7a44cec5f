"""The generator's own finite elements against closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import diags
from scipy.sparse.linalg import spsolve

from geom.meshing.mesh import Contact, NamedMesh, Patch
from simulated.physics import conduction
from simulated.physics.conduction import Solid

CUBE = np.array([[0, 1, 3, 7], [0, 1, 7, 5], [0, 5, 7, 4], [0, 3, 2, 7], [0, 6, 4, 7], [0, 2, 6, 7]])


def bricks(axes, part_of, parts):
    """Points, tetrahedra and regions of a grid of bricks, each cut into six."""
    nx, ny, nz = (len(a) for a in axes)
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    i, j, k = (a.ravel() for a in np.meshgrid(range(nx - 1), range(ny - 1), range(nz - 1), indexing="ij"))
    corner = [((i + dx) * ny + j + dy) * nz + k + dz for dz in (0, 1) for dy in (0, 1) for dx in (0, 1)]
    tets = np.column_stack(corner)[:, CUBE].reshape(-1, 4)
    region = np.array([part_of(c) for c in points[tets].mean(axis=1)])
    return points, tets, region, tuple(parts)


def facets_at(points, tets, chosen):
    """Triangles whose corners are all chosen, each once."""
    faces = np.sort(
        np.concatenate([tets[:, [0, 1, 2]], tets[:, [0, 1, 3]], tets[:, [0, 2, 3]], tets[:, [1, 2, 3]]]), axis=1
    )
    return np.unique(faces[chosen[faces].all(axis=1)], axis=0)


def steady(body, films, heat):
    """films : face -> (h, fluid temperature)"""
    d, q = np.zeros(len(body.points)), heat.copy()
    for name, (h, T) in films.items():
        face = body.faces[name]
        np.add.at(d, face.nodes, h * face.areas)
        np.add.at(q, face.nodes, h * face.areas * T)
    return spsolve((body.stiffness + body.coupling + diags(d)).tocsc(), q)


@pytest.fixture(scope="module")
def wall():
    """A wall of 20 mm steel and 30 mm insulation, 0.1 m square, contact 500 W/m2/K."""
    x = np.linspace(0, 0.05, 11)
    points, tets, region, parts = bricks(
        (x, np.array([0, 0.1]), np.array([0, 0.1])), lambda c: int(c[0] > 0.02), ("a", "b")
    )
    patches = {
        "a.hot": Patch("a", "hot", facets_at(points, tets, points[:, 0] == 0)),
        "b.cold": Patch("b", "cold", facets_at(points, tets, points[:, 0] == x[-1])),
    }
    contact = Contact("a", "b", facets_at(points, tets, np.isclose(points[:, 0], 0.02)))
    mesh = NamedMesh(points, tets, region, parts, patches, {"a|b": contact})
    return conduction.build(mesh, {"a": Solid((50, 50), 3.7e6), "b": Solid((0.25, 0.25), 2e6)}, {"a|b": 500.0})


def test_composite_wall_with_contact(wall):
    T = steady(wall, {"a.hot": (1000.0, 100.0), "b.cold": (20.0, 10.0)}, np.zeros(len(wall.points)))
    flux = 90 / (1 / 1000 + 0.02 / 50 + 1 / 500 + 0.03 / 0.25 + 1 / 20)
    face = wall.faces["b.cold"]
    assert 20.0 * (face.areas @ (T[face.nodes] - 10.0)) == pytest.approx(flux * 0.01, rel=1e-9)


def test_conductivity_is_that_of_each_part_at_its_mean_temperature(wall):
    """The first part conducts a thousandth more per kelvin; contacts stay."""
    T = np.where(wall.part == 0, 120.0, 70.0)
    moved = replace(wall, slope=np.array([1e-3, 0.0])).conduction(T) - wall.coupling
    scale = np.where(wall.part == 0, 1.1, 1.0)
    assert np.abs(moved - diags(scale) @ wall.stiffness).max() < 1e-12 * np.abs(wall.stiffness).max()


def cylinder_error(n):
    # A quarter of a hollow cylinder, 20 to 60 mm, 50 mm long: a bent grid of bricks
    axes = (np.linspace(0.02, 0.06, n + 1), np.linspace(0, np.pi / 2, 2 * n + 1), np.linspace(0, 0.05, 3))
    points, tets, region, parts = bricks(axes, lambda c: 0, ("tube",))
    inner, outer = points[:, 0] == 0.02, np.isclose(points[:, 0], 0.06)
    patches = {
        "in": Patch("tube", "oil", facets_at(points, tets, inner)),
        "out": Patch("tube", "air", facets_at(points, tets, outer)),
    }
    r, angle, z = points.T
    bent = np.column_stack([r * np.cos(angle), r * np.sin(angle), z])
    body = conduction.build(
        NamedMesh(bent, tets, region, parts, patches), {"tube": Solid((2.0, 9.0), 1e6)}, {}, {"tube": 4}
    )
    T = steady(body, {"in": (200.0, 80.0), "out": (30.0, 20.0)}, np.zeros(len(body.points)))
    face = body.faces["in"]
    resistance = (
        1 / 200 / (2 * np.pi * 0.02 * 0.05) + np.log(3) / (2 * np.pi * 2 * 0.05) + 1 / 30 / (2 * np.pi * 0.06 * 0.05)
    )
    return abs(200.0 * (face.areas @ (80.0 - T[face.nodes])) * resistance / 60 - 1)


def test_hollow_cylinder_converges_at_second_order():
    errors = [cylinder_error(n) for n in (4, 8)]
    assert errors[1] < 2e-3
    assert errors[0] / errors[1] > 3.2


def test_joint_passes_heat_between_the_means():
    """Two blocks apart, joined by name: G = h A between the mean temperatures of the faces, and no heat is lost."""
    x = np.array([0.0, 0.01])
    points, tets, _, _ = bricks((x, x, x), lambda c: 0, ("a",))
    both = np.concatenate([points, points + np.array([0.1, 0, 0])])
    top = facets_at(points, tets, points[:, 0] == 0.01)
    bottom = facets_at(points, tets, points[:, 0] == 0.0) + len(points)
    mesh = NamedMesh(both, np.concatenate([tets, tets + len(points)]), np.repeat([0, 1], 6), ("a", "b"))
    solids = {"a": Solid((1, 1), 1e6), "b": Solid((1, 1), 1e6)}
    body = conduction.build(
        mesh, solids, {"a|b": 300.0}, joints={"a|b": (Patch("a", "b", top), Patch("b", "a", bottom))}
    )
    T = np.where(body.part == 0, 50.0, 20.0)
    heat = body.coupling @ T
    assert heat[body.part == 0].sum() == pytest.approx(300.0 * 1e-4 * 30.0)
    assert heat.sum() == pytest.approx(0.0, abs=1e-12)
