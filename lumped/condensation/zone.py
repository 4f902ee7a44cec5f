"""A loss zone: a piece of a part whose loss may vary alone."""

from collections.abc import Callable
from dataclasses import dataclass

from lumped.model.network import Array


@dataclass(frozen=True)
class Zone:
    """Where in a part a loss sits: density per tetrahedron, or of tetrahedron centres (m); None is uniform."""

    part: str
    density: Callable[[Array], Array] | Array | None = None
