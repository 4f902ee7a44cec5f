"""A machine like the model but not the model: what the simulated null is measured on.

Films bend with temperature and with their inputs, nodes hide a core, links of one group spread, sensors sit a little
beside their place, inputs and clocks are a little off. No effect of the catalogue is added.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from lumped.laws import Constant, Fixed, Inputs, Law, Power, Table, TemperatureLaw
from lumped.network import Link, Network, Place, Row, Source
from lumped.quantities import AIR, LIQUID
from validation.bridges import bridges
from validation.case import Channel, Test
from validation.forms import KNOTS, SETTLE_K
from validation.operators import shifted

Array = NDArray[np.float64]
CORE = " (core)"


@dataclass(frozen=True)
class Spread:
    """1-sigma of what a model of this kind gets wrong. Exponents (1), relative errors (1), K and s."""

    film_exponent: float = 0.08
    input_exponent: float = 0.08
    loss_exponent: float = 0.1
    group: float = 0.1
    conductivity: float = 0.15
    capacity: float = 0.05
    core: float = 0.7
    placement: float = 0.08
    stream: float = 0.1
    bridge: float = 0.1
    flow: float = 0.03
    wander_K: float = 0.2
    clock_s: float = 1.0
    slow_noise: float = 0.15


USUAL = Spread()


@dataclass(frozen=True)
class Bent(Law):
    """Another law with its input dependence raised to 1 + `power`, rescaled, and a temperature law of its own."""

    base: Law
    power: float
    scale: float
    temperature: TemperatureLaw
    reads: tuple[str, ...] = field(init=False, default=())
    over_record: ClassVar[bool] = True  # bent about the level of the record

    def __post_init__(self) -> None:
        object.__setattr__(self, "reads", self.base.reads)

    def factor(self, inputs: Inputs) -> Array | float:
        value = np.asarray(self.base.factor(inputs), float) * self.scale
        level = float(np.sqrt(np.mean(value**2)))
        if value.ndim == 0 or level == 0.0:
            return value if value.ndim else float(value)
        relative = np.maximum(np.abs(value) / level, 1e-6)
        return np.asarray(value * relative**self.power)


def bent_temperature(law: TemperatureLaw, power: float) -> TemperatureLaw:
    """The temperature law times (dT / 40 K)^power, where it is constant or a power of dT."""
    if not isinstance(law, (Constant, Power)):
        return law
    exponent = law.exponent if isinstance(law, Power) else 0.0
    knots: Array = np.array(KNOTS)
    value = knots**exponent * (np.maximum(knots, 1.0) / SETTLE_K) ** power
    return Table(KNOTS, tuple(value))


def disturbed(network: Network, rng: np.random.Generator, spread: Spread = USUAL) -> Network:
    """The network with bent films and losses, other materials where no parameter frees them, and cores inside nodes."""
    shared = {t for p in network.parameters if len(p.targets) > 1 for t, _ in p.targets}
    free = {t for p in network.parameters for t, _ in p.targets}
    links = tuple(_bent_link(network, link, rng, spread, link.name in shared) for link in network.links)
    links = tuple(x if x.name in free else _other_material(x, rng, spread) for x in links)
    bridged = bridges(network, rng, spread.bridge)
    sources = tuple(_bent_source(s, rng, spread) for s in network.sources)
    network = replace(network, links=(*links, *bridged), sources=sources, C=other_capacities(network, rng, spread))
    return network if any("#" in s for s in network.states) else with_cores(network, rng, spread)


def _bent_link(network: Network, link: Link, rng: np.random.Generator, spread: Spread, shared: bool) -> Link:
    film = link.kind == "film" or bool(set(link.places) & set(network.boundaries))
    if not film or link.kind == "stream":
        return link
    scale = float(np.exp(spread.group * rng.standard_normal())) if shared else 1.0
    temperature = bent_temperature(link.law.temperature, spread.film_exponent * rng.standard_normal())
    return replace(link, law=Bent(link.law, spread.input_exponent * rng.standard_normal(), scale, temperature))


def _other_material(link: Link, rng: np.random.Generator, spread: Spread) -> Link:
    """Conduction inside a part of another conductivity."""
    if link.kind != "conduction":
        return link
    scale = float(np.exp(spread.conductivity * rng.standard_normal()))
    return replace(link, law=Bent(link.law, 0.0, scale, link.law.temperature))


def other_capacities(network: Network, rng: np.random.Generator, spread: Spread) -> Array:
    """Heat capacities (J/K) of parts whose capacity is not a parameter of its own; a part and its shapes as one."""
    groups = network.capacity_group or network.states
    single = {p.targets[0][0] for p in network.parameters if len(p.targets) == 1}
    factor = {g: float(np.exp(spread.capacity * rng.standard_normal())) for g in dict.fromkeys(groups)}
    return network.C * np.array([1.0 if f"capacity:{g}" in single else factor[g] for g in groups])


def _bent_source(source: Source, rng: np.random.Generator, spread: Spread) -> Source:
    if source.kind in ("copper", "measured"):
        return source
    return replace(
        source, law=Bent(source.law, spread.loss_exponent * rng.standard_normal(), 1.0, source.law.temperature)
    )


def with_cores(network: Network, rng: np.random.Generator, spread: Spread) -> Network:
    """Every node with mass keeps a share of it behind a resistance of 10 to 60 s: twice as fine a network."""
    n, heavy = len(network.states), [i for i, c in enumerate(network.C) if c > 0]
    m = len(heavy)
    share, tau = rng.uniform(0.3, spread.core, m), rng.uniform(10.0, 60.0, m)
    C = np.concatenate([network.C, network.C[heavy] * share])
    C[heavy] = network.C[heavy] * (1.0 - share)
    G = network.C[heavy] * share * (1.0 - share) / tau
    names = tuple(f"{network.states[i]}{CORE}" for i in heavy)
    groups = network.capacity_group or network.states
    moved = tuple(moved_link(link, n, m) for link in network.links)
    inner = tuple(_pair(f"core:{names[k]}", i, n + k, G[k]) for k, i in enumerate(heavy))
    shares = {i: (n + k, share[k]) for k, i in enumerate(heavy)}
    sources = tuple(_spread_source(s, shares, n, m) for s in network.sources)
    return replace(
        network, states=(*network.states, *names), C=C, links=(*moved, *inner), sources=sources,
        capacity_group=(*groups, *(groups[i] for i in heavy)),
    )  # fmt: skip


def _spread_source(source: Source, shares: Mapping[int, tuple[int, float]], n: int, m: int) -> Source:
    """The heat of a source shared between skin and core as their masses."""
    inner = [(w, *shares[int(i)]) for i, w in zip(source.index, source.weights, strict=True) if int(i) in shares]
    skin = [w * (1.0 - shares[int(i)][1]) if int(i) in shares else w for i, w in zip(source.index, source.weights)]
    index = np.concatenate([source.index, np.array([core for _, core, _ in inner], int)])
    weights = np.array([*skin, *(w * s for w, _, s in inner)])
    return replace(source, index=index, weights=weights, probe=moved_row(source.probe, n, m))


def _pair(name: str, i: int, j: int, G: float) -> Link:
    rows, cols = np.array([i, i, j, j]), np.array([i, j, j, i])
    one = np.ones(1)
    ends = Row(np.array([i]), one), Row(np.array([j]), one)
    return Link(name, "conduction", (name, name), rows, cols, np.array([1.0, -1.0, 1.0, -1.0]), Fixed(float(G)), *ends)


def moved_row(row: Row, n: int, m: int) -> Row:
    """A row over z after m states were put behind the first n."""
    return Row(np.where(row.index >= n, row.index + m, row.index), row.weights)


def moved_link(link: Link, n: int, m: int) -> Link:
    cols = np.where(link.cols >= n, link.cols + m, link.cols)
    return replace(link, cols=cols, hot=moved_row(link.hot, n, m), cold=moved_row(link.cold, n, m))


def disturbed_test(test: Test, network: Network, real: Network, rng: np.random.Generator, spread: Spread) -> Test:
    """The test as the disturbed machine sees it: other inputs than recorded, sensors beside their place."""
    n, m = len(network.states), len(real.states) - len(network.states)
    boundaries = {b: u + wander(test.time, spread.wander_K, 600.0, rng) for b, u in test.boundaries.items()}
    flows = [name for name in test.inputs if network.measures(name) in (AIR, LIQUID)]
    inputs = {**test.inputs, **{k: test.inputs[k] * (1.0 + spread.flow * rng.standard_normal()) for k in flows}}
    channels = tuple(_beside(c, network, n, m, rng, spread) for c in test.channels)
    initial = test.initial
    if isinstance(initial, Mapping):
        initial = {**initial, **{f"{k}{CORE}": v for k, v in initial.items() if f"{k}{CORE}" in real.states}}
    return replace(test, inputs=inputs, boundaries=boundaries, channels=channels, initial=initial)


def _beside(c: Channel, network: Network, n: int, m: int, rng: np.random.Generator, spread: Spread) -> Channel:
    """A share of a neighbour's temperature in the reading; in a stream it is not the mean that is read."""
    near = [p for p in _near(network, c.place) if p.kind != "surface"]
    row = moved_row(c.row, n, m)
    if not near:
        return replace(c, row=row)
    fluid = c.place in network.places and network.places[c.place].kind == "fluid"
    share = (spread.stream if fluid else spread.placement) * abs(rng.standard_normal())
    other = moved_row(near[rng.integers(len(near))].mean, n, m)
    index = np.concatenate([row.index, other.index])
    return replace(c, row=Row(index, np.concatenate([(1.0 - share) * row.weights, share * other.weights])))


