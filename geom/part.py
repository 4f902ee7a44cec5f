"""A part: a name, a material and the prisms it is made of."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from geom.profile import Profile

Prism = tuple[Profile, float, float]


@dataclass(frozen=True)
class Part:
    """A prismatic body, or, with solid=False, a space filled by a fluid.

    name, material : names as in the mesh and in materials.toml
    prisms : (profile, z0 (m), z1 (m)); prisms of one part touch but do not overlap
    filling : of a winding, share of conductor in its cross-section and share of the rest filled with resin
    Fluids may be drawn loosely: a solid wins where they overlap, and so does the fluid declared first.
    """

    name: str
    material: str
    prisms: tuple[Prism, ...]
    filling: tuple[float, float] | None = None
    solid: bool = True

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
    """Where a liquid enters or leaves: name, e.g. "jacket.left.inlet", the fluid's name and a point (m)."""

    name: str
    fluid: str
    position: tuple[float, float, float]


def fluid(name: str, *prisms: Prism, material: str = "air") -> Part:
    return Part(name, material, prisms, solid=False)


def extrude(profiles: Iterable[Profile], z0: float, z1: float) -> tuple[Prism, ...]:
    """The same axial extent for several profiles."""
    return tuple((profile, z0, z1) for profile in profiles)
