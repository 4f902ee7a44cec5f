"""What a family of machines is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from geom.parameters import Parameter
from geom.part import Part


@dataclass(frozen=True)
class Family:
    """A parametric machine.

    build : values in SI (see parameters.read_geometry) -> solids and fluids, or InputError if they do not fit
    face_names : (part, fluid) -> name, where it differs from the rule of `mesher.face_name`
    """

    name: str
    doc: str
    parameters: tuple[Parameter, ...]
    build: Callable[[Any], tuple[Part, ...]]
    face_names: Mapping[tuple[str, str], str] = field(default_factory=dict)
