"""Where an effect can sit: nothing turning stands on a bench, no film is a joint, no bolt crosses an air gap."""

import tomllib

import pytest

from lumped.declarations.network import read_network
from validation.effects import Scene, kinds

MOTOR = """
[network]
name = "motor"
boundaries = ["ambient", "bench"]
[boundaries.ambient]
role = "ambient"
[boundaries.bench]
role = "test bed"
[nodes.winding]
role = "winding"
C_J_K = 500
[nodes.stator]
role = "iron"
C_J_K = 4000
[nodes.rotor]
role = "rotor"
C_J_K = 3000
[nodes.shield]
role = "end shield"
C_J_K = 1000
[nodes.housing]
role = "housing"
C_J_K = 2000
[nodes.air]
kind = "fluid"
C_J_K = 10
[links.liner]
between = ["winding", "stator"]
G_W_K = 20
[links.fit]
between = ["stator", "housing"]
G_W_K = 60
[links.spigot]
between = ["shield", "housing"]
G_W_K = 10
[links.shaft]
between = ["rotor", "shield"]
G_W_K = 1
[links.gap]
between = ["rotor", "stator"]
G_W_K = 4
[links.stirred]
between = ["winding", "shield"]
G_W_K = 1
of = { input = "speed_rpm", at = 1000, exponent = 0.8 }
[links.inside]
between = ["air", "winding"]
G_W_K = 2
[links.outside]
between = ["housing", "ambient"]
G_W_K = 8
[links.face]
between = ["shield", "ambient"]
G_W_K = 2
[links.foot]
between = ["housing", "bench"]
G_W_K = 3
"""


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
