"""What an observer learns from recordings: the constants of its model and of its sensors, with their priors.

Of the model: its own parameters, and for every conductance that nothing drives how much it grows with what moves air
or liquid (speed, flow): (1 + a |u| / rms u), a >= 0, whose prior is as wide as that of the conductance itself. Of a
sensor, by the table of doubt: the share of each neighbour in its reading, its slope and its bias.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from thermoscope import Network, Parameter, plugin as th

MOVING = ("speed", *th.FLOWS)
FARTHEST = 1.5  # of a logarithm: beyond, a tangent says nothing
LEARNED = "learned:"


@dataclass(frozen=True)
class Sensor:
    """A channel as its readings are to be taken.  bias_K : what it reads too much"""

    channel: th.Channel
    bias_K: float = 0.0

    def of(self, c: th.Channel) -> "Sensor":
        """The same sensor in another recording, which has its own lag."""
        return replace(self, channel=replace(c, row=self.channel.row))


def with_motion(network: Network, tests: Sequence[th.Test]) -> Network:
    """The network with a neutral parameter for every conductance that may follow what moves air or liquid."""
    for signal in [s for q in MOVING if (s := network.signal(q)) and all(s in t.inputs for t in tests)]:
        level = float(np.sqrt(np.mean(np.concatenate([np.square(t.inputs[signal]) for t in tests]))))
        for p in network.parameters if level > 0.0 else ():
            network = _following(network, p, signal, level)
    return network


def _following(network: Network, p: Parameter, signal: str, level: float) -> Network:
    """The network in which the links of a parameter may grow with a signal."""
    links = [x for x in network.links if (x.name, 1.0) in p.targets and isinstance(x.law, th.Fixed)]
    links = [x for x in links if x.kind != "stream" and not x.origin]
    if p.mapping != "log" or not links:
        return network
    names = [f"{x.name} by {signal}" for x in links]
    for link, name in zip(links, names, strict=True):
        assert isinstance(link.law, th.Fixed)
        law = th.InputPower(link.law.value, ((signal, level, 1.0),), link.law.temperature)
        network = th.copy_element(network, link, name, law)
    name, targets = f"{LEARNED}{p.name} by {signal}", tuple((n, 1.0) for n in names)
    new = Parameter(name, targets, 0.0, "1", 0.0, 10.0, p.prior_sd, "amplitude", 0.0)
    return replace(network, parameters=(*network.parameters, new))


@dataclass(frozen=True)
class Constants:
    """network : with_motion;  start : its values before;  channels : one of each sensor;  doubt : the table

    The vector (k,) holds the parameters in fitting coordinates, then of each sensor its shares, slope and bias.
    """

    network: Network
    start: Mapping[str, float]
    channels: tuple[th.Channel, ...]
    doubt: th.Doubt

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """Those of the network that heat depends on and that may move."""
        return tuple(p for p in self.network.parameters if th.head(p) == "thermal" and p.prior_sd > 0.0)

    @cached_property
    def beside(self) -> tuple[tuple[tuple[th.Row, float], ...], ...]:
        """Of each sensor its neighbours, as rows, and the share (one sigma) of each in its reading."""
        return tuple(
            tuple((self.network.places[n].mean, share) for n, share in th.neighbours(self.network, c, self.doubt))
            for c in self.channels
        )

    @cached_property
    def air(self) -> th.Row:
        """Mean of all boundaries: from there a slope counts."""
        n, count = len(self.network.states), len(self.network.boundaries)
        return th.Row(n + np.arange(count), np.full(count, 1.0 / max(count, 1)))

    @cached_property
    def sd(self) -> th.Array:
        """(k,) priors."""
        of_sensors = [
            x
            for c, near in zip(self.channels, self.beside, strict=True)
            for x in (*(share for _, share in near), self.doubt["gain"], c.sigma_K)
        ]
        return np.array([*(p.prior_sd for p in self.parameters), *of_sensors])

    def first(self, j: int) -> int:
        """Where sensor j begins in the vector."""
        return len(self.parameters) + sum(len(near) + 2 for near in self.beside[:j])

    def values(self, w: th.Array) -> dict[str, float]:
        """Of the network's parameters, as far from where they began as w (k,) says."""
        return {**self.start, **{p.name: self._value(p, float(x)) for p, x in zip(self.parameters, w)}}

    def _value(self, p: Parameter, x: float) -> float:
        usual = self.start.get(p.name, p.value)
        if p.mapping == "log":
            return float(np.clip(usual * np.exp(np.clip(x, -FARTHEST, FARTHEST)), p.low, p.high))
        return float(np.clip(usual + th.to_value(p, x) - p.neutral, p.low, p.high))

    def sensor_row(self, j: int, w: th.Array) -> th.Row:
        """The row that sensor j reads, over z = [x; u]."""
        i, c, near = self.first(j), self.channels[j], self.beside[j]
        shares, slope = w[i : i + len(near)], w[i + len(near)]
        parts = [(c.row, 1.0 - shares.sum() + slope), (self.air, -slope)]
        parts += [(row, float(a)) for (row, _), a in zip(near, shares, strict=True)]
        return th.Row(np.concatenate([r.index for r, _ in parts]), np.concatenate([f * r.weights for r, f in parts]))

    def by_sensor(self, j: int, z: th.Array) -> Iterator[tuple[int, float]]:
        """Where in the vector, and how much (K) its reading at z = [x; u] changes with it."""
        i, reading = self.first(j), self.channels[j].row.at(z)
        for k, (row, _) in enumerate(self.beside[j]):
            yield i + k, row.at(z) - reading
        yield i + len(self.beside[j]), reading - self.air.at(z)
        yield i + len(self.beside[j]) + 1, 1.0

    def bias(self, j: int, w: th.Array) -> float:
        return float(w[self.first(j) + len(self.beside[j]) + 1])

    def sensors(self, w: th.Array) -> dict[str, Sensor]:
        """Name -> the sensor as it was learned."""
        return {
            c.name: Sensor(replace(c, row=self.sensor_row(j, w)), self.bias(j, w)) for j, c in enumerate(self.channels)
        }
