"""From field to network: each part becomes a mean node with its true heat capacity, plus shapes of its own.

Whole-machine solutions (snapshots) are restricted to each part, their mean is taken off, and what is left is
compressed in the part's own energy. Contacts and films stay links of their own, linear in their coefficients; every
one of them may change afterwards at no cost. This is the only file of the room that knows `fem`.
"""

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from fem.matrices.assembly import FieldModel
from fem.solvers.snapshots import (
    DEFAULT,
    Basis,
    Principal,
    Recipe,
    bases,
    energies,
    enriched,
    isolated_part,
    principals,
    random_coefficients,
    snapshots,
)
from fem.solvers.solve import Factorise, Solve, Solver, film_columns
from lumped.condensation.basis_cache import BasisCache, Centre
from lumped.condensation.condensed import Zone, network_in
from lumped.model.network import Array, Network

__all__ = ["FullPoint", "Recipe", "Reduction", "Zone", "reduce"]

FEW = 24  # right-hand sides at a time: all of them need as much memory as a factor, and are hardly faster
EARLY_S = 30.0  # after a step of loss: what comes before is less than a thermocouple's own delay


class Point(NamedTuple):
    """Films and contacts (W/m2/K), and what is asked there: rest, or one step of 1 / shift (s) from a cold machine."""

    name: str
    films: Mapping[str, float]
    contacts: Mapping[str, float]
    shift: float = 0.0


@dataclass(frozen=True)
class FullPoint:
    """The field at one set of coefficients: X (n, n_load) for 1 W in every zone, then for 1 K in every fluid."""

    name: str
    films: Mapping[str, float]
    contacts: Mapping[str, float]
    X: NDArray[np.floating]
    shift: float = 0.0


@dataclass
class Reduction:
    """A field with what its parts can look like around a nominal point: networks of any size come from it.

    films, contacts : nominal coefficients (W/m2/K), by face and by contact
    zones : losses that may vary alone, one uniform loss per part among them
    fluids : fluid node -> heat capacity (J/K);  boundaries : fluids whose temperature is given
    principal : part -> its principal fields, of more snapshots after `learn`
    """

    field: FieldModel
    films: Mapping[str, float]
    contacts: Mapping[str, float]
    zones: Mapping[str, Zone]
    fluids: Mapping[str, float]
    boundaries: tuple[str, ...]
    name: str
    recipe: Recipe
    principal: Mapping[str, Principal]
    _last: tuple[Mapping[str, Basis], Network] | None = dataclasses.field(default=None, init=False, repr=False)

    @cached_property
    def loads(self) -> dict[str, Array]:
        return unit_loads(self.field, self.zones)

    @cached_property
    def energy(self) -> dict[str, sp.csr_array]:
        return energies(self.field, self.films, self.contacts)

    @cached_property
    def solver(self) -> Solver:
        return Solver(self.field)

    @property
    def washing(self) -> tuple[str, ...]:
        """Fluids and boundaries that wash a face."""
        return self.field.fluids

    def network(
        self, tolerance: float | None = None, max_states: int | None = None, weights: Mapping[str, float] | None = None
    ) -> Network:
        """Conduction and contacts as links, faces, parts and zones as places; no films yet. Costs no solve."""
        fine = self.recipe.tolerance if tolerance is None else tolerance
        recipe = replace(self.recipe, tolerance=fine, max_states=max_states)
        last, network = self._last or ({}, None)  # in the next most parts have as many shapes, or all
        shapes = bases(self.field, self.principal, self.energy, recipe, weights, last)
        if network is None or any(shapes[part] is not last[part] for part in shapes):
            whole = frozenset(key for key, zone in self.zones.items() if key == zone.part and zone.density is None)
            network = network_in(
                self.field, shapes, self.contacts, self.loads, whole, self.fluids, self.boundaries, self.name
            )
            self._last = shapes, network
        return network

    def solved(self, points: Sequence[Point]) -> list[FullPoint]:
        """The whole field at other coefficients."""
        loads = sp.csc_array(np.column_stack([*self.loads.values()]))

        def full(factor: Factorise, point: Point) -> FullPoint:
            name, films, contacts, shift = point
            inverse = factor(self.field.stiffness(films, contacts), shift)
            heat = sp.hstack([loads, film_columns(self.field, films, self.washing)[0]], format="csc")
            X = np.empty(heat.shape, np.float32)  # a ten-millionth: errors are a thousandth
            for k in range(0, heat.shape[1], FEW):
                X[:, k : k + FEW] = inverse(heat[:, k : k + FEW].toarray())
            return FullPoint(name, films, contacts, X, shift)

        return self.solver.each(full, points)

    def nominal_point(self) -> Point:
        return Point("nominal", self.films, self.contacts)

    def random_point(self, seed: int) -> Point:
        """Every film and contact times spread ** U(-1, 1)."""
        rng, spread = np.random.default_rng([self.recipe.seed, seed]), self.recipe.spread
        films, contacts = (random_coefficients(of, spread, rng) for of in (self.films, self.contacts))
        return Point(f"random {seed}", films, contacts)

    def early_point(self, seed: int) -> Point:
        """A random one after one step from a cold machine: what heats it has not gone far."""
        there = self.random_point(seed)
        return there._replace(name=f"{there.name}, {EARLY_S:g} s", shift=1.0 / EARLY_S)

    def joined_point(self, factor: float) -> Point:
        """All contacts times a factor."""
        return Point(f"contacts x{factor:g}", self.films, {name: factor * g for name, g in self.contacts.items()})

    def extreme_point(self, seed: int) -> Point:
        """A third of the films x10, a third of the contacts x5 and a third x0.2: what one change alone can reach."""
        rng = np.random.default_rng([self.recipe.seed, seed, 1])
        films = {face: h * rng.choice([1.0, 1.0, 10.0]) for face, h in self.films.items()}
        contacts = {name: g * rng.choice([1.0, 5.0, 0.2]) for name, g in self.contacts.items()}
        return Point(f"extreme {seed}", films, contacts)

    def learn(self, points: Sequence[FullPoint]) -> None:
        """Put the solutions of these points among the snapshots: networks that are cut out from now on know them."""
        self._last, S = None, [p.X for p in points]
        self.principal = enriched(self.field, self.principal, S, self.films, self.contacts, self.energy)


