"""The machine as it looks, cut open, for the page to draw: coarser than in pictures, and for the eye only.

Every corner shows a mix of the two nodes of its meshed part that lie nearest.
"""

import hashlib
import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from extras.portraits.cutting import cut_body
from extras.portraits.dressed import dressed
from extras.portraits.portrait import framed
from extras.portraits.shape import Body, Shape
from thermoscope import plugin as th

if TYPE_CHECKING:
    import pyvista

STEP_M = 1e-4  # of places: a fifth of a pixel where a machine of half a metre fills a screen of a thousand
SHARES = 16  # steps of the mix of two nodes: a fourth of a colour where they differ by five
STAY = (0.2, 0.35, 0.5, 0.7)  # shares of a body's triangles that may do
LOST = 0.04  # of its volume by which a body of fewer triangles may differ: a hundredth of its width


def packed_looks(
    machine: th.MachineDescription, nodes: th.SplitMesh, wedge: th.Wedge = th.QUARTER, cache: Path | None = None
) -> dict[str, Any]:
    """points (m), their two nodes and the second one's share, triangles; per part how many, and how many of them lie
    in the cut; frame : lowest and highest corner (m) of what a picture must hold

    cache : folder of such shapes by content, which other temperatures leave as they are; None for no cache
    """
    if cache is None:
        return _packed(machine, nodes, wedge)
    looks = cached_looks(machine, nodes, cache, wedge)
    if looks is None:
        looks = _packed(machine, nodes, wedge)
        th.store(_file(machine, nodes, wedge, cache), json.dumps(looks))
    return looks


def cached_looks(
    machine: th.MachineDescription, nodes: th.SplitMesh, cache: Path, wedge: th.Wedge = th.QUARTER
) -> dict[str, Any] | None:
    """The same from the cache; None where this machine was not shaped before."""
    return th.recalled(
        _file(machine, nodes, wedge, cache), lambda path: dict(json.loads(path.read_text(encoding="utf-8")))
    )


def _file(machine: th.MachineDescription, nodes: th.SplitMesh, wedge: th.Wedge, cache: Path) -> Path:
    # Of all that decides: the machine, its nodes and parts, the cut, and the code that draws
    content = hashlib.sha256(repr((machine, nodes.parts, wedge)).encode())
    for array in (nodes.points, nodes.owner):
        content.update(np.ascontiguousarray(array).tobytes())
    content.update(drawing_code())
    return cache / f"looks-{content.hexdigest()[:20]}.json"


def drawing_code() -> bytes:
    """What decides how a machine looks: the text of this module and of those that shape it."""
    here = Path(__file__)
    return b"".join(file.read_bytes() for file in sorted(here.parent.glob("*.py")))


def _packed(machine: th.MachineDescription, nodes: th.SplitMesh, wedge: th.Wedge) -> dict[str, Any]:
    bodies = dressed(machine)
    outer: list[list[pyvista.PolyData]] = [[] for _ in nodes.parts]
    caps: list[list[pyvista.PolyData]] = [[] for _ in nodes.parts]
    for body in map(coarse, bodies):
        for piece, of in zip(cut_body(body, wedge) or (), (outer, caps), strict=False):
            if piece is not None and piece.n_cells:
                of[nodes.parts.index(body.part)].append(piece.triangulate())
    points, triangles, weights, counts, size = [], [], [], [], 0
    for part, (shells, sections) in enumerate(zip(outer, caps, strict=True)):
        counts.append([sum(s.n_cells for s in some) for some in (shells, sections)])
        for piece in (*shells, *sections):
            place, corner = np.unique(np.round(np.asarray(piece.points) / STEP_M), axis=0, return_inverse=True)
            triangles.append(size + corner[piece.regular_faces])
            points.append(place * STEP_M)
            weights.append(_mix(nodes, part, points[-1]))
            size += len(place)
    corners = framed(machine, bodies)
    return {
        "points": th.packed_numbers(np.concatenate(points), STEP_M),
        "mix": th.packed_integers(np.concatenate(weights)),
        "triangles": th.packed_integers(np.concatenate(triangles)),
        "counts": counts,
        "wedge": [wedge.start, wedge.span],
        "frame": [corners.min(axis=0).tolist(), corners.max(axis=0).tolist()],
    }


def coarse(body: Body) -> Body:
    """The same of few triangles, by quadric error metrics (Garland and Heckbert 1997)."""
    import pyvista

    mesh = pyvista.PolyData.from_regular_faces(body.shape.points, body.shape.triangles)  # type: ignore[arg-type]
    for share in STAY:
        less = mesh.decimate(1.0 - share, volume_preservation=True)
        shape = Shape(np.asarray(less.points, float), np.asarray(less.regular_faces, np.int64))
        if abs(shape.volume / body.shape.volume - 1.0) < LOST:
            return replace(body, shape=shape)
    return body


def _mix(nodes: th.SplitMesh, part: int, points: th.Array) -> th.Ints:
    """(n, 3) the two nearest nodes of a part, and the second one's share in SHARES, by the inverse of the distance."""
    from scipy.spatial import cKDTree

    mine = np.flatnonzero(nodes.owner == part)
    away, near = cKDTree(nodes.points[mine]).query(points, k=2)
    share = away[:, 0] / np.maximum(away.sum(axis=1), 1e-12)
    return np.column_stack([mine[near], np.round(SHARES * share).astype(int)])
