"""Temperatures over time, by the L-stable TR-BDF2; fluids hold no heat.

Source: Bank et al. 1985, IEEE Trans. Electron Devices 32, 1992; with gamma = 2 - sqrt(2) both stages share one matrix.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from fem.matrices.terms import Term
from fem.solvers.newton import even, summed
from fem.solvers.solve import Fluids, Solve, film_columns, from_fixed, refuse_unknown_fluid
from geom.arrays import Array as Floats
from geom.errors import InputError

Drive = Callable[[float], tuple[float, Mapping[str, float]]]
GAMMA = 2 - np.sqrt(2)
ENOUGH = 1e-8  # K, change of the last iteration where terms depend on temperature
ROUNDS = 60  # of one implicit step, whose start is the step before; more would be no convergence


@dataclass(frozen=True)
class _System:
    """M dT/dt = forced(t) - K T + B u - heat(T) with G u = s + B'T."""

    solver: Solve
    K: sp.csr_array
    B: Floats
    G: Floats
    forced: Callable[[float], Floats]
    terms: Sequence[Term]
    shift: float

    def flow(self, T: Floats, t: float) -> Floats:
        """(n,) heat into every node (W)."""
        streamed = self.B @ np.linalg.solve(self.G, self.B.T @ T) if self.B.shape[1] else 0.0
        return self.forced(t) - self.K @ T + streamed - self._heat(T)

    def implicit(self, T: Floats) -> Callable[[Floats, Floats, float], Floats]:
        """Stage solver near T: given M-weighted history r and a guess, solves shift M T = r + flow(T, t)."""
        J = sp.csr_array(self.K + even(summed(self.solver.field, self.terms, T)[1])) if self.terms else self.K
        factor = self.solver.factor(J, self.shift)
        B, M = self.B, self.solver.field.M
        Y = factor(B) if B.shape[1] else B
        small = np.linalg.inv(self.G - B.T @ Y)

        def corrected(r: Floats) -> Floats:
            x = factor(r)
            return x + Y @ (small @ (B.T @ x))

        def solve(r: Floats, T: Floats, t: float) -> Floats:
            for _ in range(ROUNDS):
                change = corrected(r + self.flow(T, t) - self.shift * (M @ T))
                T = T + change
                if not self.terms or np.abs(change).max() < ENOUGH:
                    return T
            raise InputError("a time step does not converge", f"t = {t} s", "a smaller step")

        return solve

    def _heat(self, T: Floats) -> Floats:
        return sum((term.heat(self.solver.field, T) for term in self.terms), np.zeros(len(T)))


def transient(
    solver: Solve,
    films: Mapping[str, float],
    contacts: Mapping[str, float],
    load: Floats,
    fluids: Fluids,
    start: Floats,
    step: float,
    steps: int,
    drive: Drive | None = None,
    terms: Sequence[Term] = (),
) -> Floats:
    """(steps + 1, n) temperatures (degC) from `start` (n,), at multiples of `step` (s).

    load : (n,) W;  drive : time (s) -> factor on the load and temperatures of the fixed fluids; None keeps both
    terms : heat that depends on temperature; one factor serves all steps, so the slopes are those of the start
    """
    field = solver.field
    refuse_unknown_fluid(field, fluids)
    B, D = film_columns(field, films, fluids.names)
    G = D + fluids.D
    inflow = B @ np.linalg.solve(G, fluids.s)

    def forced(t: float) -> Floats:
        share, fixed = drive(t) if drive else (1.0, fluids.fixed)
        return share * load + from_fixed(field, films, fixed) + inflow

    shift = 2 / (GAMMA * step)
    system = _System(solver, field.stiffness(films, contacts), B, G, forced, terms, shift)
    stage = system.implicit(start)
    a, b, M = 1 / (GAMMA * (2 - GAMMA)), (1 - GAMMA) ** 2 / (GAMMA * (2 - GAMMA)), field.M
    out = [np.array(start, float)]
    for k in range(steps):
        T, t = out[-1], k * step
        middle = stage(shift * (M @ T) + system.flow(T, t), T, t + GAMMA * step)
        out.append(stage(shift * (M @ (a * middle - b * T)), middle, t + step))
    return np.array(out)
