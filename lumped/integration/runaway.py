"""Why a run could not go on, or left all bounds: the node, the time, and which law feeds itself, in words."""

import numpy as np

from geom.arrays import Array
from geom.errors import NoSolution
from lumped.integration.compiled import Compiled
from lumped.model.network import Network
from lumped.numerics.kernel import HOT, KNOT, NODE, OUTSIDE, SHARE, STATUS, Position
from lumped.numerics.terms import Forcing
from lumped.transfer.laws import Law, Linear

LIMIT_C = 1e4  # no machine; a run that passes it has no meaning, though its numbers are finite


def checked_run(T: Array, time: Array, names: tuple[str, ...], network: Network) -> Array:
    """Temperatures (n_time, n) of a run; NoSolution names the first that is not finite or beyond LIMIT_C."""
    wild = ~(np.abs(T) < LIMIT_C)
    if wild.any():
        row = int(np.argmax(wild.any(axis=1)))
        place = names[int(np.argmax(wild[row]))]
        t = float(time[row])
        raise NoSolution(f"{network.title}: '{place}' runs away from all bounds at t = {t:g} s; {_cause(network)}")
    return T


def grows(law: Law) -> bool:
    """Whether a loss grows with temperature."""
    return isinstance(law.temperature, Linear) and law.temperature.alpha > 0.0


def growing_losses(network: Network) -> list[str]:
    """The network's own losses that grow with temperature, by name."""
    sources = [s for s in network.sources if not s.origin and grows(s.law)]
    return list(dict.fromkeys(s.name.removeprefix("loss:") for s in sources))


def _cause(network: Network) -> str:
    growing = growing_losses(network)
    if not growing:
        return "check its capacity, its links and the losses at it"
    tables = ", ".join(f"[losses.{name}]" for name in growing)
    grow = "grow with temperature faster than the links carry heat off"
    cure = "check their resistance and currents, and the conductances from there to the surroundings"
    return f"a thermal runaway: {tables} {grow}; {cure}"


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
