"""From field to network: each part becomes a mean node, with its true heat capacity, plus shapes with their own time constants.

Whole-machine solutions (snapshots) are restricted to each part, their mean is taken off, and what is left is compressed in
the part's own energy. Contacts and films stay links of their own, linear in their coefficients; every one of them may change
afterwards at no cost. This is the only file of the room that knows `fem`.

    C_i dT_i/dt   = P_i + heat in through links         T_i mean temperature of part i
    tau_k da_k/dt = -a_k + heat in weighted by shape k  a_k amplitude of a shape, in sqrt(W K)
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from fem.assembly import Block, FieldModel, Touch, Trace
from fem.solve import Solver
from lumped.laws import Fixed
from lumped.network import Array, Link, Network, Place, Row
from lumped.recovery import PartShape, Shapes

SHIFTS = (1 / 3, 1 / 20, 1 / 120, 1 / 700)  # 1/s


@dataclass(frozen=True)
class Recipe:
    """How fine the condensation is.

    tolerance : energy of a snapshot that may be lost, relative; smaller gives more states
    shifts : Laplace shifts (1/s) that resolve the early minutes
    random_points : points with every film and contact times 5 ** U(-1, 1), so that shapes know changed coefficients
    """

    tolerance: float = 0.01
    shifts: tuple[float, ...] = SHIFTS
    random_points: int = 4
    spread: float = 5.0
    seed: int = 1


@dataclass(frozen=True)
class Basis:
    """Shapes of one part: Phi (n, k), Phi' K Phi = 1, Phi' M Phi = diag(tau), mean zero;  tau (k,) s."""

    Phi: Array
    tau: Array


def snapshots(
    field: FieldModel, films: Mapping[str, float], contacts: Mapping[str, float], recipe: Recipe, solver: Solver | None = None
) -> Array:
    """(n, n_snapshot) whole-machine solutions, each of unit energy in the nominal machine."""
    solver = solver or Solver(field)
    zones = np.column_stack([field.load(part) for part in field.blocks])
    nominal = field.stiffness(films, contacts)
    out = [solver.factor(nominal)(np.column_stack([zones, *_fluxes(field), *_dipoles(field)]))]
    out += [solver.factor(nominal, shift)(zones) for shift in recipe.shifts]
    rng = np.random.default_rng(recipe.seed)
    for _ in range(recipe.random_points):
        h, g = drawn(films, recipe.spread, rng), drawn(contacts, recipe.spread, rng)
        out.append(solver.factor(field.stiffness(h, g))(zones))
    S = np.column_stack(out)
    return np.asarray(S / np.sqrt(np.einsum("ij,ij->j", S, nominal @ S)))


def drawn(coefficients: Mapping[str, float], spread: float, rng: np.random.Generator) -> dict[str, float]:
    """Every coefficient times spread ** U(-1, 1)."""
    return {name: value * spread ** rng.uniform(-1, 1) for name, value in coefficients.items()}


def _fluxes(field: FieldModel) -> list[Array]:
    return [_at(field.n, (f.trace, 1.0)) for f in field.films.values()]


def _dipoles(field: FieldModel) -> list[Array]:
    return [_at(field.n, (t.a, 1.0), (t.b, -1.0)) for t in field.contacts.values()]


def _at(n: int, *sides: tuple[Trace, float]) -> Array:
    out = np.zeros(n)
    for trace, sign in sides:
        out[trace.dofs] += sign * trace.b / trace.area
    return out


def bases(field: FieldModel, S: Array, tolerance: float) -> dict[str, Basis]:
    """Shapes of every part from the snapshots."""
    return {name: _basis(block, S[block.dofs], tolerance) for name, block in field.blocks.items()}


def _basis(block: Block, S: Array, tolerance: float) -> Basis:
    S = S - (block.w @ S) / block.volume
    energy, U = np.linalg.eigh(S.T @ (block.K @ S))
    keep = energy > max(tolerance**2, 1e-13 * energy[-1])
    Phi = S @ (U[:, keep] / np.sqrt(energy[keep]))
    Phi -= (block.w @ Phi) / block.volume
    tau, R = np.linalg.eigh(Phi.T @ (block.M @ Phi))
    return Basis(Phi @ R[:, ::-1], tau[::-1])


def condense(
    field: FieldModel,
    films: Mapping[str, float],
    contacts: Mapping[str, float],
    fluids: Mapping[str, float],
    boundaries: tuple[str, ...] = ("ambient",),
    recipe: Recipe = Recipe(),
    name: str = "machine",
    cache: Path | None = None,
) -> Network:
    """The network of a field: conduction and contacts as links, faces and parts as places. Films are added by whoever knows them.

    films, contacts : coefficients (W/m2/K) the shapes are centred on, by face and by contact
    fluids : fluid node -> heat capacity (J/K), 0 allowed;  boundaries : fluids whose temperature is given
    """
    found = _cached(field, films, contacts, recipe, cache)
    return project(field, found, contacts, fluids, boundaries, name)


def _cached(
    field: FieldModel, films: Mapping[str, float], contacts: Mapping[str, float], recipe: Recipe, cache: Path | None
) -> dict[str, Basis]:
    if cache is None:
        return bases(field, snapshots(field, films, contacts, recipe), recipe.tolerance)
    file = cache / f"basis-{_fingerprint(field, films, contacts, recipe)}.npz"
    if file.exists():
        with np.load(file) as saved:
            return {part: Basis(saved[f"{part}/Phi"], saved[f"{part}/tau"]) for part in field.blocks}
    found = bases(field, snapshots(field, films, contacts, recipe), recipe.tolerance)
    cache.mkdir(parents=True, exist_ok=True)
    partial = file.with_suffix(".partial.npz")
    np.savez(partial, **{f"{p}/{k}": v for p, b in found.items() for k, v in (("Phi", b.Phi), ("tau", b.tau))})  # type: ignore[arg-type]
    partial.replace(file)
    return found


def _fingerprint(
    field: FieldModel, films: Mapping[str, float], contacts: Mapping[str, float], recipe: Recipe
) -> str:
    h = hashlib.sha256(repr((sorted(films.items()), sorted(contacts.items()), recipe, list(field.blocks))).encode())
    h.update(np.ascontiguousarray(field.xyz).tobytes())
    for block in field.blocks.values():
        h.update(block.K.data.tobytes() + block.M.data.tobytes())
    return h.hexdigest()[:20]


def project(
    field: FieldModel,
    found: Mapping[str, Basis],
    contacts: Mapping[str, float],
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
        own = np.arange(len(states), len(states) + 1 + len(basis.tau))
        states += [part, *(f"{part}#{k + 1}" for k in range(len(basis.tau)))]
        C += [block.capacity, *basis.tau]
        groups += [part] * len(own)
        V = np.column_stack([np.ones(len(block.points)), basis.Phi])
        shapes[part] = PartShape(block.points, block.xyz, block.tets, V, own)
    states, C, groups = [*states, *fluids], [*C, *fluids.values()], [*groups, *fluids]
    conduction = [_conduction(part, shape) for part, shape in shapes.items() if len(shape.states) > 1]
    links = [_contact(field, shapes, key, touch, contacts[key]) for key, touch in field.contacts.items()]
    places = {key: _surface(field, shapes, key) for key in field.films}
    places |= {part: _mean(part, "part", shape.states[:1]) for part, shape in shapes.items()}
    places |= {f: _mean(f, "fluid", np.array([states.index(f)])) for f in fluids}
    return Network(
        name, tuple(states), np.array(C), boundaries, (*conduction, *links), (), places, tuple(groups), (), Shapes(shapes)
    )  # fmt: skip


def _conduction(part: str, shape: PartShape) -> Link:
    inner, one = shape.states[1:], np.ones(1)
    mean = Row(shape.states[:1], one)
    return Link(f"conduction:{part}", "conduction", (part, part), inner, inner, np.ones(len(inner)), Fixed(1.0), mean, mean)


def _mean(name: str, kind: str, states: Array) -> Place:
    return Place(name, kind, name, states, np.ones((1, 1)), np.ones(1))  # type: ignore[arg-type]


def _restricted(field: FieldModel, shape: PartShape, trace: Trace) -> Array:
    """The part's states seen on one side of a surface, (m, k)."""
    return shape.V[trace.dofs - field.blocks[trace.part].dofs.start]


def _surface(field: FieldModel, shapes: Mapping[str, PartShape], key: str) -> Place:
    trace = field.films[key].trace
    shape = shapes[trace.part]
    X = _restricted(field, shape, trace)
    return Place(key, "surface", trace.part, shape.states, X.T @ (trace.mass @ X), X.T @ trace.b, trace.area, field.films[key].fluid)


def _contact(field: FieldModel, shapes: Mapping[str, PartShape], key: str, touch: Touch, g: float) -> Link:
    a, b = shapes[touch.a.part], shapes[touch.b.part]
    Xa, Xb = _restricted(field, a, touch.a), _restricted(field, b, touch.b)
    X = np.hstack([Xa, -Xb])
    both = np.concatenate([a.states, b.states])
    P = sp.coo_array(X.T @ (touch.a.mass @ X))
    hot, cold = (Row(s.states, Y.T @ touch.a.b / touch.area) for s, Y in ((a, Xa), (b, Xb)))
    pair = (touch.a.part, touch.b.part)
    return Link(f"contact:{key}", "contact", pair, both[P.row], both[P.col], P.data, Fixed(g), hot, cold)
