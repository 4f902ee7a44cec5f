"""A small motor of nested rings on a polar grid, for the pictures' tests: no CAD, no mesher."""

import numpy as np

from geom.description.machine import Machine
from geom.description.part import Part
from geom.description.roles import Role, identity
from geom.description.shapes import disc, ring as annulus
from geom.meshing.mesh import NamedMesh

RADII = np.array([0.0, 0.03, 0.09, 0.115, 0.12, 0.155, 0.20, 0.22])
LEVELS = np.array([0.0, 0.05, 0.10, 0.14, 0.25, 0.38, 0.50, 0.54, 0.60, 0.65, 0.70])
PARTS = ("shaft", "rotor.core", "winding.armature", "winding.field", "yoke", "housing", "flange.left", "flange.right")
KNOWN = {
    "shaft": identity(Role.SHAFT),
    "rotor.core": identity(Role.ROTOR),
    "yoke": identity(Role.IRON),
    "winding.armature": identity(Role.WINDING, True),
    "winding.field": identity(Role.WINDING),
    "housing": identity(Role.HOUSING),
    "flange.left": identity(Role.END_SHIELD),
    "flange.right": identity(Role.END_SHIELD),
}


def _part(ring: int, level: int) -> int:
    """Index of the part of a cell, -1 for air."""
    if ring == 0:
        return 0
    if level in (1, 8):
        return (6 if level == 1 else 7) if ring < 7 else -1
    if not 1 < level < 8:
        return -1
    if ring in (5, 6):
        return 5 if ring == 6 else 4
    if 3 <= level <= 6:
        return {1: 1, 2: 2, 3: -1, 4: 3}[ring] if level < 6 or ring != 1 else 1
    return -1


def motor(segments: int = 32) -> NamedMesh:
    """About 2,000 points and 20,000 tets with 32 segments; z is the axis, lengths in m."""
    n, rings, levels = segments, len(RADII) - 1, len(LEVELS) - 1
    angle = 2 * np.pi * np.arange(n) / n
    plane = np.concatenate([[[0.0, 0.0]], *(np.stack([r * np.cos(angle), r * np.sin(angle)], 1) for r in RADII[1:])])
    points = np.concatenate([np.column_stack([plane, np.full(len(plane), z)]) for z in LEVELS])

    def at(r: int, k: int) -> int:
        return 0 if r == 0 else 1 + (r - 1) * n + k % n

    prisms, region = [], []
    for ring in range(rings):
        for k in range(n):
            a, b, c, d = at(ring, k), at(ring + 1, k), at(ring + 1, k + 1), at(ring, k + 1)
            for triangle in [(a, b, c)] + ([(a, c, d)] if ring else []):
                for level in range(levels):
                    if (part := _part(ring, level)) >= 0:
                        low = np.sort(triangle) + level * len(plane)
                        prisms.append([*low, *(low + len(plane))])
                        region.append(part)
    tets = np.array(prisms)[:, [[0, 1, 2, 5], [0, 1, 5, 4], [0, 4, 5, 3]]].reshape(-1, 4)
    e = points[tets[:, 1:]] - points[tets[:, :1]]
    swap = np.einsum("ij,ij->i", np.cross(e[:, 0], e[:, 1]), e[:, 2]) < 0
    tets[swap] = tets[swap][:, [0, 2, 1, 3]]
    used, tets = np.unique(tets, return_inverse=True)
    mesh = NamedMesh(points[used], tets.reshape(-1, 4).astype(np.int64), np.repeat(region, 3), PARTS, identities=KNOWN)
    return mesh


def machine() -> Machine:
    """What the mesh is of: round parts of one material, which nothing says more of."""
    prisms: dict[int, list] = {k: [] for k in range(len(PARTS))}
    for i in range(len(RADII) - 1):
        for level in range(len(LEVELS) - 1):
            if (part := _part(i, level)) >= 0:
                profile = annulus(RADII[i], RADII[i + 1]) if i else disc(RADII[1])
                prisms[part].append((profile, LEVELS[level], LEVELS[level + 1]))
    parts = tuple(Part(name, "steel", tuple(prisms[k])) for k, name in enumerate(PARTS))
    return Machine("small", "", "", parts, (), {}, None, {})
