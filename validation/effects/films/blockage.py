"""Films weaker than assumed."""

from dataclasses import dataclass

from lumped.model.network import Link, Network
from lumped.model.sites import part_of
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.streams.fouling import films, outer_films


@dataclass(frozen=True)
class Blockage(Effect):
    """Outer films of a part are weaker than assumed: h = h0 (1 + a), -0.95 <= a <= 0 (dirt, shelter, blocked fins)."""

    kind = "blockage"
    title = "cooling of a face is blocked"
    sits = "a part with a film to air or coolant"
    unit = "1"
    source = "definition; open fin channels lose flow along their length (Valenzuela and Tapia 2008)"
    isolating_test = "clean the fins; cool-down with the face freely exposed"
    typical = (-0.7, -0.1)
    sign = -1
    prior_sd = 0.3
    low = -0.95
    high = 0.0
    mapping = "relative"
    confused_with = ("fouling", "flow")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        parts = dict.fromkeys(part_of(scene.network, p) for link in scene.network.links for p in link.places)
        return [p for p in parts if p not in scene.network.boundaries and films(scene.network, p)]

    def films(self, network: Network) -> list[Link]:
        """What it weakens."""
        return films(network, self.place)

    def extend(self, network: Network) -> Network:
        return with_parameter(network, self.parameter(*(link.name for link in self.films(network))))


@dataclass(frozen=True)
class SharedBlockage(Blockage):
    """Films of all parts to one boundary are weaker at once, by one share: a clogged filter, a slow pump, a cover."""

    kind = "blockage.all"
    title = "less cooling of all faces"
    sits = "a boundary that cools more than one part"
    source = "definition: films of one flow of air or coolant follow it together"
    isolating_test = "read the flow or the fan's speed; clean the filter; repeat the test without a cover"
    confused_with = ("blockage", "flow")
    temporary = True

    @property
    def statement(self) -> str:
        return f"{self.title} by {self.place}"

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        one = scene.network
        parts = {
            b: {part_of(one, p) for x in outer_films(one, {b}) for p in x.places if p != b} for b in one.boundaries
        }
        return [boundary for boundary, some in parts.items() if len(some) > 1]

    def films(self, network: Network) -> list[Link]:
        return outer_films(network, {self.place})
