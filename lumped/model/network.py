"""A thermal network: states, links, sources, places and parameters.

One form serves hand-declared networks and networks condensed from a field:

    C dx/dt = - sum_l m_l g_l(t, T) P_l z  +  sum_s m_s q_s(t, T) f_s ,      z = [x; u]

x are the states (temperatures of named nodes, and for condensed networks the hidden shape
amplitudes), u the boundary temperatures, P_l the fixed pattern of link l, g_l its coefficient,
f_s the distribution of source s, and m the multipliers that parameters act on (1 when no
parameter does). Every coefficient g and q factorises into an input factor, evaluated once for a
whole record, times one temperature law (see laws.py).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from geom.description.identity import Identity
from geom.errors import InputError
from geom.text import counted
from lumped.model.quantities import INPUTS, USUAL
from lumped.transfer.laws import Law

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Row:
    """A fixed weighted sum of z = [x; u]: `weights @ z[index]` (degC, or K for a difference)."""

    index: NDArray[np.int64]
    weights: Array

    def dense(self, size: int) -> Array:
        row = np.zeros(size)
        np.add.at(row, self.index, self.weights)
        return row


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
    """

    name: str
    kind: Literal["surface", "part", "node", "fluid"]
    part: str
    states: NDArray[np.int64]
    K: Array
    b: Array
    area: float | None = None
    fluid: str | None = None
    channel: str | None = None

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
    rows: NDArray[np.int64]
    cols: NDArray[np.int64]
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
    index: NDArray[np.int64]
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
class Network:
    """states : their names; hidden shapes are "PART#1", "PART#2", ...
    C : (n,) heat capacities (J/K), 0 where a node has none
    capacity_group : for every state the name of its capacity group (a part and its shapes share one)
    boundaries : names of the temperatures given from outside ("ambient", "coolant.in", ...)
    parameters : what calibration may move
    settles_s : time constant (s) of the whole, roughly; with C it says how large a missing path usually is
    declared : what parts, nodes, fluids and boundaries are said to be, by name
    quantities : input -> what it measures ("speed");  signals : quantity -> the input of the machine's own
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
    file: str = field(default="", compare=False)

    def __repr__(self) -> str:
        return f"<{self.title}: {self.sizes}; boundaries {', '.join(self.boundaries) or 'none'}>"

    @property
    def sizes(self) -> str:
        """How many states, links and sources, in words."""
        each = (self.states, "state"), (self.links, "link"), (self.sources, "source")
        return ", ".join(counted(len(items), what) for items, what in each)

    @property
    def title(self) -> str:
        """How messages call it."""
        return f"network '{self.name}'" + (f" of {self.file}" if self.file else "")

    @cached_property
    def identities(self) -> Mapping[str, Identity]:
        """What everything with a name is: as declared, and where nothing is, as guessed from the network alone."""
        from lumped.model.guess import identities

        return identities(self)

    def on_parts(self, parts: Iterable[str], x: Array) -> Array:
        """(n_nodes, ...) temperature (degC) on the parts' own nodes, of states x (n_states, ...) or of changes of them.

        InputError for a network that was declared by hand: it has no field behind it.
        """
        if self.recovery is None:
            raise InputError("has no field behind it", self.title, "a network that was condensed from a machine")
        return np.concatenate([self.recovery.of_part(part, x) for part in parts])

    def measures(self, name: str) -> str:
        """What an input measures; "" where nothing says."""
        return self.quantities.get(name, USUAL.get(name, ""))

    def signal(self, quantity: str) -> str:
        """The input that carries a quantity of the machine, e.g. "speed"; the usual one where nothing says."""
        return self.signals.get(quantity, INPUTS[quantity])

    @property
    def inputs(self) -> set[str]:
        """Names of the signals that the laws read (e.g. "current_A"), with their units in the name."""
        items: list[Link | Source] = [*self.links, *self.sources]
        return {name for item in items for name in item.law.reads}

    @property
    def heated(self) -> tuple[str, ...]:
        """Nodes into which some source puts heat, by whatever share, in the order of the states; no shapes."""
        mask = np.zeros(self.size, bool)
        for source in self.sources:
            mask[source.index[source.weights != 0.0]] = True
        return tuple(
            s for s, heats in zip(self.states, mask[: len(self.states)], strict=True) if heats and "#" not in s
        )

    @property
    def size(self) -> int:
        return len(self.states) + len(self.boundaries)

    def column(self, name: str) -> int:
        """Column of z that holds a named state or boundary."""
        if name in self.states:
            return self.states.index(name)
        if name in self.boundaries:
            return len(self.states) + self.boundaries.index(name)
        nodes = ", ".join([*(s for s in self.states if "#" not in s), *self.boundaries])
        raise InputError(f"unknown node or boundary '{name}'", self.title, f"known: {nodes}")

    def place(self, name: str) -> Place:
        if name not in self.places:
            raise InputError(f"unknown place '{name}'", self.title, f"known: {', '.join(sorted(self.places))}")
        return self.places[name]

    def extended(
        self, links: Iterable[Link] = (), sources: Iterable[Source] = (), parameters: Iterable[Parameter] = ()
    ) -> Network:
        """The same network with more physics; nothing already there changes."""
        return replace(
            self,
            links=(*self.links, *links),
            sources=(*self.sources, *sources),
            parameters=(*self.parameters, *parameters),
        )

    def surface_link(self, name: str, kind: str, place: str, other: str, law: Law) -> Link:
        """A link from a place to a fluid node or boundary, exact on the place's own shape of temperature."""
        p, col = self.place(place), self.column(other)
        k = len(p.states)
        weight = p.area if p.area is not None else 1.0
        rows = [np.repeat(p.states, k), p.states]
        cols = [np.tile(p.states, k), np.full(k, col)]
        vals = [p.K.ravel(), -p.b]
        if col < len(self.states):
            rows += [np.full(k, col), np.array([col])]
            cols += [p.states, np.array([col])]
            vals += [-p.b, np.array([weight])]
        cold = Row(np.array([col]), np.array([1.0]))
        return Link(
            name,
            kind,
            (place, other),
            np.concatenate(rows),
            np.concatenate(cols),
            np.concatenate(vals),
            law,
            p.mean,
            cold,
        )
