"""Wrong but accepted is worse than refused: each of these is a message, or a note that every command prints."""

import pytest
from input_cases import case_of, changed, edited

from geom.errors import InputError
from thermoscope.commands.open_case import open_case

TESTS = ("stand", "road", "town")
SPEED = 'quantity = "vehicle_speed"\nunit = "km/h"'
SWITCHED = '[links.flange-air.forced]\nG_W_K = 1.0\nof = { input = "fan_on", at = 1.0, exponent = 0.8 }\n'


def sheets(case, old, new):
    for test in TESTS:
        edited(case / f"tests/{test}.toml", old, new)


def minutes_as_hours(case):
    edited(case / "tests/stand.toml", 'time = "time_s"', 'time = "time_s"\ntime_unit = "h"')
    changed(case, "stand", lambda table: table.__setitem__("time_s", 1e6 * table["time_s"]))


def one_sample(case):
    edited(case / "tests/stand.toml", 'time = "time_s"', 'time = "time_s"\ntime_unit = "ms"')


def metres(case):
    sheets(case, SPEED, 'quantity = "speed"\nunit = "m/s"')


REFUSED = {
    "a test of one sample": (one_sample, "is time_unit right"),
    "a test of 10^10 s": (minutes_as_hours, "is time_unit right"),
    "speed in m/s": (metres, 'quantity = "vehicle_speed" has it'),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_refused_with_what_was_meant(tmp_path, kind):
    change, words = REFUSED[kind]
    case = case_of(tmp_path)
    change(case)
    with pytest.raises(InputError, match=words):
        open_case(str(case), lambda _: None)


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
