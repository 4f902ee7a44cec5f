"""Where an effect can sit: nothing turning stands on a bench, no film is a joint, no bolt crosses an air gap."""

import tomllib

import pytest
from small_networks import MOTOR

from lumped.declarations.network import read_network
from validation.effects import Scene, kinds


@pytest.fixture(scope="module")
def scene():
    return Scene(read_network(tomllib.loads(MOTOR)), frozenset({"speed_rpm"}), {}, ("test",))


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
