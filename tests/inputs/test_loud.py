"""Wrong but accepted is worse than refused: each of these is a note that every command prints."""

import pytest
from input_cases import case_of, changed, edited

from thermoscope.commands.open_case import open_case

TESTS = ("stand", "road", "town")
SWITCHED = '[links.flange-air.forced]\nG_W_K = 1.0\nof = { input = "fan_on", at = 1.0, exponent = 0.8 }\n'


def sheets(case, old, new):
    for test in TESTS:
        edited(case / f"tests/{test}.toml", old, new)


def fan(case):
    """A fan that only ever is on or off, in a law with an exponent."""
    network = case / "network.toml"
    network.write_text(network.read_text().replace("[losses.copper]", f"{SWITCHED}\n[losses.copper]"))
    events = '[events.fan_on]\nat_s = [0, 500]\nvalue = ["off", "on"]\n\n[columns.current]'
    sheets(case, "[columns.current]", events)


def still(case):
    for test in TESTS:
        changed(case, test, lambda table: table.__setitem__("current", 100.0))


def lonely(case):
    network = case / "network.toml"
    tooth = '[nodes.tooth]\nC_J_K = 100\n[links.tooth-yoke]\nbetween = ["tooth", "yoke"]\nG_W_K = 1\n\n[losses.copper]'
    network.write_text(network.read_text().replace("[losses.copper]", tooth))


LOUD = {
    "a column no law uses": (lambda case: None, "no law of the network reads this input"),
    "an input that no test moves": (still, "no test moves this input"),
    "on and off with an exponent": (fan, "the exponent 0.8 in 'link:flange-air:forced' says nothing"),
    "a node nothing heats or cools": (lonely, "it only stores heat"),
}


@pytest.mark.parametrize("kind", LOUD)
def test_said_by_every_command_that_opens_the_case(tmp_path, kind, capsys):
    change, words = LOUD[kind]
    case = case_of(tmp_path)
    change(case)
    open_case(str(case), lambda _: None)
    (said,) = [line for line in capsys.readouterr().err.splitlines() if words in line]
    assert said.startswith("note: ")


def test_a_fan_with_exponent_one_is_no_doubt(tmp_path, capsys):
    case = case_of(tmp_path)
    fan(case)
    edited(case / "network.toml", "exponent = 0.8", "exponent = 1.0")
    open_case(str(case), lambda _: None)
    assert "says nothing" not in capsys.readouterr().err
