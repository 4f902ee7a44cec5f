"""A fan or pump that stops during a test."""

from dataclasses import dataclass

import numpy as np

from lumped.model.network import Network
from lumped.model.sites import model_links
from lumped.transfer.laws import RUNNING, Inputs
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import Shaped, copy_link
from validation.effects.streams.flow import flows

PARTS = (25, 50, 75)  # percent of the test after which it may have stopped


@dataclass(frozen=True)
class Stopped:
    """-1 from some percent of one test on, 0 before and in all other tests."""

    test: str
    percent: int

    def __call__(self, inputs: Inputs) -> np.ndarray:
        time = np.asarray(inputs["time_s"], float)
        late = time >= time[0] + 0.01 * self.percent * (time[-1] - time[0])
        return -np.where(late, np.asarray(inputs.get(f"{RUNNING}{self.test}", 0.0), float), 0.0)


@dataclass(frozen=True)
class FanStop(Effect):
    """What a flow carries off falls to 1 - a of it at one instant of one test. Place: "FLOW:TEST:50", in percent."""

    kind = "fan.stop"
    title = "fan or pump stops during a test"
    sits = "a declared flow"
    unit = "1"
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
        new = []
        targets = {t for t, _ in original.targets}
        for link in [x for x in model_links(network) if x.name in targets]:
            new.append(f"{self.name}:{link.name}")
            law = Shaped(link.law, Stopped(test, int(part)), link.law.temperature, ("time_s",))
            network = copy_link(network, link, new[-1], law)
        return with_parameter(network, self.parameter(*new))
