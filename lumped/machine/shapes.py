"""What the correlations need to know of a machine's parts: which of them turn, how large they are, how they stand."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from geom.description.machine import Machine
from geom.description.part import Part
from geom.description.roles import Role

DIRECTED = 3.0  # a conductivity this many times the other one has a direction
ROUND = 0.02  # a body is turned when its bounds are centred and square to this share


@dataclass(frozen=True)
class Extent:
    """Bounds of a part (m); z is the machine's axis, y points up."""

    x0: float
    x1: float
    y0: float
    y1: float
    z0: float
    z1: float

    @property
    def size(self) -> tuple[float, float, float]:
        return self.x1 - self.x0, self.y1 - self.y0, self.z1 - self.z0

    @property
    def turned(self) -> bool:
        """Is it centred on the axis and as wide as high?"""
        wide, high, _ = self.size
        off = max(abs(self.x0 + self.x1), abs(self.y0 + self.y1), abs(wide - high))
        return off < ROUND * max(wide, high)


def extent(part: Part) -> Extent:
    x0, y0, x1, y1 = zip(*(profile.bounds for profile, _, _ in part.prisms))
    return Extent(min(x0), max(x1), min(y0), max(y1), *part.span)


def wound(machine: Machine, part: str) -> bool:
    """Wires along the axis: heat runs along them much more easily."""
    k_plane, k_axial = machine.conductivity(part)
    return bool(k_axial > DIRECTED * k_plane)


def conducts(machine: Machine, part: str) -> bool:
    """A winding: wires, or a layer of bars."""
    bars = machine.features.bars
    return wound(machine, part) or (bars is not None and part in bars.layers)


def laminated(machine: Machine, part: str) -> bool:
    """Sheets across the axis: heat runs in them much more easily."""
    k_plane, k_axial = machine.conductivity(part)
    return bool(k_plane > DIRECTED * k_axial)


@dataclass(frozen=True)
class Gap:
    """The air gap: radius of the rotor and radial width (m)."""

    rotor_radius: float
    width: float


def gap_fluid(machine: Machine) -> str:
    """The fluid that is the air gap."""
    return next(part.name for part in machine.fluids if part.role is Role.AIR_GAP)


def radius(loop: Iterable[tuple[float, float, float]]) -> float:
    """Largest distance of a loop's corners from the axis (m)."""
    return max(math.hypot(x, y) for x, y, _ in loop)


@dataclass(frozen=True)
class Fins:
    """Fins on a housing: number, height, thickness, root radius, length along the air (m); axial, or discs around."""

    number: int
    height: float
    thickness: float
    root: float
    length: float
    axial: bool

    @property
    def pitch(self) -> float:
        """From fin to fin, at the root (m)."""
        return 2 * math.pi * self.root / self.number if self.axial else self.length / self.number

    @property
    def spacing(self) -> float:
        """Clear width between two fins (m), at half height of axial ones."""
        middle = self.pitch * (1 + self.height / (2 * self.root)) if self.axial else self.pitch
        return middle - self.thickness

    @property
    def area_ratio(self) -> float:
        """Finned area over that of its root."""
        return 1.0 + 2.0 * self.height / self.pitch * (1.0 if self.axial else 1 + self.height / (2 * self.root))

    @property
    def hydraulic_diameter(self) -> float:
        """4 A / P of the channel between two fins, the open side counted (m)."""
        return 2.0 * self.spacing * self.height / (self.spacing + self.height)


def fins_of(machine: Machine) -> Fins | None:
    """The housing's fins, where the family has them."""
    housing: Any = getattr(machine.geometry, "housing", None)
    number = int(getattr(housing, "fins", 0))
    kind = getattr(housing, "kind", "axial-fins")
    if not number or not kind.endswith("fins"):
        return None
    part = machine.part("housing")
    root = min(math.hypot(x, y) for profile, _, _ in part.prisms for x, y, _ in profile.outer)
    length = part.span[1] - part.span[0]
    return Fins(number, housing.fin_height, housing.fin_thickness, root, length, kind == "axial-fins")