def _near(network: Network, place: str) -> list[Place]:
    part = network.places[place].part if place in network.places else place
    joined = [link.places for link in network.links if part in link.places]
    names = {name for pair in joined for name in pair if name != part}
    return [place for name, place in network.places.items() if name in names]


def wander(time: Array, sd: float, tau: float, rng: np.random.Generator) -> Array:
    """An Ornstein-Uhlenbeck path (n,) of standard deviation sd."""
    keep = np.exp(-np.diff(time, prepend=time[0]) / tau)
    kick, out = rng.standard_normal(time.size), np.empty(time.size)
    level = kick[0]
    for i in range(time.size):
        level = keep[i] * level + np.sqrt(max(1.0 - keep[i] ** 2, 0.0)) * kick[i]
        out[i] = sd * level
    return out


def reading_errors(test: Test, y: Array, rng: np.random.Generator, spread: Spread, white: Sequence[float]) -> Array:
    """Readings (n_time, n_channel) with clock error, white and slow noise."""
    y = shifted(test.time, y, spread.clock_s * float(rng.standard_normal()))
    for j, c in enumerate(test.channels):
        slow = wander(test.time, spread.slow_noise * c.sigma_K * abs(rng.standard_normal()), 180.0, rng)
        y[:, j] += slow + white[j] * rng.standard_normal(test.time.size)
    return np.asarray(np.where(np.isfinite(np.stack([c.y for c in test.channels], axis=1)), y, np.nan))
