"""The mesh of a wish: what it says it leaves, which way it refines, and that it is looked for once."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fem.matrices.bends import Bends
from fem.solvers.bending_edges import BendingEdges
from geom import load_machine
from lumped.build import mesh_choice, network_size
from lumped.build.mesh_choice import LARGEST_SHARE, SHARE, chosen_mesh
from lumped.build.pipeline import Meshing, silent
from lumped.machine.shapes import wound

MACHINE = load_machine("pmsm-m1-no-base")
FIRST = Meshing(0.2, 24, 0.25, 0.24)
EXACT = {"winding": 80.0, "bearing": 2.0}
LINEAR = [part.name for part in MACHINE.parts if not wound(MACHINE, part.name)]
GAINS = {}  # part -> share of every rise that is lost if its edges are straight
LOST = {"size_m": 0.002, "across": 0.01, "axial_m": 0.04}  # of the winding's rise, on the first mesh


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("THERMOSCOPE_CACHE", str(tmp_path))


def halved(how, way):
    """How much smaller than the first mesh's elements are, one way."""
    now, first = getattr(how, way), getattr(FIRST, way)
    return now / first if way == "across" else first / now


def low(how):
    """Of the exact rise, at order two each way."""
    return sum(share / halved(how, way) ** 2 for way, share in LOST.items())


def bent(how, part):
    """Whether a part's edges have middles."""
    return how.bends is not None and part in how.bends.parts


@pytest.fixture
def second_order(monkeypatch):
    """Meshes whose hot spots are low by the square of their elements' size each way; a thousand points, then twice."""
    solved = []

    def counts(machine, how):
        points = 1000
        for way in LOST:
            points *= halved(how, way)
        return int(points), {part: 2 * int(points) * (part == LINEAR[0]) + 100 * bent(how, part) for part in LINEAR}

    def ready(machine, how, progress):
        solved.append(mesh_choice.size_of(machine, how)[1])
        return SimpleNamespace(field=how)

    def hot(point, how, T):
        linear = sum(gain for part, gain in GAINS.items() if not bent(how, part))
        return {p: T * (1.0 - low(how) - linear) for p, T in EXACT.items()}

    def edges(point, every, with_bends, parts, percent, floor):
        bends = Bends.everywhere([part for part in parts if 100.0 * GAINS.get(part, 0.0) > percent])
        fewer = with_bends(bends)
        lost = {part: np.full(2, 100.0 * GAINS.get(part, 0.0)) for part in parts}
        return BendingEdges(bends, mesh_choice.hot_spots(point, fewer, 0), mesh_choice.hot_spots(point, every, 0), lost)

    monkeypatch.setattr(mesh_choice, "meshed", ready)
    monkeypatch.setattr(mesh_choice, "counts_of", counts)
    monkeypatch.setattr(mesh_choice, "_at_rated_point", lambda ready: SimpleNamespace(of_field=lambda how: None))
    monkeypatch.setattr(mesh_choice, "hot_spots", hot)
    monkeypatch.setattr(mesh_choice, "bending_edges", edges)
    return solved


@pytest.mark.parametrize(("accuracy", "axial", "across"), [(14.0, 1, 1), (6.5, 2, 1), (4.5, 4, 1), (2.0, 4, 2)])
def test_it_is_halved_the_way_that_leaves_most_until_its_share_is_kept(second_order, accuracy, axial, across):
    found = chosen_mesh(MACHINE, accuracy, FIRST, silent)
    assert found.met
    assert (halved(found.meshing, "axial_m"), halved(found.meshing, "across")) == (axial, across)
    assert found.meshing.size_m == FIRST.size_m
    assert found.worst <= SHARE * accuracy
    assert found.percent["winding"] == pytest.approx(125.0 * low(found.meshing), rel=0.06)
    assert found.percent["bearing"] < found.percent["winding"]  # of a tenth of the largest rise, not of its own
    assert (found.points, found.unknowns) == (1000 * axial * across, 2000 * axial * across)


def test_a_mesh_that_grows_too_large_is_told(second_order):
    """None beyond what is allowed is chosen; its error is known from finer ones that are looked at once."""
    found = chosen_mesh(MACHINE, 0.1, FIRST, silent, most=4000)
    assert not found.met
    assert found.unknowns == 4000
    assert found.percent["winding"] == pytest.approx(125.0 * low(found.meshing), rel=0.05)
    assert found.worst > LARGEST_SHARE * 0.1


