"""Whole-machine solutions to learn from, and what each part's temperature field looks like in them.

A part's field is its mean plus shapes. The shapes are found in the part's own share of the energy (its conduction and
its sides of contacts and films at nominal coefficients), so the separate pieces of one part are told apart too.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from fem.matrices.assembly import Block, FieldModel, Trace
from fem.solvers.local import local_solutions, of_unit_energy, unit_energy_scale
from fem.solvers.solve import Factorise, Solve, Solver
from fem.solvers.two_processes import in_two_processes
from geom.arrays import Array as Floats

SHIFTS = (1 / 3, 1 / 20, 1 / 120, 1 / 700)  # 1/s
LITTLE = 0.02  # of the machine's volume: of such a part the hot spot is one of little energy
CHUNK = 128  # fields that a matrix is multiplied with at a time, so that memory stays small


@dataclass(frozen=True)
class Recipe:
    """How fine the condensation is.

    tolerance : energy of a snapshot that may be lost, relative; smaller gives more states
    shifts : Laplace shifts (1/s) at which losses are solved, so that the early minutes are resolved
    flux_shifts : shifts at which a unit flux through every face is solved too
    random_points : points with every film and contact times spread ** U(-1, 1): shapes know changed coefficients
    film_factors : least and largest factor on films at these points, where they are to reach further than contacts
    flux_points : solve the unit fluxes at the random points too
    local_points : further points at which each part is solved for alone, between neighbours in `local_states` states
    joined_contacts : factors on all contacts at once, at which losses are solved, steady and at the shifts: corners of
        the range that random points do not reach
    opposed_contacts : factor that each contact of a part of little volume has in turn at such points, the part's other
        contacts and its films the inverse; 1: no such points. What lies thin between two others is as warm as either
    favour : weight on the root of energy of parts that losses heat, since their hot spots are what is asked for
    thin : the same weight for parts of little volume, heated or not; by energy alone they have too few shapes
    max_states : largest number of mean nodes and shapes together; parts compete for shapes by energy; 0: the means
        alone, for which nothing is solved
    """

    tolerance: float = 0.01
    shifts: tuple[float, ...] = SHIFTS
    flux_shifts: tuple[float, ...] = ()
    random_points: int = 4
    flux_points: bool = False
    local_points: int = 0
    local_states: int = 40
    spread: float = 5.0
    seed: int = 1
    max_states: int | None = None
    film_factors: tuple[float, float] | None = None
    joined_contacts: tuple[float, ...] = ()
    opposed_contacts: float = 1.0
    favour: float = 1.0
    thin: float = 1.0

    def other_films(self, films: Mapping[str, float], rng: np.random.Generator) -> dict[str, float]:
        """Those of a random point."""
        if self.film_factors is None:
            return random_coefficients(films, self.spread, rng)
        low, high = np.log(self.film_factors)
        return {name: value * float(np.exp(rng.uniform(low, high))) for name, value in films.items()}


DEFAULT = Recipe()


@dataclass(frozen=True)
class Basis:
    """Shapes of one part: Phi (n, k) of mean zero, Phi' M Phi = diag(capacity), Phi' K Phi = diag(conduction).

    V : (n, 1 + k) a field of ones, for the mean, and Phi
    """

    V: Floats
    capacity: Floats
    conduction: Floats


@dataclass(frozen=True)
class Principal:
    """Fields (n, k) of one part, orthonormal in its energy, strongest first, and the energy (k,) each stands for."""

    strength: NDArray[np.floating]
    fields: NDArray[np.floating]


def snapshots(
    field: FieldModel,
    films: Mapping[str, float],
    contacts: Mapping[str, float],
    loads: Floats,
    recipe: Recipe,
    solver: Solve | None = None,
) -> Floats:
    """(n, n_snapshot) whole-machine solutions for unit losses `loads` (n, n_zone), each of unit energy at nominal."""
    solver = solver or Solver(field)
    nominal = field.stiffness(films, contacts)
    fluxes = np.column_stack([field.flux(face) for face in field.films])
    both = np.column_stack([loads, fluxes])
    dipoles = [_at(field.n, (t.a, 1.0), (t.b, -1.0)) for t in field.contacts.values()]
    points = [(films, contacts, 0.0, np.column_stack([both, *dipoles]))]
    points += [(films, contacts, shift, loads) for shift in recipe.shifts]
    points += [(films, contacts, shift, fluxes) for shift in recipe.flux_shifts]
    rng = np.random.default_rng(recipe.seed)
    for _ in range(recipe.random_points):
        h, g = recipe.other_films(films, rng), random_coefficients(contacts, recipe.spread, rng)
        points.append((h, g, 0.0, both if recipe.flux_points else loads))
    for factor in recipe.joined_contacts:
        larger = {name: factor * g for name, g in contacts.items()}
        points += [(films, larger, shift, loads) for shift in (0.0, *recipe.shifts)]
    if recipe.opposed_contacts != 1.0:
        points += [(h, g, 0.0, loads) for h, g in opposed_points(field, films, contacts, recipe.opposed_contacts)]

    def solved(factor: Factorise, point: tuple[Mapping[str, float], Mapping[str, float], float, Floats]) -> Floats:
        h, g, shift, heat = point
        return of_unit_energy(factor(field.stiffness(h, g), shift)(heat), nominal)

    # Another solver may have threads of its own, which a fork would leave behind.
    if isinstance(solver, Solver):
        return np.column_stack(solver.each(solved, points))
    return np.column_stack([solved(solver.factor, point) for point in points])


def random_coefficients(coefficients: Mapping[str, float], spread: float, rng: np.random.Generator) -> dict[str, float]:
    """Every coefficient times spread ** U(-1, 1)."""
    return {name: value * spread ** rng.uniform(-1, 1) for name, value in coefficients.items()}


def little_parts(field: FieldModel) -> tuple[str, ...]:
    """Parts whose hot spots are ones of little energy."""
    least = LITTLE * sum(block.volume for block in field.blocks.values())
    return tuple(name for name, block in field.blocks.items() if block.volume < least)


def opposed_points(
    field: FieldModel, films: Mapping[str, float], contacts: Mapping[str, float], factor: float
) -> list[tuple[dict[str, float], dict[str, float]]]:
    """Films and contacts (W/m2/K) where every part of little volume is as warm as one of its neighbours.

    At the k-th point its k-th contact is `factor` times as large, its other contacts and its films 1 / `factor` times;
    parts with fewer contacts begin again, parts with one stay as they are.
    """
    sides = {
        part: [key for key, touch in field.contacts.items() if part in (touch.a.part, touch.b.part)]
        for part in little_parts(field)
    }
    sides = {part: keys for part, keys in sides.items() if len(keys) > 1}
    out = []
    for k in range(max(map(len, sides.values()), default=0)):
        h, g = dict(films), dict(contacts)
        for part, keys in sides.items():
            near = keys[k % len(keys)]
            g |= {key: contacts[key] * (factor if key == near else 1.0 / factor) for key in keys}
            h |= {face: films[face] / factor for face, film in field.films.items() if film.trace.part == part}
        out.append((h, g))
    return out


def _at(n: int, *sides: tuple[Trace, float]) -> Floats:
    out = np.zeros(n)
    for trace, sign in sides:
        out[trace.dofs] += sign * trace.b / trace.area
    return out


def energies(field: FieldModel, films: Mapping[str, float], contacts: Mapping[str, float]) -> dict[str, sp.csr_array]:
    """Each part's diagonal block (W/K) of the machine's matrix."""
    K = field.stiffness(films, contacts)
    return {name: sp.csr_array(K[block.dofs, block.dofs]) for name, block in field.blocks.items()}


def isolated_part(
    field: FieldModel,
    films: Mapping[str, float],
    contacts: Mapping[str, float],
    S: Floats,
    loads: Floats,
    recipe: Recipe,
) -> dict[str, Floats]:
    """part -> (n_part, k) fields of the part by itself at the recipe's local points; none: (n_part, 0)."""
    rng = np.random.default_rng([recipe.seed, 2])
    points = (
        (random_coefficients(films, recipe.spread, rng), random_coefficients(contacts, recipe.spread, rng))
        for _ in range(recipe.local_points)
    )
    return local_solutions(field, S, loads, points, recipe.local_states, rng)


