"""Heat through every link of a network over one step of a run, sorted for drawing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geom.arrays import Array
from lumped.integration.balance import Balance
from lumped.model.network import Link, Network
from validation.parameters.unknowns import value_words


@dataclass(frozen=True)
class Flow:
    """Heat (W) from node `start` to node or boundary `end`, through parallel links of one kind.

    conductance : W/K between the two if each had one temperature
    """

    start: str
    end: str
    kind: str
    watts: float
    conductance: float


@dataclass(frozen=True)
class Heat:
    """losses : source -> W;  flows : between nodes;  out : part or stream the heat leaves by -> W;  stored : W.

    streams : those of `out` that are streams
    """

    losses: dict[str, float]
    flows: tuple[Flow, ...]
    out: dict[str, float]
    streams: frozenset[str] = frozenset()

    @property
    def stored(self) -> float:
        """What warms the machine (W)."""
        return sum(self.losses.values()) - sum(self.out.values())


RUNNING = 0.5  # of the largest losses of a record: less is a machine that coasts or stands


def last_running_step(network: Network, balance: Balance) -> int:
    """The last step of a balance in which the machine runs; the last one where it never does."""
    total = np.sum([balance.power(s.name) for s in network.sources], axis=0)
    running = np.flatnonzero(total >= RUNNING * total.max(initial=0.0))
    return int(running[-1]) if running.size and total.max() > 0 else total.size - 1


def heat_flows(network: Network, balance: Balance, step: int = -1) -> Heat:
    """Losses, flows and exits over one step of the balance, the last one if not told."""
    z = balance.z[1:][step]
    losses: dict[str, float] = {}
    for source in network.sources:
        name = source.name.removeprefix("loss:").partition("^")[0]  # what an exponent changes is the loss's own
        name = value_words(name.removesuffix(":rise").removesuffix(":base"))
        losses[name] = losses.get(name, 0.0) + float(balance.power(source.name)[step])
    pairs: dict[tuple[str, str, str], Array] = {}
    out: dict[str, float] = {}
    for link in network.links:
        watts = float(balance.power(link.name)[step])
        start, end = (network.places[p].part if p in network.places else p for p in link.places)
        if link.kind == "stream":
            name = link.name.removeprefix("stream:")
            out[name] = out.get(name, 0.0) + watts
            continue
        if start == end:
            continue
        both = np.array([watts, conductance(network, link, (start, end), watts, z)])
        pairs[start, end, link.kind] = pairs.get((start, end, link.kind), np.zeros(2)) + both
        for boundary, part, sign in ((end, start, 1.0), (start, end, -1.0)):
            if boundary in network.boundaries:
                out[part] = out.get(part, 0.0) + sign * watts
    streams = frozenset(link.name.removeprefix("stream:") for link in network.links if link.kind == "stream")
    return Heat(losses, tuple(Flow(*key, *both.tolist()) for key, both in pairs.items()), out, streams)


def conductance(network: Network, link: Link, ends: tuple[str, str], watts: float, z: Array) -> float:
    """W/K of a link between two nodes of one temperature each: its coefficient times the entry of its pattern.

    The coefficient is the heat that passes over what the pattern makes of the temperatures z.
    """
    mean = next(network.states.index(end) for end in ends if end in network.states)
    mine = link.rows == mean
    difference = float(link.vals[mine] @ z[link.cols[mine]])
    return abs(watts / difference) * float(link.vals[mine & (link.cols == mean)].sum()) if difference else 0.0
