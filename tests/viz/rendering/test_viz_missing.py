"""Missing heat on the machine: only where the evidence is, and in the right colour."""

import numpy as np
import pytest
from PIL import Image
from small_motor import motor

from geom.errors import InputError
from viz import missing_in_machine, split
from viz.colours import BLUE, VERMILION
from viz.machine.missing import mean_heat, placed

NODES = split(motor(24))


def place(name, nats, watts):
    series = {"time_s": [0.0, 600.0], "heat_W": [watts - 50.0, watts + 50.0], "sd_W": [20.0, 20.0]}
    return {"place": name, "evidence_nats": nats, "heat": {"road": series}}


WHERE = [place("flange.right", 60.0, -300.0), place("housing", 52.0, -250.0), place("yoke", 10.0, 400.0)]


@pytest.mark.parametrize(("few", "says"), [(WHERE, True), (WHERE[2:], False), ([], False)])
def test_heat_is_placed_only_by_clear_evidence(few, says):
    assert placed({"where": few}) is says


def test_places_far_behind_are_left_out():
    assert mean_heat(WHERE, "road") == {"flange.right": -300.0, "housing": -250.0}


@pytest.mark.parametrize(("watts", "colour", "other"), [(-300.0, BLUE, VERMILION), (300.0, VERMILION, BLUE)])
def test_the_part_that_loses_heat_is_blue_and_the_other_vermilion(watts, colour, other, tmp_path):
    missing_in_machine(NODES, [place("flange.right", 60.0, watts)], "road", png=tmp_path / "m.png").close()
    picture = np.asarray(Image.open(tmp_path / "m.png").convert("RGB")).astype(int)[80:, :1100]

    def near(name):
        rgb = np.array([int(name[i : i + 2], 16) for i in (1, 3, 5)])
        part = picture @ rgb / (np.linalg.norm(picture, axis=2) * np.linalg.norm(rgb) + 1e-9)
        return (part > 0.995).sum()

    assert near(colour) > 5000
    assert near(colour) > 20 * near(other)


def test_an_unknown_test_lists_the_known_ones():
    with pytest.raises(InputError, match="known: road"):
        mean_heat(WHERE, "town")