def principals(
    field: FieldModel, S: Floats, energy: Mapping[str, sp.csr_array], local: Mapping[str, Floats]
) -> dict[str, Principal]:
    """What each part's field can look like, by energy, from snapshots S (n, n_snapshot) and the part's own `local`."""
    return _each(field, energy, lambda name, block: np.hstack([S[block.dofs], local[name]]))


def _each(
    field: FieldModel, energy: Mapping[str, sp.csr_array], columns: Callable[[str, Block], Floats]
) -> dict[str, Principal]:
    """Of every part, from fields (n, k) of it, in two processes where there is room."""

    def principal(name: str) -> Principal:
        block, S, A = field.blocks[name], columns(name, field.blocks[name]), energy[name]
        S -= (block.w @ S) / block.volume
        each = (slice(k, k + CHUNK) for k in range(0, S.shape[1], CHUNK))
        strength, U = np.linalg.eigh(np.hstack([S.T @ (A @ S[:, some]) for some in each]))
        # A Gram matrix keeps half the digits.
        keep = np.flatnonzero(strength > 1e-13 * strength[-1])[::-1]
        # In single precision: fields are wrong by a ten-millionth, networks by a thousandth.
        return Principal(strength[keep], (S @ (U[:, keep] / np.sqrt(strength[keep]))).astype(np.float32))

    return dict(zip(field.blocks, in_two_processes(principal, list(field.blocks), field.n), strict=True))