def test_an_order_that_does_not_show_is_not_assumed(second_order, monkeypatch):
    """Where the next halving moves as much again, nothing says how far it goes on: four times that, with safety."""
    monkeypatch.setattr(
        mesh_choice, "hot_spots", lambda point, how, T: {p: T + halved(how, "axial_m") for p, T in EXACT.items()}
    )
    found = chosen_mesh(MACHINE, 1.0, FIRST, silent, most=4000)
    assert not found.met
    assert found.percent["winding"] > 100.0 * 4.0 * 2.0 / 82.0


def test_edges_that_cost_a_hot_spot_have_middles_and_what_the_rest_costs_is_counted(second_order, monkeypatch):
    """5 % of every rise, and 0.1 % of it."""
    monkeypatch.setitem(GAINS, "stator.core", 0.05)
    monkeypatch.setitem(GAINS, "slot.liner", 0.001)
    found = chosen_mesh(MACHINE, 14.0, FIRST, silent)
    assert [part for part in LINEAR if bent(found.meshing, part)] == ["stator.core"]
    assert found.percent["winding"] == pytest.approx(125.0 * low(found.meshing) + 0.1, rel=0.08)


def test_layers_towards_the_ends_of_one_part_are_a_way(second_order, monkeypatch):
    """Where nothing else moves the hot spots, only these are refined."""
    monkeypatch.setattr(
        mesh_choice,
        "hot_spots",
        lambda point, how, T: {p: T * (1.0 - 0.04 * 0.2 ** len(how.ends)) for p, T in EXACT.items()},
    )
    found = chosen_mesh(MACHINE, 2.0, FIRST, silent)
    assert found.met
    assert found.meshing.ends
    assert replace(found.meshing, ends=(), bends=None) == FIRST


def test_triangles_of_the_one_part_that_moves_the_hot_spot_are_smaller(second_order, monkeypatch):
    """Where they alone do what smaller ones everywhere would, the others stay as they are."""

    def hot(point, how, T):
        low = 0.04 / (halved(how, "size_m") * 2.0 ** how.finer.count("stator.core")) ** 2
        return {p: T * (1.0 - low) for p, T in EXACT.items()}

    monkeypatch.setitem(GAINS, "shaft", 0.01)
    monkeypatch.setitem(GAINS, "stator.core", 0.02)
    monkeypatch.setattr(mesh_choice, "hot_spots", hot)
    found = chosen_mesh(MACHINE, 4.0, FIRST, silent)
    assert found.met
    assert set(found.meshing.finer) == {"stator.core"}
    assert found.meshing.size_m == FIRST.size_m


def test_a_machine_is_looked_at_once(monkeypatch):
    """Meshes and fields in earnest, as coarse as they can be."""
    found = chosen_mesh(MACHINE, 100.0, FIRST, silent)
    assert found.met
    assert {"winding", "winding.left", "winding.right"} <= found.percent.keys()
    assert 0.0 < found.worst < 50.0
    monkeypatch.setattr(mesh_choice, "meshed", None)
    assert chosen_mesh(MACHINE, 100.0, FIRST, silent) == found


@pytest.mark.parametrize(
    ("accuracy", "worst", "met", "left"),
    [(2.0, 0.6, True, 1.4), (2.0, 1.5, True, 0.5), (2.0, 4.0, False, 1.0), (10.0, 3.0, True, 2.0)],
)
def test_the_condensation_may_use_what_the_mesh_leaves(monkeypatch, accuracy, worst, met, left):
    """Half of the wish where a mesh that misses it leaves nothing; never more than 2 %."""
    asked = []
    choice = mesh_choice.MeshChoice(FIRST, {"winding": worst}, 1000, 2000, met)
    size = network_size.NetworkSize(None, None, network_size.Accuracy(1.0, 2.0, 2.0), (), None)
    monkeypatch.setattr(network_size, "size_of", lambda machine, how: (1000, 2000))
    monkeypatch.setattr(network_size, "chosen_mesh", lambda *of: choice)
    monkeypatch.setattr(network_size, "smallest_network", lambda machine, left, **how: asked.append(left) or size)
    network_size.accurate_network(MACHINE, accuracy)
    assert asked == [pytest.approx(left)]
