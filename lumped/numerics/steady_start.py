"""Rest: the states without heat capacity at their balance, the others as they are. It is compiled on its own."""

from lumped.numerics.dense import axpy, copy, fill, lu, solve, solve_many
from lumped.numerics.jit import entry, inner, pasted
from lumped.numerics.stages import finite
from lumped.numerics.terms import END, ROW, clear, flow, jacobian

MOST_ITERATIONS, CONVERGED_K = 50, 1e-9  # of Newton: more would be a cycle, not a way; far below any step's error


@pasted
def _newton(T, K0, C, f, a, q):
    """Bring the states without capacity to their balance at fixed others (Newton); q.G is left as -dF/dx there.

    States with capacity stay: the identity stands in their rows.
    """
    n = C.size
    for _ in range(MOST_ITERATIONS):
        flow(T, K0, a.z[0], f, a.tau[0], a.v[0], q.F[0])
        jacobian(T, K0, f, a.tau[0], a.v[0], q.G)
        W = q.L.A[0]
        for i in range(n):
            copy(q.G[i, :n], W[i])
            if C[i] > 0.0:
                q.F[0, i] = 0.0
                clear(W[i : i + 1])
                W[i, i] = 1.0
        fill(W, n)
        if not lu(q.L, 0):
            return False
        solve(q.L, 0, q.F[0])
        largest = 0.0
        for i in range(n):
            a.z[0, i] += q.F[0, i]
            largest = max(largest, abs(q.F[0, i]))
        if largest < CONVERGED_K:
            return finite(a.z[0])
    return False


@inner
def outside(B, D, c, out):
    """out -= c B D of the boundaries.  B (n, nb) : what G has in their columns"""
    n = len(B)
    for i in range(n):
        for b in range(len(D) - n):
            axpy(-c * B[i, b], D[n + b], out[i])


@pasted
def _tangents(T, S, C, f, a, q):
    """q.D: tangents of the states without capacity, at the balance found just before."""
    clear(q.R[0])
    for i in range(S.term.size):
        e = S.term[i]
        for s in range(T.part[e, ROW], T.part[e, END]):
            q.R[0, T.row[s], S.tangent[i]] -= S.slope[i] * f[e] * a.tau[0, e, 0] * a.v[0, s]
    outside(q.G[:, C.size :], q.D, 1.0, q.R[0])
    for i in range(C.size):
        if C[i] > 0.0:
            copy(q.D[i], q.R[0, i])
    solve_many(q.L, 0, q.R[0])
    for i in range(C.size):
        copy(q.R[0, i], q.D[i])


@entry
def solve_steady_start(C, K0, T, S, f, a, q):
    """Bring a.z[0] and its tangents q.D to the balance at input factors f (nf,); False if there is none.

    C, K0, T, S, a, q as for the kernel; without any capacity this is where the whole network comes to rest.
    """
    if not _newton(T, K0, C, f, a, q):
        return False
    if q.D[0].size > 0:
        _tangents(T, S, C, f, a, q)
    return True
