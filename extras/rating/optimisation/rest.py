"""Where a network comes to rest, and how long it takes there: the matrix of its last slopes says both.

    dx/dt = -A (x - x_rest),  A = C^-1 (K - dq/dT),  K: all coefficients as they are at rest, q: losses

Coefficients do not move with x: slopes of tabulated films jump from knot to knot. Against a run, settling times of the
shipped machines are off by less than 2 %.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from thermoscope import Network, Record, plugin as th

ABOVE_K = 30.0  # of the first guess: still air takes nothing without a difference
SMALLEST = 1e-6  # of the largest heat capacity: what stands for none
REMAINING = 0.05  # of the rise that is left at the settling time
GRID = np.geomspace(1e-4, 10.0, 400)  # of the slowest time constant


@dataclass(frozen=True)
class Rest:
    """z (n + n_boundaries,) degC;  A (n, n) 1/s;  start (n,) : the state from which it settles;  stable : no runaway"""

    z: th.Array
    A: th.Array
    start: th.Array
    stable: bool

    @cached_property
    def modes(self) -> tuple[th.Array, th.Array]:
        """Rates (n,) 1/s and their shapes (n, n), complex where a stream turns them."""
        rate, shapes = np.linalg.eig(self.A)
        return rate, shapes

    def settling(self, row: th.Row) -> float:
        """Seconds after which a temperature stays within 5 % of its rise."""
        rate, shapes = self.modes
        n = rate.size
        away = np.linalg.solve(shapes, self.start - self.z[:n]) * (row.dense(n) @ shapes)
        time = GRID / rate.real.min()
        left = np.abs((np.exp(-np.outer(time, rate)) @ away).real)
        late = np.flatnonzero(left > REMAINING * abs(away.sum().real))
        if not late.size or late[-1] == time.size - 1:
            return float(time[0 if not late.size else -1])
        k = int(late[-1])
        return float(np.interp(REMAINING * abs(away.sum().real), [left[k + 1], left[k]], [time[k + 1], time[k]]))


def rest(
    network: Network, values: Mapping[str, float], inputs: Mapping[str, float], boundaries: Mapping[str, float]
) -> Rest | None:
    """At constant inputs from all at the mean of the boundaries (settling starts there too); None without a rest."""
    core = th.compiled(network, Record(np.zeros(1), inputs, boundaries), values)
    n, u = len(network.states), core.forcing.u[0]
    hidden = np.array(["#" in s for s in network.states], bool)
    cold = np.where(hidden, 0.0, u.mean() if u.size else 20.0)
    both = th.integration_stages(cold + np.where(hidden, 0.0, ABOVE_K), u, core.terms)
    scratch = th.work(n, u.size, core.terms, 0)
    zero = np.zeros(n)
    if not th.solve_steady_start(zero, core.K0, core.terms, core.tangents, core.forcing.factor[0], both, scratch):
        return None
    C, z = np.maximum(core.C, SMALLEST * core.C.max()), both.z[0, :-1].copy()
    stable = bool(np.linalg.eigvals(scratch.G[:, :n]).real.min() > 0.0)
    if stable:
        th.tell_reach(core, z)
    return Rest(z, _slopes(network, values, inputs, z) / C[:, None], cold, stable)


def _slopes(network: Network, values: Mapping[str, float], inputs: Mapping[str, float], z: th.Array) -> th.Array:
    """K - dq/dT (n, n) W/K at temperatures z."""
    n, every = len(network.states), th.assembly(network)
    m, at = th.multipliers(network, values), {name: np.array([float(u)]) for name, u in inputs.items()}
    strength = np.array(
        [
            m.get(p.name, 1.0)
            * (th.coefficient(p.law, at, p.hot.at(z), p.cold.at(z)) if p.touches else float(np.mean(p.law.factor(at))))
            for p in every.patterns
        ]
    )
    G = every.matrix(strength)[:, :n]
    for s, c in zip(network.sources, strength[len(network.links) :], strict=True):
        if slope_1_K := th.loss_slope(s.law.temperature, s.probe.at(z), at):
            slope = c * slope_1_K * s.weights
            np.subtract.at(G, (s.index[:, None], s.probe.index[None, :]), np.outer(slope, s.probe.weights))
    return G


def losses(
    network: Network, values: Mapping[str, float], inputs: Mapping[str, float], z: th.Array, kinds: Sequence[str]
) -> float:
    """Heat (W) of the sources of some kinds at temperatures z."""
    m, at = th.multipliers(network, values), {n: np.array([float(u)]) for n, u in inputs.items()}
    sources = [s for s in network.sources if s.kind in kinds]
    watts = [th.coefficient(s.law, at, s.probe.at(z), 0.0) for s in sources]
    return sum(m.get(s.name, 1.0) * w for s, w in zip(sources, watts, strict=True))


def without_feedback(network: Network, T: float) -> Network:
    """Losses that grow with temperature at those of T (degC): such a network always rests where a film holds it.

    It is above T where the true one is above T or runs away, and below where that one is: which one, a limit can ask.
    """
    hot = (replace(s, law=_at(s.law, T)) if th.grows(s.law) else s for s in network.sources)
    return replace(network, sources=tuple(hot))


def _at(law: th.Law, T: float) -> th.Law:
    """Another law at a temperature of its own (degC)."""
    return th.WithTemperature(th.Scaled(law, th.temperature_value(law.temperature, T, T)), th.Linear(0.0, T))
