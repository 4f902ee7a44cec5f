"""What to say when temperatures leave all bounds: where, when, and which law feeds itself."""

import numpy as np

from geom.arrays import Array
from geom.errors import NoSolution
from lumped.model.network import Network
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
