"""How the readings of a run answer to its multipliers: exact tangents of the scheme. Compiled on its own.

They differentiate exactly the equations of kernel.py, second derivatives of the temperature laws included, along the
states and rates that it has left.
"""

from __future__ import annotations

from typing import NamedTuple

from lumped.dense import axpy, lu, shifted, solve_many, subtract_product
from lumped.jit import entry, inner, pasted
from lumped.stages import GAMMA, begin, directions, length, restored, taken
from lumped.terms import ROWS, Floats, Ints, bend, clear, jacobian


class Tangents(NamedTuple):
    """Which multiplier each tangent moves: d m[term] / d theta[tangent] = slope; dC (n, p) for the capacities."""

    tangent: Ints
    term: Ints
    slope: Floats
    dC: Floats


@inner
def _moved(T, S, stage, t, df, a, gh, out):
    """out -= d m times what a stage takes out, for every multiplier a tangent moves."""
    for i in range(S.term.size):
        e, j, slope = S.term[i], S.tangent[i], S.slope[i]
        for s in range(T.start[e, ROWS], T.start[e + 1, ROWS]):
            out[T.row[s], j] -= slope * taken(T, e, s, stage, t, df[e], a, gh)


@inner
def _step(T, S, K0, C, t, h, curved, a, q):
    """Move the tangents q.D over the step that ends at index t."""
    n, gh = C.size, GAMMA * h
    clear(q.R[0])
    clear(q.R[1])
    for stage in range(2):
        if curved:
            bend(T, T.factor[t - 1], q.df, 1.0 - 2.0 * stage, a.tau[0], a.v[0], a.vw[stage], gh, q.H)
            subtract_product(q.H, q.D, q.R[stage])
        _moved(T, S, stage, t, q.df, a, gh, q.R[stage])
    for stage in range(2):
        subtract_product(q.G, q.D, q.R[stage])
        for i in range(n):
            axpy(-a.w[stage, i] - 2.0 * stage * a.w[0, i], S.dC[i], q.R[stage, i])
            axpy(-2.0 * stage * C[i], q.R[0, i], q.R[stage, i])
        solve_many(q.W, q.pivot, q.R[stage])
        if stage == 0:
            for i in range(n):
                axpy(h, q.R[0, i], q.D[i])
            if curved:
                jacobian(T, K0, T.factor[t], a.tau[1], a.v[1], q.G)
    for i in range(n):
        axpy(0.5 * h, q.R[0, i], q.D[i])
        axpy(0.5 * h, q.R[1, i], q.D[i])


@pasted
def _outputs(R, D, dy):
    clear(dy)
    for r in range(len(dy)):
        for i in range(R.start[r], R.start[r + 1]):
            if R.at[i] < len(D):
                axpy(R.weight[i], D[R.at[i]], dy[r])


@entry
def differentiate(time, u, C, K0, T, S, R, renew, curved, z, k, a, q, dy):
    """dy (nt, nr, p): how the outputs of a run answer to what S moves; filled here.

    curved : whether any dynamic term touches the matrix
    z (nt, n + nb), k (nt, 2, n) : states and rates of the run;  all else as for the kernel
    a, q : the tangents of the states start at q.D, and both are left at the end
    """
    h_last = -1.0
    for t in range(time.size):
        h = length(time, t, h_last)
        if h > 0.0:
            begin(T, u, t, h, a.w, q.df)
            restored(T, K0, z, k, t, h, a, q.F)
            if renew[t] or h != h_last:
                jacobian(T, K0, T.factor[t - 1], a.tau[0], a.v[0], q.G)
                shifted(q.G, GAMMA * h, C, q.W)
                lu(q.W, q.pivot)
            h_last = h
            directions(T, a)
            _step(T, S, K0, C, t, h, curved, a, q)
        _outputs(R, q.D, dy[t])
    for i in range(z[0].size):
        a.z[0, i] = z[time.size - 1, i]
