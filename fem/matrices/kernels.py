"""Compiled loops over simplices: volumes, conduction and mass, straight into compressed rows.

Cells are (m, k) point numbers, k = 3 for triangles and 4 for tetrahedra.
"""

from typing import Any

import numpy as np
from numba import njit

_OPTIONS: dict[str, Any] = {"cache": True, "error_model": "numpy"}


@njit(**_OPTIONS)
def _add(indptr, indices, data, i, j, value):  # type: ignore[no-untyped-def]
    p = indptr[i]
    while indices[p] != j:
        p += 1
    data[p] += value


@njit(**_OPTIONS)
def volumes(xyz, tets):  # type: ignore[no-untyped-def]
    """(m,) m3"""
    out, grad = np.empty(len(tets)), np.empty((4, 3))
    for e in range(len(tets)):
        out[e] = _gradients(xyz, tets[e], grad)
    return out


@njit(**_OPTIONS)
def conduction(xyz, tets, cells, k, reference, indptr, indices, data):  # type: ignore[no-untyped-def]
    """Adds Int grad N_i . k grad N_j, k (m, 3, 3) constant in a tetrahedron; reference : of elements._reference."""
    n, grad, local = cells.shape[1], np.empty((4, 3)), np.empty(reference.shape[1])
    for e in range(len(tets)):
        _local_conduction(xyz, tets[e], k[e], reference, grad, local)
        for a in range(n):
            for b in range(n):
                _add(indptr, indices, data, cells[e, a], cells[e, b], local[a * n + b])


@njit(**_OPTIONS)
def mass(cells, sizes, reference, indptr, indices, data):  # type: ignore[no-untyped-def]
    """Adds Int N_i N_j for sizes (m,), volumes or areas, times whatever is to be integrated; reference : of size 1."""
    for e in range(len(cells)):
        for a in range(cells.shape[1]):
            for b in range(cells.shape[1]):
                _add(indptr, indices, data, cells[e, a], cells[e, b], sizes[e] * reference[a, b])


@njit(**_OPTIONS)
def _local_conduction(xyz, tet, k, reference, grad, out):  # type: ignore[no-untyped-def]
    """Into out (n * n,): the reference's share of grad_a . k grad_b for every pair of corners."""
    volume = _gradients(xyz, tet, grad)
    out[:] = 0.0
    for a in range(4):
        x = k[0, 0] * grad[a, 0] + k[0, 1] * grad[a, 1] + k[0, 2] * grad[a, 2]
        y = k[1, 0] * grad[a, 0] + k[1, 1] * grad[a, 1] + k[1, 2] * grad[a, 2]
        z = k[2, 0] * grad[a, 0] + k[2, 1] * grad[a, 1] + k[2, 2] * grad[a, 2]
        for b in range(4):
            along = volume * (x * grad[b, 0] + y * grad[b, 1] + z * grad[b, 2])
            for i in range(len(out)):
                out[i] += along * reference[4 * a + b, i]


@njit(**_OPTIONS)
def _gradients(xyz, tet, grad):  # type: ignore[no-untyped-def]
    """Gradients of the four hat functions into grad (4, 3); the volume."""
    a, b, c = _edge(xyz, tet, 1), _edge(xyz, tet, 2), _edge(xyz, tet, 3)
    n = _cross(b, c)
    det = a[0] * n[0] + a[1] * n[1] + a[2] * n[2]
    p, q = _cross(c, a), _cross(a, b)
    for i in range(3):
        grad[1, i], grad[2, i], grad[3, i] = n[i] / det, p[i] / det, q[i] / det
        grad[0, i] = -grad[1, i] - grad[2, i] - grad[3, i]
    return abs(det) / 6


@njit(**_OPTIONS)
def _edge(xyz, tet, i):  # type: ignore[no-untyped-def]
    o, p = tet[0], tet[i]
    return xyz[p, 0] - xyz[o, 0], xyz[p, 1] - xyz[o, 1], xyz[p, 2] - xyz[o, 2]


@njit(**_OPTIONS)
def _cross(a, b):  # type: ignore[no-untyped-def]
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
