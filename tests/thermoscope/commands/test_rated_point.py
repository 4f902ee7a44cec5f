"""The operating point at which a built machine is checked."""

import warnings
from types import SimpleNamespace

import numpy as np

from lumped.transfer.ranges import out_of_range
from thermoscope.commands.model.crosscheck import bearable


def test_a_rated_point_that_overheats_is_one_note(monkeypatch, capsys):
    """Nothing of what its films leave on the way to 700 degC."""

    def steady_state(network, point, ambient):
        out_of_range(f"film at {70.0 * point['current_A']:g} degC")
        return np.array([70.0 * point["current_A"] if point["current_A"] > 9.0 else 90.0])

    monkeypatch.setattr("lumped.build.crosscheck.steady_state", steady_state)
    monkeypatch.setattr("lumped.machine.motor.rated_inputs", lambda machine: {"current_A": 10.0})
    built = SimpleNamespace(machine=None, network=SimpleNamespace(states=("a",)), small=None)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        point, z = bearable(built)
    assert (point, z.tolist()) == ({"current_A": 8.0}, [90.0])
    assert capsys.readouterr().err == "note: at 10 A it does not settle below 200 degC: checked at 8 A\n"
