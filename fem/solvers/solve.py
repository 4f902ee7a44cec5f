"""Steady solutions of the whole machine, with fluids as lumped nodes, and what they balance to."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

import numpy as np
import scipy.sparse as sp

from fem.matrices.assembly import FieldModel
from fem.solvers.multifrontal import Factor, Symbolic, analyse, factorise
from fem.solvers.two_processes import in_two_processes, return_memory
from geom.arrays import Array as Floats
from geom.errors import InputError

Inverse = Callable[[Floats], Floats]
Factorise = Callable[..., Inverse]  # of K and a shift, as Solve.factor
A = TypeVar("A")
B = TypeVar("B")


class Solve(Protocol):
    """What every solver offers."""

    @property
    def field(self) -> FieldModel: ...

    def factor(self, K: sp.csr_array, shift: float = 0.0) -> Callable[[Floats], Floats]:
        """The inverse of K + shift M, shift in 1/s, as a function of right-hand sides (n,) or (n, k)."""
        ...


@dataclass(frozen=True)
class Iterative:
    """Conjugate gradients with classical multigrid: less work than a factor for one or two right-hand sides.

    CPU seconds, set-up and one right-hand side to 1e-10: 300,000 unknowns of a laminated ring 1.3 and 1.0; 188,000 of
    a motor with thin layers 0.5 and 4.5 (its factor takes 5.7, 0.03 each). One sweep forward before and one backward
    after each coarse solution keep the preconditioner symmetric at half the work of symmetric sweeps.
    Source: Ruge and Stueben 1987.
    """

    field: FieldModel
    tolerance: float = 1e-11

    def factor(self, K: sp.csr_array, shift: float = 0.0) -> Callable[[Floats], Floats]:
        import pyamg

        A = sp.csr_matrix(K + shift * self.field.M if shift else K)
        A.indices, A.indptr = A.indices.astype(np.int32), A.indptr.astype(np.int32)
        there, back = (("gauss_seidel", {"sweep": way}) for way in ("forward", "backward"))
        levels = pyamg.ruge_stuben_solver(A, presmoother=there, postsmoother=back)

        def solve(b: Floats) -> Floats:
            columns = b.reshape(len(b), -1).T
            solutions = [
                levels.solve(c, tol=self.tolerance, accel="cg", maxiter=1000) if c.any() else c for c in columns
            ]
            return np.array(solutions).reshape(len(columns), len(b)).T.reshape(b.shape)

        return solve


@dataclass(frozen=True)
class Solver:
    """Factorisations of one machine: analysed once, each set of coefficients costs a numeric one."""

    field: FieldModel

    @property
    def symbolic(self) -> Symbolic:
        """Kept beside what the field itself works out once, so that its next solver has it too."""
        memory: dict[str, Any] = vars(self.field)
        if "symbolic" not in memory:
            pattern = self.field.stiffness(
                dict.fromkeys(self.field.films, 1.0), dict.fromkeys(self.field.contacts, 1.0)
            )
            memory["symbolic"] = analyse(sp.csr_array(pattern + self.field.M), self.field.xyz)
            return_memory()  # half a gigabyte at 150,000 unknowns, which a factor does not take
        analysis: Symbolic = memory["symbolic"]
        return analysis

    def factor(self, K: sp.csr_array, shift: float = 0.0, room: Floats | None = None) -> Factor:
        """Cholesky factor of K + shift M, shift in 1/s;  room : as for factorise."""
        return factorise(sp.csr_array(K + shift * self.field.M) if shift else K, self.symbolic, room)

    def each(self, work: Callable[[Factorise, A], B], items: Sequence[A]) -> list[B]:
        """work(factor, item) of every item, in two processes where there is room.

        factor : as above, into the memory of the one before: pages that the system clears cost as much time as the
            numbers that go there
        """
        size, rooms = self.symbolic.room, list[Floats]()  # analysed before there are two processes

        def factor(K: sp.csr_array, shift: float = 0.0) -> Factor:
            if not rooms:
                rooms.append(np.empty(size))
            return self.factor(K, shift, rooms[0])

        return in_two_processes(lambda item: work(factor, item), items, self.field.n, rooms.clear)


@dataclass(frozen=True)
class Fluids:
    """Lumped fluid nodes: names; D (n, n) W/K among them beside the films (streams, leaks); s (n,) W from outside.

    fixed : fluids at a given temperature (degC), e.g. {"ambient": 20.0}
    """

    names: tuple[str, ...]
    D: Floats
    s: Floats
    fixed: Mapping[str, float]


@dataclass(frozen=True)
class Steady:
    """T (n,) field and u (n_fluid,) fluid temperatures (degC); injected and removed heat (W)."""

    T: Floats
    u: Floats
    injected: float
    removed: float

    @property
    def energy_balance(self) -> float:
        """|injected - removed| over injected."""
        return abs(self.injected - self.removed) / max(abs(self.injected), 1e-300)


def only_fixed(**temperatures: float) -> Fluids:
    """No lumped nodes: every fluid is at a given temperature (degC)."""
    return Fluids((), np.zeros((0, 0)), np.zeros(0), temperatures)


def steady(
    solver: Solve,
    films: Mapping[str, float],
    contacts: Mapping[str, float],
    load: Floats,
    fluids: Fluids,
    conductivity: Mapping[str, float] | None = None,
) -> Steady:
    """Temperatures for films h and contacts g (W/m2/K) and a load (n,) in W.

    The factor sees only the solid; the few fluid nodes are eliminated by their Schur complement.
    """
    field = solver.field
    refuse_unknown_fluid(field, fluids)
    K = field.stiffness(films, contacts, conductivity)
    _refuse_floating(field, K)
    factor = solver.factor(K)
    B, D = film_columns(field, films, fluids.names)
    fixed = load + from_fixed(field, films, fluids.fixed)
    solid, fluid = coupled(factor, fixed[:, None], B, D + fluids.D, fluids.s[:, None])
    T, u = solid[:, 0], fluid[:, 0]
    left = fixed + B @ u - K @ T
    # The sum of what is left is the error of the energy balance.
    if abs(left.sum()) > 1e-11 * np.abs(fixed).sum():
        T += factor(left)
    return Steady(T, u, float(load.sum()), shed(field, films, fluids, T, u))


def coupled(inverse: Inverse, b: Floats, B: Floats, G: Floats, s: Floats) -> tuple[Floats, Floats]:
    """Solids x (n, k) and fluids u (n_fluid, k) of A x - B u = b and G u - B' x = s; inverse : y -> A^-1 y."""
    k = b.shape[1]
    X = inverse(np.column_stack([b, B]))
    u = np.asarray(np.linalg.solve(G - B.T @ X[:, k:], s + B.T @ X[:, :k]), float)
    return X[:, :k] + X[:, k:] @ u, u


