"""What a network shows of itself: declared roles stand, others are guessed from topology and losses, with evidence."""

import tomllib
from dataclasses import replace

import pytest

from geom.description.roles import Role, identity
from geom.errors import InputError
from lumped.declarations.network import read_network


def document(root, kind):
    return tomllib.loads((root / "benchmarks" / "hidden" / "machines" / f"{kind}.toml").read_text())


def without_names(data):
    """The hand network as it is: its nodes say nothing of themselves."""
    assert not any("role" in node for node in data["nodes"].values())
    return read_network(data)


TRUE = {
    "tefc": {
        "winding.slot": "winding",
        "winding.de": "winding",
        "winding.nde": "winding",
        "core": "iron",
        "rotor": "cage",
        "housing": "housing",
        "flange.de": "end shield",
        "flange.nde": "end shield",
        "bearing.de": "bearing",
        "bearing.nde": "bearing",
        "air.de": "inner air",
        "ambient": "ambient",
        "bench": "test bed",
    },
    "jacket": {
        "winding.slot": "winding",
        "winding.de": "winding",
        "stator": "iron",
        "magnets": "magnet",
        "rotor": "rotor",
        "housing": "housing",
        "shield.de": "end shield",
        "water": "coolant",
        "coolant": "coolant",
        "ambient": "ambient",
        "bench": "test bed",
    },
    "brushed": {
        "winding.armature": "winding",
        "rotor": "rotor",
        "commutator": "commutator",
        "poles": "iron",
        "winding.field": "winding",
        "flange.de": "end shield",
        "ambient": "ambient",
        "bench": "test bed",
    },
}
TURN = {"tefc": {"rotor"}, "jacket": {"rotor", "magnets"}, "brushed": {"winding.armature", "rotor", "commutator"}}


@pytest.mark.parametrize("kind", TRUE)
def test_hand_networks_of_three_machines_are_read_without_their_names(root, kind):
    found = without_names(document(root, kind)).identities
    assert {name: found[name].role for name in TRUE[kind]} == TRUE[kind]
    assert {name for name, i in found.items() if i.turns} == TURN[kind]
    assert all(i.why and not i.declared for i in found.values())


def test_three_published_nodes_without_a_bearing_or_a_film_are_told_apart(root):
    """Winding by its copper, the coolant by what it takes, the rotor by the weak joint it hangs on."""
    data = tomllib.loads((root / "cases" / "hust-ipmsm" / "network.toml").read_text())
    bare = {**data, "nodes": {n: {k: v for k, v in t.items() if k != "role"} for n, t in data["nodes"].items()}}
    found = read_network({k: v for k, v in bare.items() if k != "boundaries"}).identities
    roles = {"winding": "winding", "stator": "iron", "rotor": "rotor", "coolant": "coolant", "ambient": "ambient"}
    assert {name: i.role for name, i in found.items()} == roles
    assert {name for name, i in found.items() if i.turns} == {"rotor"}


def test_what_is_declared_stands_against_what_would_be_guessed(root):
    network = without_names(document(root, "tefc"))
    said = replace(network, declared={"core": identity(Role.HOUSING)}).identities
    assert said["core"] == identity(Role.HOUSING)
    assert said["winding.slot"].role is Role.WINDING


def test_a_shaft_in_two_pieces_turns_with_the_rotor_between_them():
    """However weakly: its joints to the two stubs conduct less than the gap does."""
    data = {
        "network": {"name": "two stubs", "boundaries": ["a"]},
        "nodes": {n: {"C_J_K": 100.0} for n in ("s1", "s2", "b1", "b2", "e1", "e2", "r", "t", "h")},
        "links": {
            **{
                f"{a}{b}": {"between": [a, b], "G_W_K": G}
                for a, b, G in (
                    ("s1", "r", 1.0),
                    ("s2", "r", 1.0),
                    ("r", "t", 4.0),
                    ("t", "h", 30.0),
                    ("e1", "h", 5.0),
                    ("e2", "h", 5.0),
                    ("b1", "e1", 2.0),
                    ("b2", "e2", 2.0),
                    ("b1", "s1", 1.0),
                    ("b2", "s2", 1.0),
                )
            },
            **{f"{n}a": {"between": [n, "a"], "power": {"G_W_K": 1.0, "exponent": 0.25}} for n in ("h", "e1", "e2")},
        },
        "losses": {n: {"kind": "friction", "at": n, "P_W": 5.0} for n in ("b1", "b2")},
    }
    found = read_network(data).identities
    assert {n for n, i in found.items() if i.turns} == {"s1", "s2", "r"}
    assert {n for n, i in found.items() if i.role is Role.BEARING} == {"b1", "b2"}


@pytest.mark.parametrize(
    ("table", "key", "value", "right"),
    [
        ("nodes", "role", "windng", "did you mean 'winding'.*known: air gap"),
        ("nodes", "turns", 1, "true or false"),
        ("boundaries", "role", "sink", "known: air gap"),
    ],
)
def test_an_unknown_role_is_one_message_that_lists_the_known(root, table, key, value, right):
    data = document(root, "tefc")
    name = "core" if table == "nodes" else "ambient"
    data.setdefault(table, {}).setdefault(name, {})[key] = value
    with pytest.raises(InputError, match=right):
        read_network(data)


def test_a_boundary_that_is_none_cannot_have_a_role(root):
    data = document(root, "tefc") | {"boundaries": {"sea": {"role": "coolant"}}}
    with pytest.raises(InputError, match="'sea' is not a boundary"):
        read_network(data)
