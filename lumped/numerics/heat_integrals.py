"""Heat through the terms at given states, weighted and summed. It is compiled on its own."""

from lumped.numerics.jit import entry
from lumped.numerics.stages import forced
from lumped.numerics.terms import END, ROW, flow


@entry
def count(Q, K0, T, through, first, steps, x, weight, row, a, q, heat):
    """heat (nw, nt, ne) += weight of every instant (s) times the heat flow (W) through every term, by each weighting.

    steps : knot and share of the interval before it at which each instant lies;  x (ni, n) states there
    row (ni,) : the first axis but one of heat that an instant belongs to;  a, q : from stages() and work()
    through : (nw, rows of all terms) weights that sum a term's rows, from first (ne,) on, to the heat through it
    """
    for k in range(weight.size):
        forced(Q, steps.knot[k], 0.0, steps.share[k], a, q)
        for i in range(x[k].size):
            a.z[1, i] = x[k, i]
        flow(T, K0, a.z[1], q.f[1], a.tau[1], a.v[1], q.F[1])
        for e in range(T.m.size):
            c = weight[k] * T.m[e] * q.f[1, e] * a.tau[1, e, 0]
            for s in range(T.part[e, ROW], T.part[e, END]):
                for w in range(len(through)):
                    heat[w, row[k], e] += c * through[w, first[e] + s - T.part[e, ROW]] * a.v[1, s]
