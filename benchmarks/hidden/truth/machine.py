"""A machine: skeleton, films and losses, integrated by BDF2 with a simplified Newton iteration."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from hidden.truth.body import Array, Cells, Skeleton

Inputs = Mapping[str, float]
FilmLaw = Callable[[Array, Array, Inputs], Array | float]
LossLaw = Callable[[Array, Inputs], Array | float]
TOLERANCE = 1e-4


class Term(Protocol):
    """Adds heat (W) to q (n,) at temperatures T (n,) under inputs u."""

    def into(self, q: Array, T: Array, u: Inputs) -> None: ...


@dataclass(frozen=True)
class Film:
    """Heat from cells to a fluid: one of the inputs (a temperature), or other cells (one, or one for each).

    area : (k,) m2;  h : (T cells, T fluid, inputs) -> W/m2/K, array or number
    A signal "cover.NAME" takes a share of it away.
    """

    name: str
    cells: Cells
    fluid: str | Cells
    area: Array
    h: FilmLaw

    def into(self, q: Array, T: Array, u: Inputs) -> None:
        hot = T[self.cells]
        cold = u[self.fluid] if isinstance(self.fluid, str) else T[self.fluid]
        flow = (1.0 - u.get(f"cover.{self.name}", 0.0)) * self.h(hot, cold, u) * self.area * (hot - cold)
        q[self.cells] -= flow
        if not isinstance(self.fluid, str):
            np.add.at(q, self.fluid, flow if self.fluid.size > 1 else flow.sum())


@dataclass(frozen=True)
class Stream:
    """A fluid through cells one after the other, from an inlet whose temperature is an input.

    mcp : heat capacity flow (W/K) from (T cells, inputs)
    """

    cells: Cells
    inlet: str
    mcp: Callable[[Array, Inputs], float]

    def into(self, q: Array, T: Array, u: Inputs) -> None:
        before = np.concatenate([[u[self.inlet]], T[self.cells[:-1]]])
        q[self.cells] += self.mcp(T[self.cells], u) * (before - T[self.cells])


@dataclass(frozen=True)
class Loss:
    """Heat made in cells: watts(T cells, inputs), shared by `share` (k,)."""

    name: str
    cells: Cells
    share: Array
    watts: LossLaw

    def into(self, q: Array, T: Array, u: Inputs) -> None:
        q[self.cells] += self.share * self.watts(T[self.cells], u)


@dataclass(frozen=True)
class Machine:
    """The skeleton and what heats or cools it."""

    skeleton: Skeleton
    terms: tuple[Term, ...]

    def heat(self, T: Array, u: Inputs) -> Array:
        """Heat (W) into every cell."""
        q = self.skeleton.conduction(T)
        for term in self.terms:
            term.into(q, T, u)
        return q

    def slope(self, T: Array, u: Inputs) -> Array:
        """dT/dt (K/s)."""
        return self.heat(T, u) / self.skeleton.capacity(T)

    def jacobian(self, T: Array, u: Inputs, step: float = 0.01) -> Array:
        """d slope / dT (n, n) by differences."""
        base = self.slope(T, u)
        columns = [(self.slope(T + step * e, u) - base) / step for e in np.eye(T.size)]
        return np.stack(columns, axis=1)

    def run(self, time: Array, inputs: Mapping[str, Array], start: Array) -> Array:
        """Temperatures (n_time, n) on an even grid of times (s)."""
        dt, out = float(time[1] - time[0]), np.empty((time.size, start.size))
        at = [dict(zip(inputs, map(float, row), strict=True)) for row in zip(*inputs.values(), strict=True)]
        out[0], out[1] = start, self._first(start, at[1], dt)
        middle = {k: float(np.median(v)) for k, v in inputs.items()}
        inverse = self._inverse(start + 30.0, middle, dt)
        for k in range(2, time.size):
            known = (4.0 * out[k - 1] - out[k - 2]) / 3.0
            T, rounds = self._solve(2.0 * out[k - 1] - out[k - 2], known, at[k], dt, inverse)
            if rounds > 5:
                inverse = self._inverse(T, at[k], dt)
            out[k] = T
        return out

    def _first(self, start: Array, u: Inputs, dt: float) -> Array:
        """One step of 20 backward Euler steps."""
        small, T = dt / 20.0, start
        inverse = np.linalg.inv(np.eye(T.size) - small * self.jacobian(T, u))
        for _ in range(20):
            T = T + inverse @ (small * self.slope(T, u))
        return T

    def _inverse(self, T: Array, u: Inputs, dt: float) -> Array:
        return np.asarray(np.linalg.inv(np.eye(T.size) - 2.0 / 3.0 * dt * self.jacobian(T, u)))

    def _solve(self, T: Array, known: Array, u: Inputs, dt: float, inverse: Array) -> tuple[Array, int]:
        """The step's end; where an old inverse leads astray (a switch), a new one does, with half steps at kinks."""
        guess, share, last = T, 1.0, np.inf
        for k in range(60):
            change = inverse @ (known + 2.0 / 3.0 * dt * self.slope(T, u) - T)
            size = float(np.abs(change).max())
            if size < TOLERANCE:
                return T + change, k
            if share == 1.0 and (size > last or k == 8):
                T, inverse, share = guess, self._inverse(guess, u, dt), 0.5 if k == 8 else 0.9
            else:
                T = T + share * change
            last = size
        raise ArithmeticError(f"step of {dt} s does not converge; the largest change is {size:.3g} K")
