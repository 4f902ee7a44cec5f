"""A part: a name, a material and the prisms it is made of."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from geom.description.profile import Profile
from geom.description.roles import Identity, Role, identity

Prism = tuple[Profile, float, float]


@dataclass(frozen=True)
class Helix:
    """A rectangular channel around the axis as it is made; prisms have rings in its place.

    inner, outer : radii (m);  bottom, top : planes that end it (m);  pitch : per turn (m)
    width : along the axis (m);  blunt : what is left of the width where it begins and ends (m)
    angle : where it begins (rad), at the bottom; from there it runs anticlockwise and up
    """

    inner: float
    outer: float
    bottom: float
    top: float
    pitch: float
    width: float
    blunt: float
    angle: float

    @property
    def turns(self) -> float:
        """From one blunt end to the other."""
        return (self.top - self.bottom + self.width - 2 * self.blunt) / self.pitch

    @property
    def volume(self) -> float:
        """Exact (m3): a strip of the width between the end planes, less what the blunt ends cut off."""
        ring = math.pi * (self.outer**2 - self.inner**2)
        return ring * ((self.top - self.bottom) * self.width - self.blunt**2) / self.pitch


@dataclass(frozen=True)
class Rod:
    """A round bar that points away from the axis: angle (rad), place along the axis, radial extent, diameter (m)."""

    angle: float
    z: float
    inner: float
    outer: float
    diameter: float


@dataclass(frozen=True)
class CadShape:
    """A part as it is made, where its prisms simplify it: what it starts from, one body, and what is cut out.

    Helices lie wholly inside the body; ports open them.
    """

    start: tuple[Prism, ...] | Rod
    cuts: tuple[Prism | Rod | Helix, ...]


@dataclass(frozen=True)
class Part:
    """A prismatic body, or, with solid=False, a space filled by a fluid.

    name, material : names as in the mesh and in materials.toml
    prisms : (profile, z0 (m), z1 (m)); prisms of one part touch but do not overlap
    filling : of a winding, share of conductor in its cross-section, share of the rest filled with resin, and where it
        is not the material's the share of wire length along the axis
    cad_shape : what CAD files show instead of the prisms: round ports, helical channels
    role : what it is;  turns : whether it turns with the shaft, None as its role does
    properties : (name, value, source) of the material where it is not as in materials.toml
    Fluids may be drawn loosely: a solid wins where they overlap, and so does the fluid declared first.
    """

    name: str
    material: str
    prisms: tuple[Prism, ...]
    filling: tuple[float, ...] | None = None
    solid: bool = True
    cad_shape: CadShape | None = None
    role: Role | None = None
    turns: bool | None = None
    properties: tuple[tuple[str, float, str], ...] = ()

    @property
    def identity(self) -> Identity | None:
        """What it is, as its family or its file declares; None where neither does."""
        return None if self.role is None and self.turns is None else identity(self.role, self.turns)

    @property
    def volume(self) -> float:
        """Exact volume of the solid (m3)."""
        return sum(profile.area * (z1 - z0) for profile, z0, z1 in self.prisms)

    @property
    def span(self) -> tuple[float, float]:
        """First and last axial position (m)."""
        return min(z0 for _, z0, _ in self.prisms), max(z1 for _, _, z1 in self.prisms)


@dataclass(frozen=True)
class Port:
    """Where a liquid enters or leaves: name, e.g. "jacket.left.inlet", the fluid's name, a point on the wall (m).

    The tube there is the part NAME.tube, wet on its face NAME.bore.
    """

    name: str
    fluid: str
    position: tuple[float, float, float]


def fluid(name: str, *prisms: Prism, material: str = "air", role: Role = Role.INNER_AIR) -> Part:
    return Part(name, material, prisms, solid=False, role=role)


def extrude(profiles: Iterable[Profile], z0: float, z1: float) -> tuple[Prism, ...]:
    """The same axial extent for several profiles."""
    return tuple((profile, z0, z1) for profile in profiles)
