"""How warm the fluids of a machine become in the load cases its network is checked with."""

from types import SimpleNamespace

import pytest
from bare_networks import means_only

from geom import InputError, load_machine
from geom.description import shapes
from geom.description.machine import Machine
from geom.description.part import Part
from geom.description.roles import Role
from lumped.build.fixed_coefficients import fluid_rises, rated_watts
from lumped.build.network_size import accurate_network
from lumped.build.pipeline import prepared
from lumped.condensation.condensed import Zone

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


HEAT = {"kind": "constant", "at": "winding", "P_W": 50.0, "of": {"input": "current_A", "at": 5.0, "exponent": 2}}


@pytest.mark.parametrize(
    ("ratings", "words"),
    [({}, "nothing heats it at its rated point"), ({"current_A": 5.0}, "air.inside touches no part")],
)
def test_a_machine_without_heat_or_without_a_void_is_one_message(ratings, words):
    """A solid rod, as a STEP file may hold one alone: its matrices would be singular, or its rises zero."""
    rod = Part("winding", "copper", ((shapes.disc(0.02), 0.0, 0.06),))
    air = Part("air.inside", "air", (), solid=False, role=Role.INNER_AIR)
    sections = {"losses": {"heat": HEAT}, "ratings": ratings}
    with pytest.raises(InputError, match=words):
        accurate_network(Machine("rod", "step", "", (rod,), (air,), sections, None, {}), 20.0)
