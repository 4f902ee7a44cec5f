"""General ODE solvers on the benchmark's network: SciPy LSODA and BDF, CasADi CVODES, diffrax Kvaerno5.

Each gets the same equations in its own best form, the same inputs (current and speed linear between the samples), and
every tolerance of a list; what counts is the fastest run that is at least as accurate as ours, and the run at 1e-6,
which is what a user asks for. What is compiled is compiled before the clock starts: right-hand sides of "numba" solvers
and of diffrax, CVODES through CasADi. CasADi and diffrax are optional: pip install casadi diffrax.
"""

import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from scipy.integrate import solve_ivp

from geom.constants import SIGMA, ZERO_C
from lumped.integration.simulate import Record
from lumped.model.network import Network
from lumped.numerics.terms import SMOOTH
from scripts.published import timed

TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
USUAL = 1e-6
Run = Callable[[], np.ndarray]


@dataclass(frozen=True)
class Equations:
    """C dx/dt = -K [x; ambient] - radiation - convection + copper + iron, and the tables its inputs come from.

    copper (W at 10 A and 20 degC), iron (W at 1000 rpm);  tables (nt, 3) : ambient, current, speed
    """

    C: np.ndarray
    K: np.ndarray
    radiating: np.ndarray
    convecting: np.ndarray
    hot: np.ndarray
    core: np.ndarray
    time: np.ndarray
    tables: np.ndarray

    @classmethod
    def of(cls, net: Network, rec: Record) -> "Equations":
        n = len(net.states)
        K, films = np.zeros((n, n + 1)), {"r": np.zeros(n), "c": np.zeros(n)}
        for link in net.links:
            if link.name[0] == "g":
                np.add.at(K, (link.rows, link.cols), link.law.value * link.vals)
            else:
                films[link.name[0]][int(link.rows[0])] = link.law.value
        watts = [np.zeros(n), np.zeros(n)]
        for at, s in zip(watts, net.sources, strict=True):
            at[int(s.index[0])] = s.law.value
        given = rec.boundaries["ambient"], rec.inputs["current_A"], rec.inputs["speed_rpm"]
        tables = np.column_stack([np.broadcast_to(x, rec.time.shape) for x in given])
        return cls(net.C, K, films["r"], films["c"], *watts, rec.time, tables)

    def rate(self, x: Any, u: Any, xp: Any) -> Any:
        """dx/dt for a state and (ambient, current, speed), with xp = numpy or jax.numpy."""
        ambient, copper, iron = u[0], (u[1] / 10.0) ** 2, xp.abs(u[2] / 1000.0) ** 1.5
        T, d = x + ZERO_C, x - ambient
        q = -(self.K[:, :-1] @ x + self.K[:, -1] * ambient) - SIGMA * self.radiating * (T**4 - (ambient + ZERO_C) ** 4)
        q = q - self.convecting * (d * d + SMOOTH**2) ** 0.125 * d
        return (q + self.hot * copper * (1 + 0.0039 * (x - 20.0)) + self.core * iron) / self.C


@njit(cache=True)
def _rate(t, x, C, K, radiating, convecting, hot, core, step, tables):
    k = min(int(t / step), len(tables) - 2)
    u = tables[k] + (t / step - k) * (tables[k + 1] - tables[k])
    copper, iron = (u[1] / 10.0) ** 2, abs(u[2] / 1000.0) ** 1.5
    out = np.empty(x.size)
    for i in range(x.size):
        T, d = x[i] + ZERO_C, x[i] - u[0]
        q = -K[i, x.size] * u[0] - SIGMA * radiating[i] * (T**4 - (u[0] + ZERO_C) ** 4)
        q -= convecting[i] * (d * d + SMOOTH**2) ** 0.125 * d
        for j in range(x.size):
            q -= K[i, j] * x[j]
        out[i] = (q + hot[i] * copper * (1 + 0.0039 * (x[i] - 20.0)) + core[i] * iron) / C[i]
    return out


def scipy_runs(method: str, compiled: bool, steps: bool) -> Callable[[Equations, np.ndarray, float], Run]:
    """SciPy; steps: never over a sample, for inputs that change at every one."""

    def run(eq: Equations, x0: np.ndarray, rtol: float) -> Run:
        step = float(eq.time[1] - eq.time[0])
        slopes = np.vstack([np.diff(eq.tables, axis=0), np.zeros((1, 3))])
        args = (eq.C, eq.K, eq.radiating, eq.convecting, eq.hot, eq.core, step, eq.tables)

        def plain(t: float, x: np.ndarray) -> np.ndarray:
            k = min(int(t / step), len(slopes) - 1)
            return eq.rate(x, eq.tables[k] + (t / step - k) * slopes[k], np)

        def fast(t: float, x: np.ndarray) -> np.ndarray:
            return _rate(t, x, *args)

        largest = step if steps else np.inf
        return lambda: (
            solve_ivp(
                fast if compiled else plain,
                (eq.time[0], eq.time[-1]),
                x0,
                method,
                t_eval=eq.time,
                rtol=rtol,
                atol=10.0 * rtol,
                max_step=largest,
            ).y.T
        )

    return run


