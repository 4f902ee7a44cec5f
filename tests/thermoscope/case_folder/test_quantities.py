"""Which of several currents and speeds is the machine's: those that losses follow, the largest of them."""

import numpy as np
import pytest

from geom.errors import InputError
from lumped.declarations.network import read_network
from measured.case import Test
from measured.recordings.sheet import read_sheet
from thermoscope.case_folder.quantities import with_quantities
from validation.parameters.unknowns import value_words

NETWORK = {
    "network": {"name": "n", "boundaries": ["room"]},
    "nodes": {"a": {"C_J_K": 100.0}},
    "links": {"l": {"between": ["a", "room"], "G_W_K": 1.0, "of": {"input": "blower", "at": 1000}}},
    "losses": {
        "c": {"kind": "copper", "at": "a", "R20_ohm": 0.1, "currents": ["d", "q"]},
        "f": {"kind": "friction", "at": "a", "P_W": 1.0, "of": {"input": "spin", "at": 1000}},
    },
}
COLUMNS = {"d": ("current", "A"), "q": ("current", "A"), "spin": ("speed", "rpm"), "blower": ("speed", "rpm")}


def sheet():
    columns = {n: {"quantity": q, "unit": u, "input": n} for n, (q, u) in COLUMNS.items()}
    return read_sheet({"test": {"time": "t"}, "columns": columns, "root_sum_square": {"whole": ["d", "q"]}}, "s")


def logged(order):
    level = {"d": -3.0, "q": 4.0, "whole": 5.0, "spin": 900.0, "blower": 2900.0}
    inputs = {n: np.full(3, level[n]) for n in order}
    return [Test("t", "calibrate", np.arange(3.0), inputs, {}, ())]


def test_a_blower_is_not_the_machine_and_a_component_not_its_current():
    network = read_network(
        {
            **NETWORK,
            "losses": {
                **NETWORK["losses"],
                "i": {"kind": "stray", "at": "a", "P_W": 1.0, "of": {"input": "whole", "at": 5}},
            },
        }
    )
    for order in (("d", "q", "whole", "spin", "blower"), ("blower", "whole", "spin", "q", "d")):
        found = with_quantities(network, [sheet()], logged(order))
        assert (found.signal("current"), found.signal("speed")) == ("whole", "spin")


def test_what_the_network_file_says_stands():
    network = read_network({**NETWORK, "inputs": {"q": {"quantity": "share"}}})
    found = with_quantities(network, [sheet()], logged(("d", "q", "spin", "blower")))
    assert found.measures("q") == "share"
    assert found.signal("current") == "d"


def test_a_measured_loss_asks_which_input_is_the_speed():
    """Torque times speed in 1/min needs pi/30; of inputs nobody knows that is not guessed from a name."""
    loss = {
        "m": {
            "kind": "measured",
            "at": "a",
            "electrical": {"product": ["P"]},
            "mechanical": {"product": ["M", "shaft_rpm"]},
        }
    }
    with pytest.raises(InputError, match="quantity"):
        read_network({**NETWORK, "losses": loss})
    said = read_network({**NETWORK, "losses": loss, "inputs": {"shaft_rpm": {"quantity": "speed"}}})
    (source,) = said.sources
    one = {n: np.ones(1) for n in ("P", "M", "shaft_rpm")}
    assert float(source.law.factor(one)[0]) == 1.0 - np.pi / 30
    assert said.measures("shaft_rpm") == "speed"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("capacity.rotor", "heat capacity of rotor"),
        ("h.gap:rotor", "film of gap, share of rotor"),
        ("loss.iron^speed_rpm", "loss of iron, exponent of speed rpm"),
        (
            "convection@flange.right^speed_rpm",
            "forced convection by vehicle wind at flange.right, exponent of speed rpm",
        ),
        (
            "loss.input@winding|speed_rpm at 4000^speed_rpm",
            "a loss at winding that follows speed_rpm, exponent of speed rpm",
        ),
    ],
)
def test_a_value_of_the_model_has_words(name, words):
    assert value_words(name) == words
