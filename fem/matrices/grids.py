"""Structured meshes of boxes and rings with named parts: problems whose answer is known, and small examples."""

from collections.abc import Callable
from itertools import permutations

import numpy as np
from numpy.typing import NDArray

from geom.arrays import Array as Floats, Ints
from geom.meshing.mesh import Contact, NamedMesh, Patch

Naming = Callable[[Floats], NDArray[np.str_]]

FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])


def box(x: Floats, y: Floats, z: Floats, part: Naming, fluid: Naming) -> NamedMesh:
    """Grid of boxes. `part` names cells, `fluid` outer facets, by their centres (n, 3) (m); part "" is a hole."""
    points = np.stack(np.meshgrid(x, y, z, indexing="ij"), -1).reshape(-1, 3)
    number = np.arange(len(points)).reshape(len(x), len(y), len(z))
    return named(points, _tets(number), part, fluid)


def ring(r: Floats, n_theta: int, z: Floats, part: Naming, fluid: Naming) -> NamedMesh:
    """Full rings about z, `n_theta` cells around; names are given by centres in (r, theta, z)."""
    theta = np.arange(n_theta) * 2 * np.pi / n_theta
    R, T, Z = np.meshgrid(r, theta, z, indexing="ij")
    number = np.arange(R.size).reshape(R.shape)
    wrapped = np.concatenate([number, number[:, :1]], 1)
    points = np.stack([R * np.cos(T), R * np.sin(T), Z], -1).reshape(-1, 3)
    return named(points, _tets(wrapped), lambda c: part(cylinder(c)), lambda c: fluid(cylinder(c)))


def sector(r: Floats, theta: Floats, z: Floats, part: Naming, fluid: Naming) -> NamedMesh:
    """A piece of a ring between theta[0] and theta[-1] (rad); names are given by centres in (r, theta, z)."""
    R, T, Z = np.meshgrid(r, theta, z, indexing="ij")
    points = np.stack([R * np.cos(T), R * np.sin(T), Z], -1).reshape(-1, 3)
    tets = _tets(np.arange(R.size).reshape(R.shape))
    return named(points, tets, lambda c: part(cylinder(c)), lambda c: fluid(cylinder(c)))


def cylinder(x: Floats) -> Floats:
    """(r, theta, z) of points (n, 3); theta from -pi to pi."""
    return np.stack([np.hypot(x[:, 0], x[:, 1]), np.arctan2(x[:, 1], x[:, 0]), x[:, 2]], -1)


def _tets(number: Ints) -> Ints:
    """Six Kuhn tetrahedra per cell of a grid of point numbers: the same diagonals everywhere, so they conform."""
    n = np.array(number.shape) - 1
    corner = lambda o: number[o[0] : o[0] + n[0], o[1] : o[1] + n[1], o[2] : o[2] + n[2]].ravel()  # noqa: E731
    out = []
    for order in permutations(range(3)):
        steps = np.zeros((4, 3), int)
        for k, axis in enumerate(order):
            steps[k + 1 :, axis] += 1
        out.append(np.stack([corner(s) for s in steps], -1))
    return np.concatenate(out)


def named(points: Floats, tets: Ints, part: Naming, fluid: Naming) -> NamedMesh:
    """Name the regions, outer faces and contacts of a tetrahedral mesh."""
    names = np.asarray(part(points[tets].mean(1)))
    tets, names = tets[names != ""], names[names != ""]
    negative = np.linalg.det(points[tets[:, 1:]] - points[tets[:, :1]]) < 0
    tets = np.where(negative[:, None], tets[:, [0, 1, 3, 2]], tets)
    parts, region = np.unique(names, return_inverse=True)
    faces = np.sort(tets[:, FACES], -1).reshape(-1, 3)
    # One number per face: sorting rows would take ten times as long. Good for two million points.
    key = (faces[:, 0] * len(points) + faces[:, 1]) * len(points) + faces[:, 2]
    _, first, inverse, count = np.unique(key, return_index=True, return_inverse=True, return_counts=True)
    unique = faces[first]
    owner = np.repeat(region, 4)
    second = np.zeros(len(unique), int)
    second[inverse] = owner  # the last one written stays
    patches = _patches(points, unique[count == 1], parts[owner[first[count == 1]]], fluid)
    common = (count == 2) & (owner[first] != second)
    contacts = _contacts(unique[common], parts, owner[first[common]], second[common])
    return NamedMesh(points, tets, region, tuple(map(str, parts)), patches, contacts)


def _patches(points: Floats, facets: Ints, owner: NDArray[np.str_], fluid: Naming) -> dict[str, Patch]:
    fluids = np.asarray(fluid(points[facets].mean(1)))
    out = {}
    for p, f in sorted({(str(p), str(f)) for p, f in zip(owner, fluids, strict=True) if f}):
        out[f"{p}.{'outer' if f == 'ambient' else f}"] = Patch(p, f, facets[(owner == p) & (fluids == f)])
    return out


def _contacts(facets: Ints, parts: NDArray[np.str_], one: Ints, two: Ints) -> dict[str, Contact]:
    low, high = np.minimum(one, two), np.maximum(one, two)
    out = {}
    for i, j in sorted(set(zip(low.tolist(), high.tolist(), strict=True))):
        a, b = str(parts[i]), str(parts[j])
        out[f"{a}|{b}"] = Contact(a, b, facets[(low == i) & (high == j)])
    return out
