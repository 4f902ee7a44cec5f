"""Solids as they are made (cadquery): round ports and helical channels, which prisms can only simplify."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from geom.description.part import CadShape, Helix, Rod
from geom.description.profile import Profile
from geom.errors import InputError

if TYPE_CHECKING:
    import cadquery as cq

mm = 1e3
_SEAMS = (0.0, 77.0, 163.0, 241.0)  # deg
_VOLUME = 1e-3  # relative error of a helix that is not lost
_OVERRUN = 1.0  # mm; how far a helix is swept beyond its radii before they cut it


def carved(shape: CadShape) -> list[cq.Solid]:
    """The solids (mm) that are left of the start."""
    import cadquery as cq

    whole, *more = (_shape(piece) for piece in shape.start)
    body: Any = whole.fuse(*more) if more else whole
    body = body.cut(*(_shape(piece) for piece in shape.cuts))
    return [cq.Solid(solid.wrapped) for solid in body.Solids()]


def prism(profile: Profile, z0: float, z1: float) -> cq.Solid:
    """A profile from z0 to z1 (m)."""
    import cadquery as cq

    face = profile.scaled(1e3).to_face()
    return cq.Solid.extrudeLinear(face, cq.Vector(0, 0, (z1 - z0) * 1e3)).translate(cq.Vector(0, 0, z0 * 1e3))


def _shape(piece: Any) -> Any:
    if isinstance(piece, Rod):
        return _rod(piece)
    return channel(piece) if isinstance(piece, Helix) else prism(*piece)


def _rod(rod: Rod) -> cq.Solid:
    import cadquery as cq

    out = cq.Vector(math.cos(rod.angle), math.sin(rod.angle), 0)
    foot = out * (rod.inner * 1e3) + cq.Vector(0, 0, rod.z * 1e3)
    return cq.Solid.makeCylinder(rod.diameter * 500, (rod.outer - rod.inner) * 1e3, foot, out)


def channel(helix: Helix) -> Any:
    """The channel (mm): a rectangle in a plane through the axis, moved as on a screw, cut by radii and end planes.

    Raises InputError if the CAD kernel cannot cut it.
    """
    swept = _swept(helix)
    for seam in _SEAMS:  # the kernel loses solids whose edges run through a seam
        body = _room(helix, seam).intersect(swept)
        if abs(body.Volume() * 1e-9 / helix.volume - 1) < _VOLUME:
            return body
    raise InputError(f"the CAD kernel fails at a helix of {helix.turns:.2f} turns", "jacket", "another rib or height")


def _swept(helix: Helix) -> Any:
    """The rectangle's way, wider than the channel on either side."""
    import cadquery as cq

    r0, r1, width, pitch = (mm * x for x in (helix.inner, helix.outer, helix.width, helix.pitch))
    below = mm * (helix.bottom + helix.blunt) - width  # lower edge where it begins
    near, far = r0 - _OVERRUN, r1 + _OVERRUN
    corners = [(near, 0), (far, 0), (far, width), (near, width)]
    section = cq.Wire.makePolygon([cq.Vector(r, 0, z) for r, z in corners], close=True)
    path = cq.Wire.makeHelix(pitch, helix.turns * pitch, (r0 + r1) / 2)
    swept = cq.Solid.sweep(section, [], path, makeSolid=True, isFrenet=True)
    return swept.rotate(cq.Vector(), cq.Vector(0, 0, 1), math.degrees(helix.angle)).translate(cq.Vector(0, 0, below))


def _room(helix: Helix, seam: float) -> Any:
    """The ring that holds the channel, its seam at an angle (deg)."""
    import cadquery as cq

    low, high = mm * helix.bottom, mm * helix.top
    outer, inner = (cq.Solid.makeCylinder(mm * r, high - low, cq.Vector(0, 0, low)) for r in (helix.outer, helix.inner))
    return outer.cut(inner).rotate(cq.Vector(), cq.Vector(0, 0, 1), seam)
