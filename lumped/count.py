"""Heat through the terms of a run, counted after it by the scheme's own quadrature. Compiled on its own."""

from __future__ import annotations

from lumped.jit import entry
from lumped.stages import GAMMA, begin, directions, restored, taken
from lumped.terms import ROWS


@entry
def count(time, u, K0, T, through, z, k, a, q, heat):
    """heat (nw, nt, ne): cumulated J through every term since the start, by each weighting; filled here, zero before.

    z (nt, n + nb), k (nt, 2, n): states and rates of a run;  a, q : from stages() and work()
    through : (nw, rows of all terms) weights that sum a term's rows to the heat through it
    """
    for t in range(1, time.size):
        h = time[t] - time[t - 1]
        if h > 0.0:
            begin(T, u, t, h, a.w, q.df)
            restored(T, K0, z, k, t, h, a, q.F)
            directions(T, a)
        for e in range(T.m.size):
            for w in range(len(through)):
                heat[w, t, e] = heat[w, t - 1, e]
            for s in range(T.start[e, ROWS], T.start[e + 1, ROWS]):
                for stage in range(2):
                    out = 0.5 * h * T.m[e] * taken(T, e, s, stage, t, q.df[e], a, GAMMA * h)
                    for w in range(len(through)):
                        heat[w, t, e] += through[w, s] * out
