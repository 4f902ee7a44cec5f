"""What a network is made of: rows, places, links, sources and parameters, and all of them together."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, Protocol

import numpy as np

from geom.arrays import Array, Ints
from geom.description.roles import Identity
from geom.errors import InputError
from lumped.model.quantities import USUAL
from lumped.transfer.laws import Law


@dataclass(frozen=True)
class Row:
    """A fixed weighted sum of z = [x; u]: `weights @ z[index]` (degC, or K for a difference)."""

    index: Ints
    weights: Array

    def at(self, z: Array) -> float:
        return float(self.weights @ z[self.index])

    def dense(self, size: int) -> Array:
        row = np.zeros(size)
        np.add.at(row, self.index, self.weights)
        return row


NOTHING = Row(np.empty(0, np.int64), np.empty(0))


@dataclass(frozen=True)
class Place:
    """Somewhere on the machine where heat can enter or leave: a face, a part or a bare node.

    name : e.g. "flange.right.outer" (face) or "flange.right" (part, node)
    kind : "surface" | "part" | "node" | "fluid"
    part : the part or node it belongs to
    states : (k,) the states that describe it
    K : (k, k) Int N N' over the face (m2); [[1]] for a node of unknown area
    b : (k,) Int N over the face (m2); for a part its mean row; [1] for a node
    area : m2, or None where unknown (then links carry W/K and films cannot be made from h)
    fluid : name of the state or boundary that washes it, if any
    channel : of a cell that a stream passes with others, the channel they make up
    reading : whether it is what a sensor reads, and nothing larger
    """

    name: str
    kind: Literal["surface", "part", "node", "fluid"]
    part: str
    states: Ints
    K: Array
    b: Array
    area: float | None = None
    fluid: str | None = None
    channel: str | None = None
    reading: bool = False

    @property
    def mean(self) -> Row:
        """The mean temperature of the place as a row over the states."""
        return Row(self.states, self.b / (self.area if self.kind == "surface" and self.area else 1.0))


@dataclass(frozen=True)
class Link:
    """Heat leaving the states: m g(t, T) P z, with P given by its triplets (rows, cols, vals).

    kind : "film" | "contact" | "conduction" | "stream" | "link"
    places : the two places it joins; a boundary or fluid goes by its own name
    law : coefficient (W/m2/K with areas in P, W/K with a bare P, or 1 for conduction)
    hot, cold : rows giving the two temperatures the law may depend on
    origin : the effect, form or disturbance that brought it; empty for the network's own
    """

    name: str
    kind: str
    places: tuple[str, str]
    rows: Ints
    cols: Ints
    vals: Array
    law: Law
    hot: Row
    cold: Row
    origin: str = ""


@dataclass(frozen=True)
class Source:
    """Heat entering the states: m q(t, T) f, f given by (index, weights) with weights summing to 1 over the mean nodes.

    kind : the loss it is: "copper", "iron", "friction", "brush", "windage", "measured", ...
    probe : the temperature its law may depend on (copper: the winding's mean)
    origin : as for a link
    """

    name: str
    kind: str
    place: str
    index: Ints
    weights: Array
    law: Law
    probe: Row
    origin: str = ""


@dataclass(frozen=True)
class Parameter:
    """One adjustable number, declared once.

    targets : (name of link/source/capacity group, exponent): their multiplier is m ** exponent.
        Several parameters may act on one target; their multipliers then multiply.
        Capacity groups go by "capacity:NAME". Channel operators go by "bias:CHANNEL" (K, added),
        "gain:CHANNEL" (1 = neutral) and "lag:CHANNEL" (s).
    mapping : "log": m = value, prior lognormal around `value` with log-sd `prior_sd`;
        "amplitude": m = value (neutral 0), prior normal; "relative": m = 1 + value (neutral 0);
        "offset": channel operators in their own unit (neutral 0)
    low, high : hard physical bounds of `value`
    sign : +1 or -1 where physics allows only one, else 0
    flow : whether it is the rate of a flow, which moves streams and the films along them
    """

    name: str
    targets: tuple[tuple[str, float], ...]
    value: float = 1.0
    unit: str = "1"
    low: float = 1e-3
    high: float = 1e3
    prior_sd: float = 0.3
    mapping: Literal["log", "amplitude", "relative", "offset"] = "log"
    neutral: float = 1.0
    sign: int = 0
    source: str = ""
    flow: bool = False


class Recovery(Protocol):
    """From the states of a condensed network back to the field."""

    def row(self, part: str, xyz: Array) -> Row:
        """Temperature at a point (m) of a part as a row over the states."""
        ...

    def field(self, x: Array) -> Array:
        """Temperature (degC) at every point of every part's own nodes, parts one after the other."""
        ...

    def of_part(self, part: str, x: Array) -> Array:
        """The same at the points in the mesh of one part."""
        ...


@dataclass(frozen=True)
class Structure:
    """states : their names; hidden shapes are "PART#1", "PART#2", ...
    C : (n,) heat capacities (J/K), 0 where a node has none
    capacity_group : for every state the name of its capacity group (a part and its shapes share one)
    boundaries : names of the temperatures given from outside ("ambient", "coolant.in", ...)
    parameters : what calibration may move
    settles_s : time constant (s) of the whole, roughly; with C it says how large a missing path usually is
    declared : what parts, nodes, fluids and boundaries are said to be, by name
    quantities : input -> what it measures ("speed");  signals : quantity -> the input of the machine's own
    adopted : effects that are in the model, so that others act on what these brought
    file : where it was read from; "" of a network that no file declares
    """

    name: str
    states: tuple[str, ...]
    C: Array
    boundaries: tuple[str, ...]
    links: tuple[Link, ...]
    sources: tuple[Source, ...]
    places: Mapping[str, Place]
    capacity_group: tuple[str, ...] = ()
    parameters: tuple[Parameter, ...] = ()
    recovery: Recovery | None = field(default=None, compare=False)
    settles_s: float = 3600.0
    declared: Mapping[str, Identity] = field(default_factory=dict)
    quantities: Mapping[str, str] = field(default_factory=dict)
    signals: Mapping[str, str] = field(default_factory=dict)
    adopted: frozenset[str] = frozenset()
    file: str = field(default="", compare=False)

    @property
    def title(self) -> str:
        """How messages call it."""
        return f"network '{self.name}'" + (f" of {self.file}" if self.file else "")

    def measures(self, name: str) -> str:
        """What an input measures; "" where nothing says."""
        return self.quantities.get(name, USUAL.get(name, ""))

    def column(self, name: str) -> int:
        """Column of z that holds a named state or boundary."""
        if name in self.states:
            return self.states.index(name)
        if name in self.boundaries:
            return len(self.states) + self.boundaries.index(name)
        nodes = ", ".join([*(s for s in self.states if "#" not in s), *self.boundaries])
        raise InputError(f"unknown node or boundary '{name}'", self.title, f"known: {nodes}")
