"""More or less fan air or coolant than stated: in all, past the machine, or from some instant on."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from lumped.model.network import Link, Network, Parameter
from lumped.model.quantities import AIR, LIQUID
from lumped.model.sites import cell, model_links
from lumped.transfer.laws import RUNNING, Inputs
from validation.effects.base import Effect, Scene, WeakLinks, with_parameter
from validation.effects.build import Shaped, copy_elements, label

PARTS = (25, 50, 75)  # percent of the test after which a fan or pump may have stopped


def flows(network: Network) -> list[Parameter]:
    """Parameters that are said to be a flow, or act as one: on streams, and on films by an exponent."""
    links = {link.name: link for link in network.links}
    return [p for p in network.parameters if p.mapping == "log" and (p.flow or _acts_as_flow(network, links, p))]


def _acts_as_flow(network: Network, links: Mapping[str, Link], p: Parameter) -> bool:
    pairs = [(links[t], e) for t, e in p.targets if t in links]
    if len(pairs) < len(p.targets) or not pairs:
        return False
    streams = [e == 1.0 for link, e in pairs if link.kind == "stream"]
    films = [
        e != 1.0 and any(network.measures(name) in (AIR, LIQUID) for name in link.law.reads)
        for link, e in pairs
        if link.kind != "stream"
    ]
    return all(streams) and all(films)


class Flow(Effect):
    """A flow that differs from the stated one: V = V0 (1 + a), with everything that follows the flow."""

    kind = "flow"
    title = "fan or coolant flow differs from the stated one"
    sits = "a declared flow"
    source = "definition; films follow the flow with the exponents the network declares"
    isolating_test = "measure the flow; inlet and outlet temperature at constant loss; run with the fan off"
    typical = (-0.5, 0.7)
    sign = 0
    prior_sd = 0.3
    low = -0.9
    high = 3.0
    mapping = "relative"
    confused_with = ("convection", "convection.constant")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return [p.name for p in flows(scene.network)]

    def extend(self, network: Network) -> Network:
        (original,) = [p for p in flows(network) if p.name == self.place]
        return with_parameter(network, replace(self.parameter(), targets=original.targets))


def streams(network: Network) -> list[Link]:
    return [link for link in model_links(network) if link.kind == "stream" and not cell(network, link.places[1])]


class AirLeak(WeakLinks):
    """A share of a fluid stream passes by: m = m0 (1 + a), -0.95 <= a <= 0, films on the rest unchanged."""

    kind = "bypass"
    empirical = True
    title = "part of the stream passes by"
    sits = "a stream"
    source = "mass balance of the stream"
    isolating_test = "inlet and outlet temperature at constant loss; flow sweep"
    typical = (-0.6, -0.1)
    prior_sd = 0.3
    confused_with = ("flow",)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return [label(link) for link in streams(scene.network)]

    def links(self, network: Network) -> list[Link]:
        return [link for link in streams(network) if label(link) == self.place]


@dataclass(frozen=True)
class Stopped:
    """-1 from some percent of one test on, 0 before and in all other tests."""

    test: str
    percent: int

    def __call__(self, inputs: Inputs) -> np.ndarray:
        time = np.asarray(inputs["time_s"], float)
        late = time >= time[0] + 0.01 * self.percent * (time[-1] - time[0])
        return -np.where(late, np.asarray(inputs.get(f"{RUNNING}{self.test}", 0.0), float), 0.0)


class FanStop(Effect):
    """What a flow carries off falls to 1 - a of it at one instant of one test. Place: "FLOW:TEST:50", in percent."""

    kind = "fan.stop"
    title = "fan or pump stops during a test"
    sits = "a declared flow"
    source = "definition: a tripped breaker, a slipped hose"
    isolating_test = "read the flow, or listen; repeat the test"
    typical = (0.3, 1.0)
    prior_sd = 0.5
    high = 1.0
    confused_with = ("flow", "fouling")
    needs = ("time",)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        names = [p.name for p in flows(scene.network)]
        return [f"{flow}:{test}:{part}" for flow in names for test in scene.tests for part in PARTS]

    def extend(self, network: Network) -> Network:
        which, part = self.place.rsplit(":", 1)
        original = next(p for p in flows(network) if which.startswith(f"{p.name}:"))
        test = which.removeprefix(f"{original.name}:")
        stop, targets = Stopped(test, int(part)), {t for t, _ in original.targets}
        mine = [x for x in model_links(network) if x.name in targets]
        copies = {f"{self.name}:{x.name}": (x, Shaped.of(x.law, stop, "time_s")) for x in mine}
        return with_parameter(copy_elements(network, copies), self.parameter(*copies))
