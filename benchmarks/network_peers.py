"""General ODE solvers on the benchmark's network: scipy LSODA and BDF, CasADi CVODES, diffrax Kvaerno5.

Each gets the same equations in its own best form, the same inputs (linear between the samples) and a tolerance of
1e-6; what is compiled is compiled before the clock starts. CasADi and diffrax are optional: pip install casadi diffrax.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from lumped.network import Network
from lumped.simulate import Record
from lumped.terms import SIGMA, SMOOTH, ZERO_C

RTOL, ATOL = 1e-6, 1e-5


@dataclass(frozen=True)
class Equations:
    """C dx/dt = -K [x; ambient] - radiation - convection + copper + iron, and the tables its inputs come from."""

    C: np.ndarray
    K: np.ndarray
    radiating: list[int]
    convecting: list[int]
    hot: int
    core: int
    time: np.ndarray
    tables: np.ndarray  # (nt, 3): ambient, copper, iron

    @classmethod
    def of(cls, net: Network, rec: Record) -> Equations:
        n = len(net.states)
        K, kinds = np.zeros((n, n + 1)), {"r": [], "c": []}
        for link in net.links:
            if link.name[0] == "g":
                np.add.at(K, (link.rows, link.cols), link.law.value * link.vals)
            else:
                kinds[link.name[0]].append(int(link.rows[0]))
        losses = [np.broadcast_to(s.law.factor(rec.inputs), rec.time.shape) for s in net.sources]
        hot, core = (int(s.index[0]) for s in net.sources)
        tables = np.column_stack([np.broadcast_to(rec.boundaries["ambient"], rec.time.shape), *losses])
        return cls(net.C, K, kinds["r"], kinds["c"], hot, core, rec.time, tables)

    def rate(self, x: Any, u: Any, xp: Any) -> Any:
        """dx/dt for a state and (ambient, copper, iron), with xp = numpy or jax.numpy."""
        ambient, copper, iron = u[0], u[1], u[2]
        q = -(self.K[:, :-1] @ x + self.K[:, -1] * ambient)
        T, d = x + ZERO_C, x - ambient
        r, c = np.zeros(x.size), np.zeros(x.size)
        r[self.radiating], c[self.convecting] = 0.1 * SIGMA, 0.5
        q = q - r * (T**4 - (ambient + ZERO_C) ** 4) - c * (d * d + SMOOTH**2) ** 0.125 * d
        one = np.eye(x.size)
        return (q + one[self.hot] * copper * (1 + 0.0039 * (x[self.hot] - 20.0)) + one[self.core] * iron) / self.C


def solve(eq: Equations, x0: np.ndarray, method: str, rtol: float, atol: float) -> np.ndarray:
    """scipy; its right-hand side looks the inputs up by the index of the second, not by a search."""
    step = eq.time[1] - eq.time[0]
    slopes = np.vstack([np.diff(eq.tables, axis=0), np.zeros((1, 3))])

    def f(t: float, x: np.ndarray) -> np.ndarray:
        k = min(int(t / step), len(slopes) - 1)
        return eq.rate(x, eq.tables[k] + (t / step - k) * slopes[k], np)

    span = (eq.time[0], eq.time[-1])
    return solve_ivp(f, span, x0, method, t_eval=eq.time, rtol=rtol, atol=atol, max_step=step).y.T


def casadi_cvodes(eq: Equations, x0: np.ndarray) -> Callable[[], np.ndarray]:
    """One integrator over a step of linear inputs, mapped over the record: CVODES restarts at every sample."""
    import casadi as ca

    n, step = x0.size, float(eq.time[1] - eq.time[0])
    x, p, t = ca.MX.sym("x", n), ca.MX.sym("p", 6), ca.MX.sym("t")
    u = p[:3] + t * (p[3:] - p[:3])
    T, d = x + ZERO_C, x - u[0]
    r, c, hot, core = np.zeros(n), np.zeros(n), np.eye(n)[eq.hot], np.eye(n)[eq.core]
    r[eq.radiating], c[eq.convecting] = 0.1 * SIGMA, 0.5
    conduction = ca.sparsify(ca.DM(eq.K[:, :-1]))
    q = -(conduction @ x + eq.K[:, -1] * u[0]) - r * (T**4 - (u[0] + ZERO_C) ** 4)
    q += -c * (d * d + SMOOTH**2) ** 0.125 * d + hot * u[1] * (1 + 0.0039 * (x[eq.hot] - 20.0)) + core * u[2]
    problem = {"x": x, "p": p, "t": t, "ode": step * q / eq.C}
    one = ca.integrator("one", "cvodes", problem, 0.0, 1.0, {"reltol": RTOL, "abstol": ATOL})
    march = one.mapaccum(eq.time.size - 1)
    P = np.hstack([eq.tables[:-1], eq.tables[1:]]).T
    return lambda: np.vstack([x0, np.asarray(march(x0=x0, p=P)["xf"]).T])


def diffrax_kvaerno(eq: Equations, x0: np.ndarray) -> Callable[[], np.ndarray]:
    """Kvaerno5 with the step control diffrax recommends for stiff equations, told where the inputs bend."""
    import diffrax
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)
    inputs = diffrax.LinearInterpolation(jnp.asarray(eq.time), jnp.asarray(eq.tables))
    term = diffrax.ODETerm(lambda t, x, _: eq.rate(x, inputs.evaluate(t), jnp))
    control = diffrax.PIDController(rtol=RTOL, atol=ATOL, dtmax=float(eq.time[1] - eq.time[0]))

    @jax.jit
    def run(start: Any) -> Any:
        return diffrax.diffeqsolve(
            term, diffrax.Kvaerno5(), eq.time[0], eq.time[-1], 0.1, start, stepsize_controller=control,
            saveat=diffrax.SaveAt(ts=jnp.asarray(eq.time)), max_steps=100_000,
        ).ys  # fmt: skip

    return lambda: np.asarray(run(jnp.asarray(x0)))


def timed(run: Callable[[], Any], repeats: int = 3) -> tuple[float, Any]:
    """Best CPU seconds and the result."""
    best, out = np.inf, None
    for _ in range(repeats):
        start = time.process_time()
        out = run()
        best = min(best, time.process_time() - start)
    return best, out


def peers(net: Network, rec: Record) -> tuple[list[tuple[str, float, float]], np.ndarray]:
    """(name, CPU s, largest error K) of every peer that is installed, and the reference: Radau at rtol 1e-10."""
    eq, x0 = Equations.of(net, rec), np.full(len(net.states), 20.0)
    print("reference ...", file=sys.stderr, flush=True)
    reference = solve(eq, x0, "Radau", 1e-10, 1e-9)
    runs: dict[str, Callable[[], tuple[float, np.ndarray]]] = {
        "scipy LSODA": lambda: timed(lambda: solve(eq, x0, "LSODA", RTOL, ATOL), 2),
        "scipy BDF": lambda: timed(lambda: solve(eq, x0, "BDF", RTOL, ATOL), 1),
        "CasADi CVODES": lambda: _built(casadi_cvodes(eq, x0)),
        "diffrax Kvaerno5": lambda: _built(diffrax_kvaerno(eq, x0)),
    }
    out = []
    for name, run in runs.items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        try:
            seconds, y = run()
        except ImportError as fault:
            print(f"{name} left out: {fault}", file=sys.stderr)
            continue
        out.append((name, seconds, float(np.abs(y - reference).max())))
    return out, reference


def _built(run: Callable[[], np.ndarray]) -> tuple[float, np.ndarray]:
    run()  # compiles
    return timed(run, 2)
