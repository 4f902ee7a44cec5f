"""Solids as they are made (cadquery): round ports and helical channels, which prisms can only simplify."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from geom.description.part import CadShape, Helix, Prism, Rod
from geom.solids.brep import Boundary
from geom.solids.screw import channel
from geom.solids.stack import stacked

if TYPE_CHECKING:
    import cadquery as cq


def carved(shape: CadShape) -> list[cq.Solid]:
    """The solids (mm) that are left of the start; helices lie wholly inside it."""
    import cadquery as cq

    body: Any
    (body,) = [_rod(shape.start)] if isinstance(shape.start, Rod) else stacked(shape.start)
    voids = [channel(cut) for cut in shape.cuts if isinstance(cut, Helix)]
    if voids:
        shells = [shell.wrapped for shell in body.Shells()]
        inside = [shell.wrapped.Reversed() for void in voids for shell in void.Shells()]
        body = Boundary().solid([*shells, *inside])
    tools = [_tool(cut) for cut in shape.cuts if not isinstance(cut, Helix)]
    return [cq.Solid(solid.wrapped) for solid in body.cut(*tools).Solids()] if tools else [body]


def _tool(piece: Prism | Rod) -> cq.Solid:
    return _rod(piece) if isinstance(piece, Rod) else stacked([piece])[0]


def _rod(rod: Rod) -> cq.Solid:
    import cadquery as cq

    out = cq.Vector(math.cos(rod.angle), math.sin(rod.angle), 0)
    foot = out * (rod.inner * 1e3) + cq.Vector(0, 0, rod.z * 1e3)
    return cq.Solid.makeCylinder(rod.diameter * 500, (rod.outer - rod.inner) * 1e3, foot, out)