def shed(field: FieldModel, films: Mapping[str, float], fluids: Fluids, T: Floats, u: Floats) -> float:
    """Heat (W) to fluids of fixed temperature, and what streams and leaks carry away."""
    watts = sum(
        films[name] * float(f.trace.b @ T[f.trace.dofs] - f.trace.area * fluids.fixed[f.fluid])
        for name, f in field.films.items()
        if f.fluid in fluids.fixed
    )
    return watts + float(np.sum(fluids.D @ u - fluids.s))


def film_columns(field: FieldModel, films: Mapping[str, float], names: tuple[str, ...]) -> tuple[Floats, Floats]:
    """B (n, n_fluid) = sum h b and the diagonal D (n_fluid, n_fluid) = sum h A of the films on the named fluids."""
    B, D = np.zeros((field.n, len(names))), np.zeros((len(names), len(names)))
    for face, film in field.films.items():
        if film.fluid in names:
            k = names.index(film.fluid)
            B[film.trace.dofs, k] += films[face] * film.trace.b
            D[k, k] += films[face] * film.trace.area
    return B, D


def from_fixed(field: FieldModel, films: Mapping[str, float], fixed: Mapping[str, float]) -> Floats:
    """(n,) load (W) of the films onto fluids of fixed temperature."""
    out = np.zeros(field.n)
    for face, film in field.films.items():
        if film.fluid in fixed:
            out[film.trace.dofs] += films[face] * fixed[film.fluid] * film.trace.b
    return out


def refuse_unknown_fluid(field: FieldModel, fluids: Fluids) -> None:
    names = {*fluids.names, *fluids.fixed}
    for face, film in field.films.items():
        if film.fluid not in names:
            raise InputError(
                f"no temperature for fluid '{film.fluid}'", f"face '{face}'", f"given: {', '.join(sorted(names))}"
            )


def _refuse_floating(field: FieldModel, K: sp.csr_array) -> None:
    """A piece that no film or contact holds has no steady temperature."""
    # In a symmetric pattern strongly connected is connected, and found in half the time.
    count, label = sp.csgraph.connected_components(sp.csr_array(K != 0), connection="strong")
    fixed = np.bincount(label, K @ np.ones(field.n), count) > 1e-12 * np.bincount(label, K.diagonal(), count)
    if not fixed.all():
        loose = [part for part, block in field.blocks.items() if not fixed[label[block.dofs]].all()]
        raise InputError(f"nothing takes heat from {', '.join(loose)}", "steady", "a film or a contact above 0")
