"""How warm the fluids of a machine become in the load cases its network is checked with."""

from types import SimpleNamespace

import pytest
from bare_networks import means_only

from geom import load_machine
from lumped.build.load_cases import fluid_rises, rated_watts
from lumped.build.pipeline import prepared
from lumped.condensation.zone import Zone

MACHINE = load_machine("ipmsm-48s8p-jacket")


@pytest.fixture(scope="module")
def jacketed():
    """What `fluid_rises` reads of a reduction, and a network of means only."""
    ready = prepared(MACHINE, 0.1, 36, across=1)
    zones = {part: Zone(part) for part in ready.field.blocks}
    reduction = SimpleNamespace(field=ready.field, films=ready.films, contacts=ready.contacts, zones=zones)
    return reduction, means_only(ready)


def test_all_heat_that_the_air_does_not_take_warms_the_coolant(jacketed):
    reduction, network = jacketed
    rated = {part: 1000.0 / len(reduction.zones) for part in reduction.zones}
    rises = fluid_rises(MACHINE, reduction, network, rated)
    coolant = [rise for name, rise in rises.items() if name.startswith("jacket@")]
    kelvin_per_watt = 1.0 / (5.0 / 60e3 * 1050.0 * 3500.0)  # 5 L/min of 50/50 glycol, within a tenth
    assert all(rise > 0.0 for rise in rises.values())
    assert 0.5 * 1000.0 * kelvin_per_watt < max(coolant) < 1.1 * 1000.0 * kelvin_per_watt


def test_rises_are_proportional_to_losses(jacketed):
    reduction, network = jacketed
    rated = rated_watts(MACHINE, network)
    once = fluid_rises(MACHINE, reduction, network, rated)
    twice = fluid_rises(MACHINE, reduction, network, {zone: 2.0 * watts for zone, watts in rated.items()})
    assert twice == pytest.approx({fluid: 2.0 * rise for fluid, rise in once.items()})
    assert set(fluid_rises(MACHINE, reduction, network, {}).values()) == {0.0}


def test_ends_of_a_winding_are_heated_though_its_loss_is_named_after_the_middle(jacketed):
    _, network = jacketed
    parts = set(network.heated)
    ends = {"winding.left", "winding.right"}
    assert {"winding", "stator.core", *ends} <= parts
    assert ends.isdisjoint(source.place for source in network.sources)
    assert parts.isdisjoint({"housing", "shaft"})
