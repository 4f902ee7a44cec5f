"""A condensed network at given coefficients, as dense matrices: for training, checks and steady questions."""

from dataclasses import dataclass

import numpy as np

from geom.arrays import Ints, Numbers
from lumped.model.network import Array, Link, Network
from lumped.transfer.laws import CONSTANT, Fixed


@dataclass(frozen=True)
class Linear:
    """Solid states only: C dx/dt = -A x + B u + loads;  A (n, n) W/K, B (n, n_fluid) W/K.

    solid (n,), fluid (n_fluid,) : columns of the network's z = [states; boundaries]
    """

    A: Array
    B: Array
    C: Array
    solid: Ints
    fluid: Ints


def linear(network: Network, films: Numbers, contacts: Numbers, conductivity: Numbers | None = None) -> Linear:
    """The solids of a condensed network with every fluid given; h and g in W/m2/K, factors on the conductivities."""
    factors = conductivity or {}
    P = np.zeros((len(network.states), network.size))
    for link in network.links:
        key = link.name.removeprefix(f"{link.kind}:")
        if link.kind == "contact":
            _add(P, link, contacts[key])
        elif link.kind == "conduction":
            _add(P, link, factors.get(key, 1.0))
    for place in network.places.values():
        if place.kind == "surface" and place.fluid:
            _add(P, network.surface_link("", "film", place.name, place.fluid, Fixed(1.0, CONSTANT)), films[place.name])
    fluids = np.arange(network.size) >= len(network.states)
    fluids[[p.states[0] for p in network.places.values() if p.kind == "fluid"]] = True
    solid, fluid = np.flatnonzero(~fluids), np.flatnonzero(fluids)
    return Linear(P[np.ix_(solid, solid)], -P[np.ix_(solid, fluid)], network.C[solid], solid, fluid)


def _add(P: Array, link: Link, factor: float) -> None:
    np.add.at(P.reshape(-1), link.rows * P.shape[1] + link.cols, factor * link.vals)  # a tenth of the time of pairs


def unit_load(network: Network, place: str, solid: Ints) -> Array:
    """(n,) 1 W at a part or loss zone, on the solid states."""
    p = network.place(place)
    out = np.zeros(network.size)
    out[p.states] = p.b
    return out[solid]