def reduce(
    field: FieldModel,
    films: Mapping[str, float],
    contacts: Mapping[str, float],
    fluids: Mapping[str, float],
    boundaries: tuple[str, ...] = ("ambient",),
    recipe: Recipe = DEFAULT,
    name: str = "machine",
    cache: Path | None = None,
    zones: Mapping[str, Zone] | None = None,
    solver: Solve | None = None,
) -> Reduction:
    """Solve for what the parts of a field can look like, or take it from the cache.

    films, contacts : coefficients (W/m2/K) the shapes are centred on, by face and by contact
    fluids : fluid node -> heat capacity (J/K), 0 allowed;  boundaries : fluids whose temperature is given
    zones : losses that vary alone, by name, beside one uniform loss per part; each becomes a place
    cache : folder. Shapes found for the same mesh around other coefficients, not further away than the recipe's
        spread, serve as they are: a changed film, contact or conductivity costs no solve.
    solver : of the snapshots; None: the free one of fem.solvers.solve
    """
    places = {**{part: Zone(part) for part in field.blocks}, **(zones or {})}
    if recipe.max_states == 0:
        bare = {part: Principal(np.zeros(0), np.zeros((block.n, 0))) for part, block in field.blocks.items()}
        return Reduction(field, films, contacts, places, fluids, boundaries, name, recipe, bare)
    loads = unit_loads(field, places)
    basis_cache = BasisCache(cache, _geometry(field, loads, recipe))
    centre = Centre({**films}, {**contacts}, {p: float(b.K.diagonal().sum()) for p, b in field.blocks.items()})
    cached = basis_cache.find(centre, recipe.spread)
    if cached is None:
        unit = np.column_stack([*loads.values()])
        S = snapshots(field, films, contacts, unit, recipe, solver)
        local = isolated_part(field, films, contacts, S, unit, recipe)
        cached = basis_cache.keep(
            centre, principals(field, S, energies(field, films, contacts), local), recipe.tolerance**2
        )
    principal = {part: Principal(*pair) for part, pair in cached.items()}
    return Reduction(field, films, contacts, places, fluids, boundaries, name, recipe, principal)


def unit_loads(field: FieldModel, zones: Mapping[str, Zone]) -> dict[str, Array]:
    """(n,) 1 W in every zone."""
    return {key: field.load(zone.part, zone.density) for key, zone in zones.items()}


def _geometry(field: FieldModel, loads: Mapping[str, Array], recipe: Recipe) -> list[bytes]:
    """What the shapes depend on besides coefficients: points, parts, zones, heat capacities, recipe."""
    neutral = replace(recipe, tolerance=0.0, max_states=None, favour=1.0)
    out = [repr((neutral, list(field.blocks), list(loads), list(field.films), list(field.contacts))).encode()]
    out.append(np.ascontiguousarray(field.xyz).tobytes())
    out += [block.tets.tobytes() + repr(block.rho_cp).encode() for block in field.blocks.values()]
    return out + [load.tobytes() for load in loads.values()]
