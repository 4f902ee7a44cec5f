"""One instant of a network: heat into every state and how it turns with temperature. It is compiled on its own."""

from lumped.numerics.jit import entry
from lumped.numerics.terms import flow, jacobian


@entry
def instant(T, K0, z, f, tau, v, F, G):
    """F (n,) in C dx/dt = F and G = -dF/dx (n, n) at z+ = [x; u; 1] and input factors f (nf,); tau, v: scratch."""
    flow(T, K0, z, f, tau, v, F)
    jacobian(T, K0, f, tau, v, G)
