"""What a column may measure: its units, and what it is good for."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from geom.arrays import Array


@dataclass(frozen=True)
class Quantity:
    """units : unit -> (factor, offset) into the unit of memory;  feeds : the network input it drives by default

    degC : of a sensor that does not read degC by itself, what its readings in the unit of memory say (degC)
    sigma : usual standard deviation of such a sensor in the unit of memory, where a sheet gives none
    settings : what else degC needs to know, key of a sheet -> usual value: an emissivity, a cold resistance
    """

    units: dict[str, tuple[float, float]]
    feeds: str = ""
    degC: Callable[..., Array] | None = None
    sigma: float = 0.0
    settings: Mapping[str, float] = field(default_factory=dict)
