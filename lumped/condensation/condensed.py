"""The network of a field in a given basis: a mean node with its true heat capacity and shapes for every part.

C_i dT_i/dt = P_i + heat in through links               T_i mean temperature of part i
c_k da_k/dt = -k_k a_k + heat in weighted by shape k    a_k amplitude of a shape, in sqrt(W K)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from lumped.condensation.recovery import PartShape, Shapes
from lumped.model.network import Array, Link, Network, Place, Row
from lumped.transfer.laws import Fixed

if TYPE_CHECKING:
    from fem.matrices.assembly import FieldModel
    from fem.matrices.surface import Touch, Trace
    from fem.solvers.snapshots import Basis


@dataclass(frozen=True)
class Zone:
    """Where in a part a loss sits: density per tetrahedron, or of tetrahedron centres (m); None is uniform."""

    part: str
    density: Callable[[Array], Array] | Array | None = None


def network_in(
    field: FieldModel,
    bases: Mapping[str, Basis],
    contacts: Mapping[str, float],
    loads: Mapping[str, Array],
    whole: frozenset[str],
    fluids: Mapping[str, float],
    boundaries: tuple[str, ...],
    name: str,
) -> Network:
    """The network of a field in given bases: conduction and contacts as links, faces, parts and zones as places.

    field : fem.matrices.assembly.FieldModel;  bases : part -> its shapes;  contacts : W/m2/K
    loads : zone -> (n,) unit loss;  whole : the zones that are a whole part, uniformly heated
    """
    states: list[str] = []
    C: list[float] = []
    groups: list[str] = []
    shapes: dict[str, PartShape] = {}
    for part, block in field.blocks.items():
        basis = bases[part]
        part_states = np.arange(len(states), len(states) + 1 + len(basis.capacity))
        states += [part, *(f"{part}#{k + 1}" for k in range(len(basis.capacity)))]
        C += [block.capacity, *basis.capacity]
        groups += [part] * len(part_states)
        shapes[part] = PartShape(block.points, block.elements, basis.V, block.w / block.volume, part_states)
    states, C, groups = [*states, *fluids], [*C, *fluids.values()], [*groups, *fluids]
    links = [_conduction(part, shape, bases[part]) for part, shape in shapes.items() if len(shape.states) > 1]
    links += [_contact(field, shapes, key, touch, contacts[key]) for key, touch in field.contacts.items()]
    places = {key: _surface(field, shapes, key) for key in field.films}
    places |= {key: _loss(field, shapes, key, load, key in whole) for key, load in loads.items()}
    places |= {f: Place(f, "fluid", f, np.array([states.index(f)]), np.ones((1, 1)), np.ones(1)) for f in fluids}
    return Network(
        name, tuple(states), np.array(C), boundaries, tuple(links), (), places, tuple(groups), (), Shapes(shapes)
    )


def _conduction(part: str, shape: PartShape, basis: Basis) -> Link:
    inner, mean = shape.states[1:], Row(shape.states[:1], np.ones(1))
    return Link(
        f"conduction:{part}", "conduction", (part, part), inner, inner, basis.conduction, Fixed(1.0), mean, mean
    )


def _loss(field: FieldModel, shapes: Mapping[str, PartShape], key: str, load: Array, whole: bool) -> Place:
    """A unit loss spreads over the part's states just as the zone's mean temperature reads them."""
    if whole:
        return Place(key, "part", key, shapes[key].states[:1], np.ones((1, 1)), np.ones(1))
    part = next(name for name, block in field.blocks.items() if load[block.dofs].any())
    b = load[field.blocks[part].dofs] @ shapes[part].V
    return Place(key, "part", part, shapes[part].states, np.outer(b, b), b)


def _restricted(field: FieldModel, shape: PartShape, trace: Trace) -> Array:
    """The part's states seen on one side of a surface, (m, k)."""
    return shape.V[trace.dofs - field.blocks[trace.part].dofs.start]


def _surface(field: FieldModel, shapes: Mapping[str, PartShape], key: str) -> Place:
    trace = field.films[key].trace
    shape = shapes[trace.part]
    X = _restricted(field, shape, trace)
    K, b = X.T @ (trace.mass @ X), X.T @ trace.b
    return Place(key, "surface", trace.part, shape.states, K, b, trace.area, field.films[key].fluid)


def _contact(field: FieldModel, shapes: Mapping[str, PartShape], key: str, touch: Touch, g: float) -> Link:
    a, b = shapes[touch.a.part], shapes[touch.b.part]
    Xa, Xb = _restricted(field, a, touch.a), _restricted(field, b, touch.b)
    both, across = np.concatenate([a.states, b.states]), Xa.T @ (touch.cross @ Xb)
    P = sp.coo_array(np.block([[Xa.T @ (touch.a.mass @ Xa), -across], [-across.T, Xb.T @ (touch.b.mass @ Xb)]]))
    sides = ((a, Xa, touch.a), (b, Xb, touch.b))
    hot, cold = (Row(s.states, Y.T @ t.b / touch.area) for s, Y, t in sides)
    pair = (touch.a.part, touch.b.part)
    return Link(f"contact:{key}", "contact", pair, both[P.row], both[P.col], P.data, Fixed(g), hot, cold)
