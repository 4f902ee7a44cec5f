"""The plane partition on bodies small enough to check by hand."""

import pytest

from geom import InputError
from geom.description import shapes
from geom.description.part import Part, fluid
from geom.meshing.blocks import find_blocks, find_columns
from geom.meshing.partition import filled, partition


def body(name, profile, z0, z1):
    return Part(name, "steel", ((profile, z0, z1),))


def test_overlapping_solids_are_refused_by_name():
    with pytest.raises(InputError, match=r"(a and b|b and a) overlap"):
        partition([body("a", shapes.disc(0.1), 0, 1), body("b", shapes.disc(0.05), 0.5, 1.5)])


def test_solids_over_one_another_do_not_overlap():
    partition([body("a", shapes.disc(0.1), 0, 1), body("b", shapes.disc(0.05), 1, 1.5)])


def closed_can():
    disc = shapes.disc(0.1)
    return [body("wall", shapes.ring(0.09, 0.1), 0.1, 0.4), body("floor", disc, 0, 0.1), body("lid", disc, 0.4, 0.5)]


def test_closed_void_must_be_declared():
    with pytest.raises(InputError, match="closed void"):
        filled(partition(closed_can()))


def test_declared_void_is_accepted():
    filled(partition([*closed_can(), fluid("air", (shapes.disc(0.09), 0.1, 0.4))]))


def test_open_tube_needs_no_fluid():
    filled(partition([body("wall", shapes.ring(0.09, 0.1), 0.0, 0.4)]))


def test_first_declared_fluid_wins_and_solids_win_over_both():
    disc = shapes.disc(0.1)
    parts = [fluid("first", (disc, 0, 1)), fluid("second", (disc, 0, 1)), body("rod", shapes.disc(0.02), 0, 1)]
    cut = partition(parts)
    assert set(cut.labels.ravel()) == {-1, 0, 2}


def test_level_of_one_body_does_not_cut_another():
    rod = body("rod", shapes.disc(0.02), 0, 1)
    collar = Part("collar", "steel", ((shapes.ring(0.05, 0.06), 0, 0.3), (shapes.ring(0.05, 0.07), 0.3, 1)))
    spans = {(block.first, block.last) for block in find_blocks(partition([rod, collar]))}
    assert spans == {(0, 1), (0, 0), (1, 1)}


def test_plate_is_not_cut_by_what_lies_beyond_the_air():
    plate = body("plate", shapes.disc(0.1), 0, 0.1)
    pin = body("pin", shapes.disc(0.01, 0.05, 0.0), 0.2, 0.3)
    cut = partition([plate, pin])
    assert len(find_columns(cut, find_blocks(cut))) == 2
