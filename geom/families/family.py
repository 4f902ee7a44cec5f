"""What a family of machines is."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from geom.description.geometry import Features, Geometry
from geom.description.parameters import Parameter
from geom.description.part import Part, Port


@dataclass(frozen=True)
class Family:
    """A parametric machine.

    build : values in SI (see parameters.read_geometry) -> solids and fluids, or InputError if they do not fit
    face_names : (part, fluid) -> name, where it differs from the rule of `Machine.face_name`
    outlines : shapes that [outlines] of a file may have, with what they are; values have them as `outlines`
    ports : values in SI -> where liquids enter and leave;  features : what formulas ask beside the solids
    """

    name: str
    doc: str
    parameters: tuple[Parameter, ...]
    build: Callable[[Geometry], tuple[Part, ...]]
    face_names: Mapping[tuple[str, str], str] = field(default_factory=dict)
    ports: Callable[[Geometry], tuple[Port, ...]] = lambda g: ()
    features: Callable[[Geometry], Features] = lambda g: Features()
    outlines: Mapping[str, str] = field(default_factory=dict)
