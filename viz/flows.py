"""Heat through every link of a network over one step of a run, sorted for drawing."""

from __future__ import annotations

from dataclasses import dataclass

from lumped.balance import Balance
from lumped.network import Network


@dataclass(frozen=True)
class Flow:
    """Heat (W) from node `start` to node or boundary `end`, through parallel links of one kind."""

    start: str
    end: str
    kind: str
    watts: float


@dataclass(frozen=True)
class Heat:
    """losses : source -> W;  flows : between nodes;  out : part or stream the heat leaves by -> W;  stored : W."""

    losses: dict[str, float]
    flows: tuple[Flow, ...]
    out: dict[str, float]

    @property
    def stored(self) -> float:
        """What warms the machine (W)."""
        return sum(self.losses.values()) - sum(self.out.values())


def heat_flows(network: Network, balance: Balance, step: int = -1) -> Heat:
    """Losses, flows and exits over one step of the balance, the last one if not told."""
    losses = {s.name.removeprefix("loss:"): float(balance.power(s.name)[step]) for s in network.sources}
    pairs: dict[tuple[str, str, str], float] = {}
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
        pairs[start, end, link.kind] = pairs.get((start, end, link.kind), 0.0) + watts
        for boundary, part, sign in ((end, start, 1.0), (start, end, -1.0)):
            if boundary in network.boundaries:
                out[part] = out.get(part, 0.0) + sign * watts
    return Heat(losses, tuple(Flow(*key, watts) for key, watts in pairs.items()), out)
