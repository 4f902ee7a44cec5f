"""Boundaries of exact solids, put together vertex by vertex (OpenCASCADE), so that nothing has to be intersected."""

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from OCP.BRep import BRep_Builder
from OCP.Geom import Geom_Line, Geom_Surface
from OCP.Geom2d import Geom2d_Line
from OCP.gp import gp_Ax3, gp_Dir, gp_Dir2d, gp_Pnt, gp_Pnt2d
from OCP.TopAbs import TopAbs_Orientation
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Shell, TopoDS_Solid, TopoDS_Vertex, TopoDS_Wire

if TYPE_CHECKING:
    import cadquery as cq

TOLERANCE = 1e-7  # mm; of edges and vertices: what OpenCASCADE takes for one point
Oriented = tuple[Any, bool]  # an edge, and whether it is walked as it runs


class Boundary:
    """Makes vertices, edges and faces (mm)."""

    def __init__(self) -> None:
        self._make, self._here = BRep_Builder(), TopLoc_Location()

    def vertex(self, point: Sequence[float]) -> Any:
        vertex = TopoDS_Vertex()
        self._make.MakeVertex(vertex, gp_Pnt(*point), TOLERANCE)
        return vertex

    def edge(self, curve: Any, first: float, last: float, start: Any, end: Any) -> Any:
        """A curve between two parameters, where two vertices are."""
        edge = TopoDS_Edge()
        self._make.MakeEdge(edge, curve, TOLERANCE)
        self._make.Add(edge, start.Oriented(TopAbs_Orientation.TopAbs_FORWARD))
        self._make.Add(edge, end.Oriented(TopAbs_Orientation.TopAbs_REVERSED))
        self._make.Range(edge, first, last)
        return edge

    def lay(self, edge: Any, curve: Any, surface: Geom_Surface) -> None:
        """The edge runs along the curve in the parameters of the surface."""
        self._make.UpdateEdge(edge, curve, surface, self._here, TOLERANCE)

    def face(self, surface: Geom_Surface, loops: Iterable[Iterable[Oriented]], outward: bool) -> Any:
        """The surface inside loops, anticlockwise ones first; outward : whether its normal leaves the solid."""
        face = TopoDS_Face()
        self._make.MakeFace(face, surface, TOLERANCE)
        for loop in loops:
            wire = TopoDS_Wire()
            self._make.MakeWire(wire)
            for edge, forward in loop:
                self._make.Add(wire, edge if forward else edge.Reversed())
            wire.Closed(True)
            self._make.Add(face, wire)
        return face if outward else face.Oriented(TopAbs_Orientation.TopAbs_REVERSED)

    def shell(self, faces: Iterable[Any]) -> Any:
        shell = TopoDS_Shell()
        self._make.MakeShell(shell)
        for face in faces:
            self._make.Add(shell, face)
        shell.Closed(True)
        return shell

    def solid(self, shells: Iterable[Any]) -> "cq.Solid":
        """What lies inside the first shell; further ones bound its voids."""
        import cadquery as cq

        solid = TopoDS_Solid()
        self._make.MakeSolid(solid)
        for shell in shells:
            self._make.Add(solid, shell)
        return cq.Solid(solid)


def axes(origin: Sequence[float], normal: Sequence[float], along: Sequence[float]) -> Any:
    """Right-handed axes: the third is the normal, the first lies along."""
    return gp_Ax3(gp_Pnt(*origin), gp_Dir(*normal), gp_Dir(*along))


def line(start: Sequence[float], end: Sequence[float]) -> tuple[Any, float, float]:
    """A straight curve and its parameters from start to end."""
    way = [b - a for a, b in zip(start, end)]
    return Geom_Line(gp_Pnt(*start), gp_Dir(*way)), 0.0, math.hypot(*way)


def line_2d(u: float, v: float, du: float, dv: float) -> Any:
    """A straight line in the parameters of a surface, through (u, v)."""
    return Geom2d_Line(gp_Pnt2d(u, v), gp_Dir2d(du, dv))
