"""From the conformal mesh to one whose parts own their nodes: temperatures jump where a contact resists."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from geom.arrays import Array, Ints, Mask
from geom.description.roles import Identity, Role
from geom.errors import InputError
from geom.meshing.mesh import NamedMesh

FACES = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))  # of a tetrahedron, seen from outside


@dataclass(frozen=True)
class SplitMesh:
    """A mesh in which no two parts share a node; parts follow one another, each with its points in rising order.

    points : (n_nodes, 3) m;  tets : (n_tets, 4);  region : (n_tets,);  parts : names
    original : (n_nodes,) point number in the conformal mesh
    owner : (n_nodes,) index of the part that owns the node
    identities : what the parts are, where it is declared
    """

    points: Array
    tets: Ints
    region: Ints
    parts: tuple[str, ...]
    original: Ints
    owner: Ints
    identities: Mapping[str, Identity] = field(default_factory=dict)

    @property
    def size(self) -> int:
        return len(self.points)

    @property
    def bases(self) -> tuple[str, ...]:
        """What the machine stands on, which may be much longer than the machine."""
        return tuple(part for part in self.parts if self.identities.get(part, Identity()).role is Role.BASE)

    @property
    def length(self) -> float:
        """From end to end of the machine along its axis, without its bases (m)."""
        others = [self.of(part) for part in self.parts if part not in self.bases]
        return float(np.ptp(self.points[np.concatenate(others) if others else slice(None), 2]))

    def of(self, part: str) -> Ints:
        """Numbers of the nodes of one part."""
        if part not in self.parts:
            raise InputError(f"unknown part '{part}'", "mesh", f"known: {', '.join(self.parts)}")
        return np.flatnonzero(self.owner == self.parts.index(part))

    def boundary(self) -> tuple[Ints, Ints]:
        """Outer triangles of every part, (n, 3), and the part of each, (n,)."""
        outer = self.outer().ravel()
        return self.tets[:, FACES].reshape(-1, 3)[outer], np.repeat(self.region, 4)[outer]

    def outer(self) -> Mask:
        """(n_tets, 4) which FACES bound their part."""
        return ~repeated(self.tets[:, FACES].reshape(-1, 3)).reshape(-1, 4)

    def touching(self) -> Mask:
        """(n_tets, 4) which FACES bound their part and lie on another one."""
        return self.outer() & repeated(self.original[self.tets[:, FACES]].reshape(-1, 3)).reshape(-1, 4)


def repeated(triangles: Ints) -> Mask:
    """(n,) which triangles, corners (n, 3) in any order, occur more than once."""
    a, b, c = np.sort(triangles, axis=1).T
    step = int(triangles.max(initial=0)) + 1
    key = (a * step + b) * step + c  # one number per triangle, below 2^63 up to two million nodes
    order = np.argsort(key)
    same = key[order][1:] == key[order][:-1]
    out = np.zeros(len(key), bool)
    out[order[1:][same]] = out[order[:-1][same]] = True
    return out


def split(mesh: NamedMesh, without: Collection[str] = ()) -> SplitMesh:
    """Give every part its own copy of the nodes it touches, parts one after the other, `without` some."""
    left = [i for i, part in enumerate(mesh.parts) if part not in without]
    there, parts = np.isin(mesh.region, left), tuple(mesh.parts[i] for i in left)
    mesh = replace(mesh, tets=mesh.tets[there], region=np.searchsorted(left, mesh.region[there]), parts=parts)
    ids = [np.unique(mesh.tets[mesh.region == i]) for i in range(len(mesh.parts))]
    starts = np.cumsum([0, *map(len, ids)])
    tets = np.empty_like(mesh.tets)
    for i, part_ids in enumerate(ids):
        mine = mesh.region == i
        tets[mine] = starts[i] + np.searchsorted(part_ids, mesh.tets[mine])
    original = np.concatenate(ids)
    owner = np.repeat(np.arange(len(ids)), [len(part_ids) for part_ids in ids])
    return SplitMesh(mesh.points[original], tets, mesh.region, mesh.parts, original, owner, mesh.identities)


def on_nodes(nodes: SplitMesh, temperature: Array) -> Array:
    """Temperatures per split node (or per conformal point, which are then copied), checked for size and finiteness."""
    T = np.asarray(temperature, float)
    if T.shape[-1] == nodes.size:
        out = T
    elif T.shape[-1] == nodes.original.max() + 1:
        out = T[..., nodes.original]
    else:
        right = f"{nodes.size} values, one per node of every part, or {nodes.original.max() + 1}, one per point"
        raise InputError(f"{T.shape[-1]} temperatures do not fit the mesh", "field", right)
    if not np.isfinite(out).all():
        raise InputError("temperatures that are not finite numbers", "field", "finite degC at every node")
    return out
