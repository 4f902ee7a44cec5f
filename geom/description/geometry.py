"""A machine's dimensions as the families read them, and what they declare for formulas that solids do not say."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import SimpleNamespace


class Group(SimpleNamespace):
    """Parameters of one part of the machine in SI, by their names: lengths (m), angles (rad), counts and words."""


class Geometry(SimpleNamespace):
    """All parameters of a family, a `Group` each: geometry.rotor.stack_length (m)."""


@dataclass(frozen=True)
class PoleCoils:
    """Coils around radial poles.

    axes : angles of the poles (rad);  z_centre, half_length, half_width : of a pole (m)
    """

    axes: tuple[float, ...]
    z_centre: float
    half_length: float
    half_width: float


@dataclass(frozen=True)
class Duct:
    """Equal straight passages along the axis: section and perimeter of all together (m2, m), length (m).

    turns : in the rotor; else beside it, and its air mixes with that of the air gap
    """

    section: float
    perimeter: float
    length: float
    bends: int = 0
    coil: float = 0.0
    turns: bool = False

    @property
    def diameter(self) -> float:
        """Hydraulic diameter of each (m)."""
        return 4 * self.section / self.perimeter


@dataclass(frozen=True)
class SeriesWound:
    """A machine whose field carries the armature's current, and its parts by what they lose.

    armature : conductors in the core, then those outside it at either end;  sliding : brushes and what they slide on
    """

    armature: tuple[str, str, str]
    field: str
    core: str
    poles: str
    sliding: tuple[str, ...]
    bearings: tuple[str, ...]


@dataclass(frozen=True)
class Bars:
    """Bars of a hairpin winding, one per slot and layer, and the slot around them (m).

    layers : parts, from the bottom of the slot to its opening;  ends, liner : parts around them
    width, height, enamel : of a bar without its enamel
    pitch : from layer to layer;  room, slot : width of each layer between the liners, and between the teeth
    """

    layers: tuple[str, ...]
    ends: tuple[str, str]
    liner: str
    width: float
    height: float
    enamel: float
    pitch: float
    room: tuple[float, ...]
    slot: tuple[float, ...]


@dataclass(frozen=True)
class Features:
    """What formulas ask of a machine and its solids do not say; an imported one has none of it.

    air_gap : width (m), where the gap's space reaches into slots
    coils : winding -> its loops around poles;  shoes : pole -> thickness of the shoe at its inside (m)
    ends : fluids at the left and right end;  fan_space : fluid in which a shaft fan turns, "" without one
    ducts : fluid -> passages between the ends beside the air gap
    """

    air_gap: float | None = None
    coils: Mapping[str, PoleCoils] = field(default_factory=dict)
    shoes: Mapping[str, float] = field(default_factory=dict)
    ends: tuple[str, str] = ("air.left", "air.right")
    fan_space: str = ""
    ducts: Mapping[str, Duct] = field(default_factory=dict)
    series: SeriesWound | None = None
    bars: Bars | None = None


NO_FEATURES = Features()
