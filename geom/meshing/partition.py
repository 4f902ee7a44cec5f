"""The plane partition: all profiles of a machine overlaid, every face labelled at every axial slab, voids filled."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from geom.arrays import Array, Ints, Mask
from geom.description.part import Part
from geom.description.profile import ArcGrid, Profile
from geom.errors import InputError
from geom.groups import joined_groups, near_groups

_OVERLAP = 1e-8  # m2; a common area below this is rounding
AMBIENT = -1
GRID = 1e-7  # m; coordinates are snapped to this
NEAR = 2e-6  # m; points and lines nearer than this are one, far below any tolerance of a motor


def noded(lines: list[shapely.Geometry]) -> NDArray[np.object_]:
    """Border lines of many polygons as segments that meet only at their ends, cleaned of rounding.

    Corners that should lie on another line miss it by a rounding error when the shape is turned. Snap rounding then
    leaves edges and slivers of 0.1 um, which no mesh survives; they are merged here.
    """
    xy, line = shapely.get_coordinates(shapely.get_parts(shapely.union_all(lines, grid_size=GRID)), return_index=True)
    keys, number = np.unique(np.round(xy / GRID).astype(np.int64), axis=0, return_inverse=True)
    follows = line[1:] == line[:-1]
    points, edges = keys * GRID, np.column_stack([number[:-1][follows], number[1:][follows]])
    # For each point the number of the point that stands for all those near it.
    group = near_groups(points, NEAR)
    edges = _distinct(np.unique(group, return_index=True)[1][group][edges])
    edges = _distinct(_split(points, edges))
    return shapely.linestrings(points[edges])


def _distinct(edges: Ints) -> Ints:
    edges = np.unique(np.sort(edges, axis=1), axis=0)
    return edges[edges[:, 0] != edges[:, 1]]


def _split(points: Array, edges: Ints) -> Ints:
    """Edges cut at every point that lies on them to within NEAR."""
    vertices = np.unique(edges)
    tree = shapely.STRtree(shapely.linestrings(points[edges]))
    which, edge = tree.query(shapely.points(points[vertices]), predicate="dwithin", distance=NEAR)
    point = vertices[which]
    inner = (edges[edge] != point[:, None]).all(axis=1)
    point, edge = point[inner], edge[inner]
    start, along = points[edges[:, 0]], points[edges[:, 1]] - points[edges[:, 0]]
    share = np.einsum("ij,ij->i", points[point] - start[edge], along[edge])
    order = np.lexsort((share, edge))
    point, edge = point[order], edge[order]
    pieces = [edges[np.setdiff1d(np.arange(len(edges)), edge)]]
    for index in np.unique(edge):
        chain = np.concatenate([edges[index, :1], point[edge == index], edges[index, 1:]])
        pieces.append(np.column_stack([chain[:-1], chain[1:]]))
    return np.vstack(pieces)


@dataclass(frozen=True)
class Partition:
    """Faces of the plane and what fills each of them between neighbouring levels.

    levels : (n_slab + 1,) axial positions where anything begins or ends (m)
    faces : (n_face,) shapely polygons that tile a box around the machine
    labels : (n_face, n_slab) index into parts; AMBIENT where nothing is declared
    left, right : (n_edge,) faces on either side of each border edge, -1 beyond the box
    length : (n_edge,) of each border edge (m)
    parts : solids and fluids in the order of the labels
    """

    levels: Array
    faces: NDArray[np.object_]
    labels: Ints
    left: Ints
    right: Ints
    length: Array
    parts: tuple[Part, ...]

    @property
    def solid(self) -> Mask:
        """(n_face, n_slab) True where a solid part is."""
        is_solid = np.array([part.solid for part in self.parts] + [False])
        return is_solid[self.labels]

    def area(self) -> Array:
        return shapely.area(self.faces)


def partition(parts: Sequence[Part], segments: int = 72) -> Partition:
    """Overlay the profiles of all parts and label the pieces.

    Raises InputError where two solids overlap.
    """
    profiles = list(dict.fromkeys(profile for part in parts for profile, _, _ in part.prisms))
    grid = ArcGrid(profiles, segments)
    exact = np.array([profile.to_polygon(grid) for profile in profiles], dtype=object)
    polygons = shapely.set_precision(exact, GRID, mode="pointwise")  # equal corners become equal to the bit
    box = shapely.box(*shapely.total_bounds(polygons)).buffer(0.02, join_style="mitre")
    lines = noded([*shapely.boundary(polygons), box.exterior])
    faces = shapely.orient_polygons(np.array(shapely.get_parts(shapely.polygonize(lines)), dtype=object))
    levels = np.unique(np.round([z for part in parts for _, z0, z1 in part.prisms for z in (z0, z1)], 7))
    labels = _label(parts, profiles, polygons, faces, levels)
    return Partition(levels, faces, labels, *_neighbours(faces), tuple(parts))


def _label(
    parts: Sequence[Part],
    profiles: list[Profile],
    polygons: NDArray[np.object_],
    faces: NDArray[np.object_],
    levels: Array,
) -> Ints:
    inside = shapely.STRtree(shapely.point_on_surface(faces))
    which, members = inside.query(polygons, predicate="contains")
    faces_of = {profile: members[which == i] for i, profile in enumerate(profiles)}
    labels, areas = np.full((len(faces), len(levels) - 1), AMBIENT, dtype=np.int64), shapely.area(faces)
    order = sorted(range(len(parts)), key=lambda i: (not parts[i].solid, i))
    for index in order:
        for profile, z0, z1 in parts[index].prisms:
            slabs = slice(*np.searchsorted(levels, np.round([z0, z1], 7)))
            block = labels[faces_of[profile], slabs]
            if parts[index].solid:
                solid = block != AMBIENT
                if solid.any() and areas[faces_of[profile]][solid.any(axis=1)].sum() >= _OVERLAP:
                    what = f"{parts[index].name} and {parts[block[solid][0]].name} overlap"
                    raise InputError(what, "geometry", "parts may touch, not overlap")
            labels[faces_of[profile], slabs] = np.where(block == AMBIENT, index, block)
    return labels


def half_edges(faces: NDArray[np.object_]) -> tuple[Array, Ints]:
    """Points (n, 2), and (3, m) start, end (point numbers) and face of every directed border edge, face on its left."""
    rings, owner = shapely.get_rings(faces, return_index=True)
    xy, ring = shapely.get_coordinates(rings, return_index=True)
    keys, number = np.unique(np.round(xy / GRID).astype(np.int64), axis=0, return_inverse=True)
    follows = ring[1:] == ring[:-1]
    return keys * GRID, np.array([number[:-1][follows], number[1:][follows], owner[ring[:-1][follows]]])


def _neighbours(faces: NDArray[np.object_]) -> tuple[Ints, Ints, Array]:
    """Pairs of faces with a common edge, -1 is the plane beyond the box; and the length of that edge (m)."""
    points, (start, end, face) = half_edges(faces)
    forward = start < end
    edges, which = np.unique(np.sort(np.column_stack([start, end]), axis=1), axis=0, return_inverse=True)
    left, right = np.full(len(edges), -1), np.full(len(edges), -1)
    left[which[forward]] = face[forward]
    right[which[~forward]] = face[~forward]
    return left, right, np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1)


def filled(cut: Partition) -> Partition:
    """The partition with closed voids given to the fluid that has no prisms of its own, if there is one.

    Raises InputError for a closed void that no fluid fills.
    """
    hidden = _hidden(cut)
    if not hidden.any():
        return cut
    takers = [i for i, part in enumerate(cut.parts) if not part.solid and not part.prisms]
    if not takers:
        face, slab = np.argwhere(hidden)[0]
        point, z = shapely.point_on_surface(cut.faces[face]), cut.levels[slab : slab + 2].mean()
        what = f"closed void around x, y, z = {point.x * 1e3:.1f}, {point.y * 1e3:.1f}, {z * 1e3:.1f} mm"
        raise InputError(what, "geometry", "declare the fluid that fills it, or close it")
    return replace(cut, labels=np.where(hidden, takers[0], cut.labels))


def _hidden(cut: Partition) -> Mask:
    """(n_face, n_slab) True in voids without a label and without a way out."""
    void = cut.labels == AMBIENT
    n_face, n_slab = void.shape
    cell = np.arange(n_face * n_slab).reshape(n_face, n_slab)
    outside = n_face * n_slab
    inner = (cut.left >= 0) & (cut.right >= 0)
    a, b = cut.left[inner], cut.right[inner]
    beside = void[a] & void[b]
    above = void[:, :-1] & void[:, 1:]
    rim = np.concatenate([cut.left[cut.right < 0], cut.right[cut.left < 0]])
    open_cells = np.concatenate([cell[rim].ravel(), cell[:, 0][void[:, 0]], cell[:, -1][void[:, -1]]])
    first = np.concatenate([cell[a][beside], cell[:, :-1][above], open_cells])
    second = np.concatenate([cell[b][beside], cell[:, 1:][above], np.full(len(open_cells), outside)])
    component = joined_groups(outside + 1, np.column_stack([first, second]))
    return void & (component[:-1].reshape(n_face, n_slab) != component[-1])