def casadi_cvodes(eq: Equations, x0: np.ndarray, rtol: float) -> Run:
    """One integrator over a step of linear inputs, mapped over the record: CVODES restarts at every sample.

    Its right-hand side and Jacobian are C of CasADi's code generator, compiled where there is gcc.
    """
    import casadi as ca

    n, step = x0.size, float(eq.time[1] - eq.time[0])
    x, p, t = ca.MX.sym("x", n), ca.MX.sym("p", 6), ca.MX.sym("t")
    u = p[:3] + t * (p[3:] - p[:3])
    T, d = x + ZERO_C, x - u[0]
    conduction = ca.sparsify(ca.DM(eq.K[:, :-1]))
    q = -(conduction @ x + eq.K[:, -1] * u[0]) - SIGMA * eq.radiating * (T**4 - (u[0] + ZERO_C) ** 4)
    q += -eq.convecting * (d * d + SMOOTH**2) ** 0.125 * d
    q += eq.hot * (u[1] / 10.0) ** 2 * (1 + 0.0039 * (x - 20.0)) + eq.core * ca.fabs(u[2] / 1000.0) ** 1.5
    problem = {"x": x, "p": p, "t": t, "ode": step * q / eq.C}
    options = {"reltol": rtol, "abstol": 10.0 * rtol}
    if shutil.which("gcc"):
        options |= {"jit": True, "compiler": "shell", "jit_options": {"flags": ["-O3"]}}
    one = ca.integrator("one", "cvodes", problem, 0.0, 1.0, options)
    march = one.mapaccum(eq.time.size - 1)
    P = np.hstack([eq.tables[:-1], eq.tables[1:]]).T
    return lambda: np.vstack([x0, np.asarray(march(x0=x0, p=P)["xf"]).T])


def diffrax_kvaerno(steps: bool) -> Callable[[Equations, np.ndarray, float], Run]:
    """Kvaerno5 with the step control diffrax recommends for stiff equations."""

    def make(eq: Equations, x0: np.ndarray, rtol: float) -> Run:
        import diffrax
        import jax
        import jax.numpy as jnp

        jax.config.update("jax_enable_x64", True)
        inputs = diffrax.LinearInterpolation(jnp.asarray(eq.time), jnp.asarray(eq.tables))
        term = diffrax.ODETerm(lambda t, x, _: eq.rate(x, inputs.evaluate(t), jnp))
        largest = float(eq.time[1] - eq.time[0]) if steps else None
        control = diffrax.PIDController(rtol=rtol, atol=10.0 * rtol, dtmax=largest)

        @jax.jit
        def run(start: Any) -> Any:
            return diffrax.diffeqsolve(
                term,
                diffrax.Kvaerno5(),
                eq.time[0],
                eq.time[-1],
                0.1,
                start,
                stepsize_controller=control,
                saveat=diffrax.SaveAt(ts=jnp.asarray(eq.time)),
                max_steps=100_000,
            ).ys

        return lambda: np.asarray(run(jnp.asarray(x0)))

    return make


def reference(net: Network, rec: Record) -> np.ndarray:
    """SciPy's Radau at rtol 1e-10, never over a sample."""
    return scipy_runs("Radau", True, True)(Equations.of(net, rec), np.full(len(net.states), 20.0), 1e-10)()


def peers(net: Network, rec: Record, exact: np.ndarray, ours: float, steps: bool) -> list[tuple[str, float, float]]:
    """(name, CPU s, largest error K): of each installed peer the one as accurate as `ours` (K), and the usual one."""
    eq, x0 = Equations.of(net, rec), np.full(len(net.states), 20.0)
    makers = {
        "SciPy LSODA, numba": scipy_runs("LSODA", True, steps),
        "SciPy LSODA": scipy_runs("LSODA", False, steps),
        "SciPy BDF": scipy_runs("BDF", False, steps),
        "CasADi CVODES": casadi_cvodes,
        "diffrax Kvaerno5": diffrax_kvaerno(steps),
    }
    out = []
    for name, make in makers.items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        try:
            out += _chosen(name, lambda rtol, make=make: make(eq, x0, rtol), exact, ours)
        except ImportError as fault:
            print(f"{name} left out: {fault}", file=sys.stderr)
    return out


def _chosen(name: str, make: Callable[[float], Run], exact: np.ndarray, ours: float) -> list[tuple[str, float, float]]:
    rows, best = [], None
    for rtol in TOLERANCES:
        run = make(rtol)
        error = float(np.abs(run() - exact).max())  # compiles
        if best is None and error <= ours:
            best = f"{name}, equal error, {rtol:g}", timed(run, 2)[1], error
        if rtol == USUAL:
            rows.append((f"{name}, {rtol:g}", timed(run, 2)[1], error))
        if best and rtol >= USUAL and rows:
            break
    return [*([best] if best else []), *rows]
