"""Bodies cut open: what stays of their surface with its smooth normals, and flat caps where the cut runs through."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from extras.portraits.shape import Body
from thermoscope import plugin as th

if TYPE_CHECKING:
    import pyvista

SMOOTH = 32.0  # degrees between facets up to which a surface is shaded as a round one
Plane = tuple[th.Array, th.Array]  # a point (m) and the normal of the side that stays


def cut_body(body: Body, wedge: th.Wedge | None) -> tuple[pyvista.PolyData, pyvista.PolyData | None] | None:
    """Surface and caps of a body without a wedge, no caps where it is whole; None where nothing stays."""
    import pyvista

    mesh = pyvista.PolyData.from_regular_faces(body.shape.points, body.shape.triangles)  # type: ignore[arg-type]
    if wedge is None:
        return _smooth(mesh), None
    if body.whole:
        # In the wedge, or a little beside it (2 degrees)
        at = body.shape.points.mean(axis=0)
        angle = (np.rad2deg(np.arctan2(at[1], at[0])) - wedge.start) % 360
        return None if bool(angle < wedge.span + 2 or angle > 358) else (_smooth(mesh), None)
    first, last = wedge.edges()
    after, before = np.cross([0, 0, 1.0], first), np.cross([0, 0, 1.0], last)
    if ((mesh.points @ after <= 0) | (mesh.points @ before >= 0)).all() and not bool(
        (mesh.points @ after > 0).any() and (mesh.points @ before < 0).any()
    ):
        return _smooth(mesh), None
    sides: list[list[Plane]] = [[(np.zeros(3), -after)], [(np.zeros(3), after), (np.zeros(3), before)]]
    shells = [_clipped(_smooth(mesh), planes) for planes in sides]
    caps = [cap for planes in sides if (cap := _caps(mesh, planes)) is not None]
    shell = _merged([s for s in shells if s.n_cells])
    return None if shell is None else (shell, _merged(caps))


def _smooth(mesh: pyvista.PolyData) -> pyvista.PolyData:
    as_it_is = {"cell_normals": False, "consistent_normals": False, "auto_orient_normals": False}
    return mesh.compute_normals(split_vertices=True, feature_angle=SMOOTH, **as_it_is)


def _clipped(mesh: pyvista.PolyData, planes: list[Plane]) -> pyvista.PolyData:
    """pyvista keeps the side against the normal, so it is turned round."""
    for origin, normal in planes:
        mesh = mesh.clip(normal=-normal, origin=origin)
    return mesh


def _caps(mesh: pyvista.PolyData, planes: list[Plane]) -> pyvista.PolyData | None:
    """The flat faces that close a clipped body."""
    import pyvista
    from vtkmodules.vtkCommonDataModel import vtkPlane, vtkPlaneCollection
    from vtkmodules.vtkFiltersGeneral import vtkClipClosedSurface

    collection = vtkPlaneCollection()
    for origin, normal in planes:
        plane = vtkPlane()
        plane.SetOrigin(*origin)
        plane.SetNormal(*normal)
        collection.AddItem(plane)
    clip: Any = vtkClipClosedSurface()
    clip.SetInputData(mesh)
    clip.SetClippingPlanes(collection)
    clip.SetScalarModeToLabels()
    clip.Update()
    out = pyvista.wrap(clip.GetOutput())
    if not out.n_cells:
        return None
    caps = out.extract_cells(np.flatnonzero(np.asarray(out.cell_data["Labels"]) > 0)).extract_surface(
        algorithm="dataset_surface"
    )
    return caps if caps.n_cells else None


def _merged(pieces: list[pyvista.PolyData]) -> pyvista.PolyData | None:
    if not pieces:
        return None
    return pieces[0] if len(pieces) == 1 else pieces[0].append_polydata(*pieces[1:])
