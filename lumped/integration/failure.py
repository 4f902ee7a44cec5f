"""Why a run could not go on: the node, the time and the input, in words."""

import numpy as np

from lumped.integration.compiled import Compiled
from lumped.integration.runaway import growing_losses
from lumped.model.network import Network
from lumped.numerics.kernel import HOT, KNOT, NODE, OUTSIDE, SHARE, STATUS, Position
from lumped.numerics.terms import Forcing


def failure(network: Network, core: Compiled, forcing: Forcing, at: Position) -> str:
    """What to say of where the run stands."""
    j = min(int(at.at[KNOT]), forcing.time.size - 1)
    before = forcing.time[max(j - 1, 0)]
    t = float(before + at.clock[SHARE] * (forcing.time[j] - before))
    status, hottest = int(at.at[STATUS]), core.control.hottest[0]
    node, where = network.states[int(at.at[NODE])], f"{network.title}: "
    if status == HOT and (growing := growing_losses(network)):
        tables = ", ".join(f"[losses.{name}]" for name in growing)
        why = f"{tables} grow faster with temperature than its cooling: check the units of their inputs"
        return f"{where}thermal runaway at t = {t:g} s: '{node}' passes {hottest:g} degC; {why}"
    if status == HOT:
        cure = "check the units of its inputs, its losses and its links"
        return f"{where}'{node}' passes {hottest:g} degC at t = {t:g} s: more heat than its links carry away; {cure}"
    if status == OUTSIDE:
        what = f"no step keeps '{node}' within what boundaries, start and sources allow at t = {t:g} s"
        return f"{where}{what}{_moving(network, core, forcing, at)}"
    hint = "check the coefficients of the links: G_W_K, R_K_W and what they are multiplied with"
    floating = [s for s, c, row in zip(network.states, core.C, core.K0, strict=True) if c == 0.0 and not np.any(row)]
    if floating:
        hint = f"states without capacity and constant links: {', '.join(floating)}"
    return f"{where}no finite solution at t = {t:g} s; {hint}"


def _moving(network: Network, core: Compiled, forcing: Forcing, at: Position) -> str:
    """The input behind the coefficient that moves most over the interval."""
    j = min(int(at.at[KNOT]), forcing.time.size - 1)
    step = np.abs(forcing.factor[j] - forcing.factor[max(j - 1, 0)])
    scale = np.abs(forcing.factor).max(axis=0, initial=1e-300)
    if not step.size or not np.any(step > 0.0):
        return ""
    name = core.names[int(np.argmax(step / np.maximum(scale, 1e-300)))]
    laws = {x.name: x.law for x in network.links} | {x.name: x.law for x in network.sources}
    return f", where input '{', '.join(laws[name].reads)}' moves '{name}'"
