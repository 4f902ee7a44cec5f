"""From field to network: each part becomes a mean node with its true heat capacity, plus shapes of its own.

Whole-machine solutions (snapshots) are restricted to each part, their mean is taken off, and what is left is
compressed in the part's own energy. Contacts and films stay links of their own, linear in their coefficients; every
one of them may change afterwards at no cost. This is the only file of the room that knows `fem`.

    C_i dT_i/dt = P_i + heat in through links               T_i mean temperature of part i
    c_k da_k/dt = -k_k a_k + heat in weighted by shape k    a_k amplitude of a shape, in sqrt(W K)
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from fem.assembly import FieldModel, Touch, Trace
from fem.snapshots import DEFAULT, Basis, Recipe, bases, energies, snapshots
from lumped.laws import Fixed
from lumped.network import Array, Link, Network, Place, Row
from lumped.recovery import PartShape, Shapes

__all__ = ["Recipe", "Zone", "condense"]


@dataclass(frozen=True)
class Zone:
    """Where in a part a loss sits: density per tetrahedron, or of tetrahedron centres (m); None is uniform."""

    part: str
    density: Callable[[Array], Array] | Array | None = None


@dataclass(frozen=True)
class Nominal:
    """The point the condensation is centred on: films h and contacts g (W/m2/K), unit losses."""

    films: Mapping[str, float]
    contacts: Mapping[str, float]
    loads: Mapping[str, Array]


def condense(
    field: FieldModel,
    films: Mapping[str, float],
    contacts: Mapping[str, float],
    fluids: Mapping[str, float],
    boundaries: tuple[str, ...] = ("ambient",),
    recipe: Recipe = DEFAULT,
    name: str = "machine",
    cache: Path | None = None,
    zones: Mapping[str, Zone] | None = None,
) -> Network:
    """The network of a field: conduction and contacts as links, faces and parts as places; no films yet.

    films, contacts : coefficients (W/m2/K) the shapes are centred on, by face and by contact
    fluids : fluid node -> heat capacity (J/K), 0 allowed;  boundaries : fluids whose temperature is given
    zones : losses that vary alone, by name, beside one uniform loss per part; each becomes a place
    """
    places = {**{part: Zone(part) for part in field.blocks}, **(zones or {})}
    loads = {key: field.load(zone.part, zone.density) for key, zone in places.items()}
    nominal = Nominal(films, contacts, loads)
    found = _cached(field, nominal, recipe, cache)
    return _network(field, found, nominal, places, fluids, boundaries, name)


def _build(field: FieldModel, nominal: Nominal, recipe: Recipe) -> dict[str, Basis]:
    loads = np.column_stack([*nominal.loads.values()])
    S = snapshots(field, nominal.films, nominal.contacts, loads, recipe)
    return bases(field, S, energies(field, nominal.films, nominal.contacts), recipe)


def _cached(field: FieldModel, nominal: Nominal, recipe: Recipe, cache: Path | None) -> dict[str, Basis]:
    if cache is None:
        return _build(field, nominal, recipe)
    file = cache / f"basis-{_fingerprint(field, nominal, recipe)}.npz"
    if file.exists():
        with np.load(file) as saved:
            return {part: Basis(*(saved[f"{part}/{k}"] for k in COLUMNS)) for part in field.blocks}
    found = _build(field, nominal, recipe)
    cache.mkdir(parents=True, exist_ok=True)
    partial = file.with_suffix(".partial.npz")
    np.savez(partial, **{f"{p}/{k}": getattr(b, k) for p, b in found.items() for k in COLUMNS})
    partial.replace(file)
    return found


COLUMNS = ("Phi", "capacity", "conduction")


def _fingerprint(field: FieldModel, nominal: Nominal, recipe: Recipe) -> str:
    point = [sorted(m.items()) for m in (nominal.films, nominal.contacts)]
    h = hashlib.sha256(repr((point, recipe, list(field.blocks), list(nominal.loads))).encode())
    h.update(np.ascontiguousarray(field.xyz).tobytes())
    for block in field.blocks.values():
        h.update(block.K.data.tobytes() + block.M.data.tobytes())
    for load in nominal.loads.values():
        h.update(load.tobytes())
    return h.hexdigest()[:20]


def _network(
    field: FieldModel,
    found: Mapping[str, Basis],
    nominal: Nominal,
    zones: Mapping[str, Zone],
    fluids: Mapping[str, float],
    boundaries: tuple[str, ...],
    name: str,
) -> Network:
    """The network in a given basis."""
    states: list[str] = []
    C: list[float] = []
    groups: list[str] = []
    shapes: dict[str, PartShape] = {}
    for part, block in field.blocks.items():
        basis = found[part]
        own = np.arange(len(states), len(states) + 1 + len(basis.capacity))
        states += [part, *(f"{part}#{k + 1}" for k in range(len(basis.capacity)))]
        C += [block.capacity, *basis.capacity]
        groups += [part] * len(own)
        V = np.column_stack([np.ones(len(block.points)), basis.Phi])
        shapes[part] = PartShape(block.points, block.xyz, block.tets, V, own)
    states, C, groups = [*states, *fluids], [*C, *fluids.values()], [*groups, *fluids]
    links = [_conduction(part, shape, found[part]) for part, shape in shapes.items() if len(shape.states) > 1]
    links += [_contact(field, shapes, key, touch, nominal.contacts[key]) for key, touch in field.contacts.items()]
    places = {key: _surface(field, shapes, key) for key in field.films}
    places |= {key: _loss(field, shapes, key, zone, nominal.loads[key]) for key, zone in zones.items()}
    places |= {f: _fluid(f, states.index(f)) for f in fluids}
    return Network(
        name, tuple(states), np.array(C), boundaries, tuple(links), (), places, tuple(groups), (), Shapes(shapes)
    )


def _conduction(part: str, shape: PartShape, basis: Basis) -> Link:
    inner, mean = shape.states[1:], Row(shape.states[:1], np.ones(1))
    return Link(
        f"conduction:{part}", "conduction", (part, part), inner, inner, basis.conduction, Fixed(1.0), mean, mean
    )


def _fluid(name: str, state: int) -> Place:
    return Place(name, "fluid", name, np.array([state]), np.ones((1, 1)), np.ones(1))


def _loss(field: FieldModel, shapes: Mapping[str, PartShape], key: str, zone: Zone, load: Array) -> Place:
    """A unit loss spreads over the part's states just as the zone's mean temperature reads them."""
    if key == zone.part and zone.density is None:
        return Place(key, "part", key, shapes[key].states[:1], np.ones((1, 1)), np.ones(1))
    shape = shapes[zone.part]
    b = load[field.blocks[zone.part].dofs] @ shape.V
    return Place(key, "part", zone.part, shape.states, np.outer(b, b), b)


def _restricted(field: FieldModel, shape: PartShape, trace: Trace) -> Array:
    """The part's states seen on one side of a surface, (m, k)."""
    return shape.V[trace.dofs - field.blocks[trace.part].dofs.start]


def _surface(field: FieldModel, shapes: Mapping[str, PartShape], key: str) -> Place:
    trace = field.films[key].trace
    shape = shapes[trace.part]
    X = _restricted(field, shape, trace)
    return Place(
        key,
        "surface",
        trace.part,
        shape.states,
        X.T @ (trace.mass @ X),
        X.T @ trace.b,
        trace.area,
        field.films[key].fluid,
    )


def _contact(field: FieldModel, shapes: Mapping[str, PartShape], key: str, touch: Touch, g: float) -> Link:
    a, b = shapes[touch.a.part], shapes[touch.b.part]
    Xa, Xb = _restricted(field, a, touch.a), _restricted(field, b, touch.b)
    X = np.hstack([Xa, -Xb])
    both = np.concatenate([a.states, b.states])
    P = sp.coo_array(X.T @ (touch.a.mass @ X))
    hot, cold = (Row(s.states, Y.T @ touch.a.b / touch.area) for s, Y in ((a, Xa), (b, Xb)))
    pair = (touch.a.part, touch.b.part)
    return Link(f"contact:{key}", "contact", pair, both[P.row], both[P.col], P.data, Fixed(g), hot, cold)
