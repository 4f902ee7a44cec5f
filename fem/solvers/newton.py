"""Heat whose terms depend on temperature (radiation, copper loss), at rest and over time.

At rest by Newton, over time by the L-stable TR-BDF2; fluids hold no heat.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, gmres

from fem.matrices.assembly import FieldModel
from fem.matrices.material import Term
from fem.solvers.solve import Fluids, Solve, Steady, film_columns, from_fixed, refuse_unknown_fluid, shed
from geom.arrays import Array as Floats
from geom.errors import InputError

START = 20.0  # degC
ENOUGH = 1e-9  # K
POLISH = 1e-6  # K; far below what any thermocouple tells, far above rounding in 16 digits
ROUNDING = 1e-13  # of the largest entry: less is how matrices are summed
ROUNDS = 40  # of a method that doubles its digits a round; what takes more has no solution or a poor start


@dataclass(frozen=True)
class NonlinearSolution(Steady):
    """A steady solution and how it was found: steps (K) are the largest changes of temperature, round by round."""

    steps: tuple[float, ...]


def solve_nonlinear(
    solver: Solve,
    films: Mapping[str, float],
    contacts: Mapping[str, float],
    load: Floats,
    fluids: Fluids,
    terms: Sequence[Term],
    start: Floats | float = START,
) -> NonlinearSolution:
    """Temperatures for films h and contacts g (W/m2/K), a load (n,) in W and terms that depend on temperature.

    start : (n,) or one temperature (degC).  Raises InputError where no steady state is found: a thermal runaway.
    """
    field = solver.field
    refuse_unknown_fluid(field, fluids)
    K = field.stiffness(films, contacts)
    B, D = film_columns(field, films, fluids.names)
    source, G = load + from_fixed(field, films, fluids.fixed), D + fluids.D
    T = np.array(np.broadcast_to(np.asarray(start, float), field.n))
    u = np.linalg.solve(G, fluids.s + B.T @ T)
    steps: list[float] = []
    while not _done(steps):
        heat, slope = summed(field, terms, T)
        left = np.concatenate([source - K @ T + B @ u - heat, fluids.s - G @ u + B.T @ T])
        change = _linear(solver, sp.csr_array(K + slope), B, G)(left)
        T, u = T + change[: field.n], u + change[field.n :]
        steps.append(float(np.abs(change).max()))
    heats = [float(term.heat(field, T).sum()) for term in terms]
    injected = float(load.sum()) - sum(q for q in heats if q < 0)
    removed = shed(field, films, fluids, T, u) + sum(q for q in heats if q > 0)
    return NonlinearSolution(T, u, injected, removed, tuple(steps))


def summed(field: FieldModel, terms: Sequence[Term], T: Floats) -> tuple[Floats, sp.csr_array]:
    """(n,) heat (W) that all terms take out at T (n,), and its derivative (n, n) (W/K)."""
    none = np.zeros(field.n), sp.csr_array((field.n, field.n))
    return (
        sum((term.heat(field, T) for term in terms), none[0]),
        sp.csr_array(sum((term.slope(field, T) for term in terms), none[1])),
    )


def even(J: sp.csr_array) -> sp.csr_array:
    """The symmetric part."""
    return sp.csr_array((J + J.T) / 2)


def _done(steps: list[float]) -> bool:
    if len(steps) > ROUNDS or (steps and not np.isfinite(steps[-1])):
        raise InputError("no steady temperature was found", "newton", "losses that the cooling can carry (no runaway)")
    # The last step only polishes: Newton's error is the square of the step before. A step below POLISH that falls no
    # more is rounding, which layers of hundredths of a millimetre make larger than ENOUGH.
    return len(steps) > 1 and (steps[-1] < ENOUGH or 0.5 * steps[-2] < steps[-1] < POLISH)


def _linear(solver: Solve, J: sp.csr_array, B: Floats, G: Floats) -> Callable[[Floats], Floats]:
    """Solves [J, -B; -B', G] for any J whose symmetric part is positive definite."""
    n = J.shape[0]
    is_even = abs(J - J.T).max() <= ROUNDING * abs(J).max()
    factor = solver.factor(J if is_even else even(J))
    Y = factor(B) if B.shape[1] else B
    schur = G - B.T @ Y

    def symmetric(r: Floats) -> Floats:
        x = factor(r[:n])
        u = np.linalg.solve(schur, r[n:] + B.T @ x)
        return np.concatenate([x + Y @ u, u])

    def whole(x: Floats) -> Floats:
        return np.concatenate([J @ x[:n] - B @ x[n:], G @ x[n:] - B.T @ x[:n]])

    if is_even:
        return lambda r: (x := symmetric(r)) + symmetric(r - whole(x))

    def solve(r: Floats) -> Floats:
        whole_, symmetric_ = (LinearOperator((len(r), len(r)), f, dtype=float) for f in (whole, symmetric))
        x, _ = gmres(whole_, r, rtol=1e-12, M=symmetric_, maxiter=3)
        return np.asarray(x, float)

    return solve


Drive = Callable[[float], tuple[float, Mapping[str, float]]]
GAMMA = 2 - np.sqrt(2)
STEP_K = 1e-8  # K, change of the last iteration where terms depend on temperature
STEP_ROUNDS = 60  # of one implicit step, whose start is the step before; more would be no convergence


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
            for _ in range(STEP_ROUNDS):
                change = corrected(r + self.flow(T, t) - self.shift * (M @ T))
                T = T + change
                if not self.terms or np.abs(change).max() < STEP_K:
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
