"""Heat through the terms of a run, counted after it by the scheme's own quadrature. Compiled on its own."""

from __future__ import annotations

from lumped.jit import entry
from lumped.stages import GAMMA, begin, directions, taken
from lumped.terms import ROWS, flow


@entry
def count(time, u, K0, T, through, z, k, a, q, heat):
    """heat (nw, nt, ne): cumulated J through every term since the start, by each weighting; filled here, zero before.

    z (nt, n + nb), k (nt, 2, n): states and rates of a run;  a, q : from stages() and work()
    through : (nw, rows of all terms) weights that sum a term's rows to the heat through it
    """
    n = k[0, 0].size
    for t in range(1, time.size):
        h = time[t] - time[t - 1]
        if h > 0.0:
            begin(T, u, t, h, a.w, q.df)
            for i in range(n):
                a.w[0, i], a.w[1, i] = k[t, 0, i], k[t, 1, i]
                a.z[0, i], a.z[1, i] = z[t - 1, i], z[t - 1, i] + h * k[t, 0, i]
            for i in range(n, z[0].size):
                a.z[0, i], a.z[1, i] = z[t - 1, i], z[t, i]
            for stage in range(2):
                flow(T, K0, a.z[stage], T.factor[t - 1 + stage], a.tau[stage], a.v[stage], q.F)
            directions(T, a)
        for e in range(T.m.size):
            for w in range(len(through)):
                heat[w, t, e] = heat[w, t - 1, e]
            for s in range(T.start[e, ROWS], T.start[e + 1, ROWS]):
                for stage in range(2):
                    out = 0.5 * h * T.m[e] * taken(T, e, s, stage, t, q.df[e], a, GAMMA * h)
                    for w in range(len(through)):
                        heat[w, t, e] += through[w, s] * out
