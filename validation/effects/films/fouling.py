"""Films weaker than assumed, throughout or more and more: dirt, shelter, a blocked fan."""

from collections.abc import Collection

import numpy as np

from geom.description.roles import Role
from lumped.model.network import Link, Network
from lumped.model.sites import boundaries, cell, part_of, standing_links
from lumped.transfer.laws import Inputs
from validation.effects.base import Effect, Scene, WeakLinks, with_parameter
from validation.effects.build import HOUR, Shaped, copy_elements


def outer_films(network: Network, washing: Collection[str]) -> list[Link]:
    """Films to some boundaries, none of them a test bed, which the machine stands on."""
    washing = set(washing) - set(boundaries(network, Role.TEST_BED))
    outer = [link for link in standing_links(network) if set(link.places) & washing]
    return [link for link in outer if not any(cell(network, place) for place in link.places)]


def films(network: Network, part: str) -> list[Link]:
    """Films of a part to any boundary."""
    outer = outer_films(network, network.boundaries)
    return [link for link in outer if part in {part_of(network, p) for p in link.places} | set(link.places)]


def hours(inputs: Inputs) -> np.ndarray:
    return -(np.asarray(inputs["time_s"], float) - np.asarray(inputs["time_s"], float).flat[0]) / HOUR


def parts_with_films(network: Network) -> list[str]:
    parts = dict.fromkeys(part_of(network, p) for link in network.links for p in link.places)
    return [p for p in parts if p not in network.boundaries and films(network, p)]


class Fouling(Effect):
    """Films of a part fade linearly with time: h = h0 (1 - a t / 1 h), a the fraction lost in one hour."""

    kind = "fouling"
    empirical = True
    title = "cooling fades during the test"
    sits = "a part with a film to air or coolant"
    unit = "1/h"
    source = "definition: dust, icing, a loosening duct, a fan that slows down"
    isolating_test = "repeat the same test after cleaning; the first and last test of the day at the same load"
    typical = (0.05, 0.5)
    prior_sd = 0.2
    high = 0.95
    confused_with = ("mass", "sensor.drift")
    needs = ("time",)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return parts_with_films(scene.network)

    def extend(self, network: Network) -> Network:
        fading = films(network, self.place)
        copies = {f"{self.name}:{x.name}": (x, Shaped.of(x.law, hours, "time_s")) for x in fading}
        return with_parameter(copy_elements(network, copies), self.parameter(*copies))


class Blockage(WeakLinks):
    """Outer films of a part are weaker than assumed: h = h0 (1 + a), -0.95 <= a <= 0 (dirt, shelter, blocked fins)."""

    kind = "blockage"
    title = "cooling of a face is blocked"
    sits = "a part with a film to air or coolant"
    source = "definition; open fin channels lose flow along their length (Valenzuela and Tapia 2008)"
    isolating_test = "clean the fins; cool-down with the face freely exposed"
    typical = (-0.7, -0.1)
    prior_sd = 0.3
    confused_with = ("fouling", "flow")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return parts_with_films(scene.network)

    def links(self, network: Network) -> list[Link]:
        return films(network, self.place)


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

    def links(self, network: Network) -> list[Link]:
        return outer_films(network, {self.place})
