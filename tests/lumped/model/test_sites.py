"""Where an effect can sit: nothing turning stands on a bench, no film is a joint, no bolt crosses an air gap."""

import tomllib

import pytest
from small_networks import MOTOR

from lumped.declarations.network import read_network
from validation.effects import Scene, kinds


def scene_of(file):
    return Scene(read_network(file), frozenset({"speed_rpm", "current_A", "speed", "current"}), {}, ("test",))


@pytest.fixture(scope="module")
def scene():
    return scene_of(tomllib.loads(MOTOR))


def places(kind, scene):
    return set(kinds()[kind].places(scene))


def test_only_what_the_outside_reaches_and_does_not_stand_there_yet_conducts_into_the_bench(scene):
    assert places("conduction.bench", scene) == {"shield"}


def test_a_joint_is_between_solids_and_follows_nothing(scene):
    assert places("contact", scene) == {"liner", "fit", "spigot", "shaft"}


def test_no_bridge_crosses_the_air_between_what_turns_and_what_stands(scene):
    assert places("coupling", scene) == {"winding|housing", "stator|shield"}


def test_what_turns_exchanges_with_what_stands_through_air(scene):
    assert places("gap.convection", scene) == {"rotor|stator", "rotor|shield"}


@pytest.fixture
def coils():
    """The motor with a node for the ends of its winding, and a copper loss in both."""
    file = tomllib.loads(MOTOR)
    file["nodes"]["end"] = {"role": "winding", "C_J_K": 200}
    file["links"]["turns"] = {"between": ["winding", "end"], "G_W_K": 5}
    loss = {"kind": "copper", "at": {"winding": 0.7, "end": 0.3}, "temperature_of": "winding", "R20_ohm": 0.1}
    file["losses"] = {"joule": {**loss, "currents": ["current_A"], "alpha_1_K": 0.00393}}
    return scene_of(file)


def test_leads_may_join_a_winding_to_what_the_surroundings_wash(coils):
    assert {"housing|end", "shield|end"} <= places("coupling", coils)


def test_a_loss_of_two_coils_may_be_larger_in_either(coils):
    assert places("loss.winding", coils) == {"winding", "end"}