def bases(
    field: FieldModel,
    principal: Mapping[str, Principal],
    energy: Mapping[str, sp.csr_array],
    recipe: Recipe,
    weights: Mapping[str, float] | None = None,
    last: Mapping[str, Basis] | None = None,
) -> dict[str, Basis]:
    """Shapes of every part, as many as the recipe allows; weights above 1 favour a part (on the root of energy).

    last : of the same principal fields; those of a part that keeps its number are taken over
    """
    favour = {name: (weights or {}).get(name, 1.0) ** 2 for name in principal}
    # Energy a shape must exceed to be kept
    least, strength = recipe.tolerance**2, np.concatenate([p.strength * favour[n] for n, p in principal.items()])
    if recipe.max_states is not None and recipe.max_states - len(principal) < len(strength):
        least = max(least, float(np.sort(strength)[::-1][max(recipe.max_states - len(principal), 0)]))
    counts = {name: int(np.sum(p.strength * favour[name] > least)) for name, p in principal.items()}
    unchanged = {name: basis for name, basis in (last or {}).items() if len(basis.capacity) == counts[name]}
    return {
        name: unchanged.get(name) or _shaped(block, principal[name].fields[:, : counts[name]], energy[name])
        for name, block in field.blocks.items()
    }


def _shaped(block: Block, Phi: NDArray[np.floating], A: sp.csr_array) -> Basis:
    """The same span with both matrices diagonal, slowest shape first, every shape of unit energy in A."""
    Phi = np.array(Phi, float)
    Phi -= (block.w @ Phi) / block.volume
    L = np.linalg.cholesky(Phi.T @ (block.M @ Phi))
    inner = np.linalg.solve(L, np.linalg.solve(L, Phi.T @ (block.K @ Phi)).T)
    rate, R = np.linalg.eigh((inner + inner.T) / 2)
    V = np.ones((block.n, 1 + len(rate)))
    V[:, 1:] = Phi @ np.linalg.solve(L.T, R)
    scale = unit_energy_scale(V[:, 1:], A)
    V[:, 1:] *= scale
    return Basis(V, scale**2, np.maximum(rate, 0.0) * scale**2)


def enriched(
    field: FieldModel,
    principal: Mapping[str, Principal],
    S: Sequence[NDArray[np.floating]],
    films: Mapping[str, float],
    contacts: Mapping[str, float],
    energy: Mapping[str, sp.csr_array],
) -> dict[str, Principal]:
    """Principal fields with more solutions, each S (n, k), among the snapshots."""
    K = field.stiffness(films, contacts)
    scales = [unit_energy_scale(np.asarray(X, float), K) for X in S]

    def columns(name: str, block: Block) -> Floats:
        fields, widths = principal[name].fields, [len(scale) for scale in scales]
        out = np.empty((block.n, fields.shape[1] + sum(widths)))
        rest = np.split(out, np.cumsum([fields.shape[1], *widths[:-1]]), axis=1)
        np.multiply(fields, np.sqrt(principal[name].strength), out=rest[0])
        for X, scale, columns in zip(S, scales, rest[1:], strict=True):
            np.multiply(X[block.dofs], scale, out=columns)
        return out

    return _each(field, energy, columns)
