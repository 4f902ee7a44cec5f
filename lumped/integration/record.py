"""The record a network runs over."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from geom.arrays import Array
from geom.text import counted


@dataclass(frozen=True)
class Record:
    """time (nt,) s; inputs and boundaries: name -> (nt,) or scalar; initial: degC everywhere or per place.
    above: K by which some states start above that.

    Inputs and boundaries are linear between the times; a time given twice is a jump.
    """

    time: Array
    inputs: Mapping[str, Array | float]
    boundaries: Mapping[str, Array | float]
    initial: float | Mapping[str, float] = 20.0
    above: Mapping[str, float] = field(default_factory=dict)

    def __repr__(self) -> str:
        each = ("inputs", self.inputs), ("boundaries", self.boundaries)
        columns = "; ".join(f"{what} {', '.join(names) or 'none'}" for what, names in each)
        return f"<Record of {instants(self.time)}; {columns}>"


def instants(time: Array) -> str:
    """How many there are, from when to when."""
    ends = f", {time[0]:g} to {time[-1]:g} s" if len(time) else ""
    return counted(len(time), "instant") + ends
