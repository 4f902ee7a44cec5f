"""A thermal network: states, links, sources, places and parameters.

One form serves hand-declared networks and networks condensed from a field:

    C dx/dt = - sum_l m_l g_l(t, T) P_l z  +  sum_s m_s q_s(t, T) f_s ,      z = [x; u]

x are the states (temperatures of named nodes, and for condensed networks the hidden shape
amplitudes), u the boundary temperatures, P_l the fixed pattern of link l, g_l its coefficient,
f_s the distribution of source s, and m the multipliers that parameters act on (1 when no
parameter does). Every coefficient g and q factorises into an input factor, evaluated once for a
whole record, times one temperature law (see laws.py).
"""

from collections.abc import Iterable, KeysView, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from geom.description.roles import Identity
from geom.errors import InputError
from geom.table import Table, TableResult
from geom.text import counted
from lumped.model.quantities import INPUTS
from lumped.model.structure import NOTHING, Array, Link, Parameter, Place, Recovery, Row, Source, Structure
from lumped.transfer.laws import Law

__all__ = ["NOTHING", "Array", "Link", "Network", "Parameter", "Place", "Recovery", "Row", "Source"]


@dataclass(frozen=True)
class Network(Structure, TableResult):
    """A structure, what it says of itself, and networks made from it."""

    def __repr__(self) -> str:
        return f"<{self.title}: {self.sizes}; boundaries {', '.join(self.boundaries) or 'none'}>"

    def tables(self) -> tuple[Table, ...]:
        """What may be calibrated."""
        columns = "parameter=name | value | unit | prior sd=prior_sd"
        return (Table.of("What may be calibrated", self.parameters, columns),)

    @property
    def sizes(self) -> str:
        """How many states, links and sources, in words."""
        each = (self.states, "state"), (self.links, "link"), (self.sources, "source")
        return ", ".join(counted(len(items), what) for items, what in each)

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

    def signal(self, quantity: str) -> str:
        """The input that carries a quantity of the machine, e.g. "speed"; the usual one where nothing says."""
        return self.signals.get(quantity, INPUTS[quantity])

    @property
    def elements(self) -> list[Link | Source]:
        """Links, then sources."""
        return [*self.links, *self.sources]

    @property
    def inputs(self) -> KeysView[str]:
        """Names of the signals that the laws read (e.g. "current_A"), with their units in the name; the first first."""
        return dict.fromkeys(name for item in self.elements for name in item.law.reads).keys()

    @property
    def heated(self) -> tuple[str, ...]:
        """Nodes into which some source puts heat, by whatever share, in the order of the states; no shapes."""
        mask = np.zeros(self.size, bool)
        for source in self.sources:
            mask[source.index[source.weights != 0.0]] = True
        each = zip(self.states, mask[: len(self.states)], strict=True)
        return tuple(s for s, heats in each if heats and "#" not in s)

    @property
    def size(self) -> int:
        return len(self.states) + len(self.boundaries)

    def place(self, name: str) -> Place:
        if name not in self.places:
            raise InputError(f"unknown place '{name}'", self.title, f"known: {', '.join(sorted(self.places))}")
        return self.places[name]

    def extended(
        self, links: Iterable[Link] = (), sources: Iterable[Source] = (), parameters: Iterable[Parameter] = ()
    ) -> "Network":
        """The same network with more physics; nothing already there changes."""
        every = (*self.parameters, *parameters)
        return replace(self, links=(*self.links, *links), sources=(*self.sources, *sources), parameters=every)

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
        row, column, value = (np.concatenate(x) for x in (rows, cols, vals))
        cold = Row(np.array([col]), np.array([1.0]))
        return Link(name, kind, (place, other), row, column, value, law, p.mean, cold)
