"""What can hold in one test or for a while: films, flows, inputs, boundaries, mounting; never masses or joints."""

from __future__ import annotations

from lumped.model.sites import ambient
from validation.effects import Effect, Scene, kinds

EVERYWHERE = ("loss.constant", "convection.constant")  # at every node: a lid that is open cools what it never washed
AS_DECLARED = ("conduction.bench", "flow", "blockage", "input.factor")  # where the catalogue has them
IN_WHOLE_TESTS = ("ambient.offset", "input.offset")


def temporary_effects(scene: Scene) -> tuple[Effect, ...]:
    """Effects that can hold for a while."""
    table, network = kinds(), scene.network
    nodes = [p.name for p in network.places.values() if p.kind in ("part", "node", "fluid")]
    everywhere = [k for k in EVERYWHERE if k != "convection.constant" or ambient(network)]
    everyday = [
        table[k](place) for k in everywhere for place in nodes if network.C[network.places[place].states[0]] > 0
    ]
    return (*everyday, *(table[k](place) for k in AS_DECLARED for place in table[k].places(scene)))


def single_test_effects(scene: Scene) -> tuple[Effect, ...]:
    """Effects that can hold in one test: those, and a thermometer of a boundary that was elsewhere."""
    table = kinds()
    return (*temporary_effects(scene), *(table[k](place) for k in IN_WHOLE_TESTS for place in table[k].places(scene)))
