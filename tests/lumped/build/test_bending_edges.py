"""Which edges keep a middle, and that hot spots are then as on wholly quadratic elements, in earnest."""

from dataclasses import replace

import pytest

from fem.matrices.bends import Bends
from fem.solvers import bending_edges as edges
from geom import load_machine
from lumped.build import mesh_choice
from lumped.build.crosscheck import FLOOR
from lumped.build.pipeline import Meshing, silent
from lumped.machine.shapes import wound

MACHINE = load_machine("pmsm-m1-no-base")
FIRST = Meshing(0.2, 24, 0.25, 0.24)
LINEAR = [part.name for part in MACHINE.parts if not wound(MACHINE, part.name)]
PERCENT = 0.5


@pytest.fixture(scope="module")
def looks(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("THERMOSCOPE_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield mesh_choice._Looks(MACHINE, silent, FIRST)


@pytest.fixture(scope="module")
def found(looks):
    every = looks.ready(replace(FIRST, bends=Bends.everywhere(LINEAR))).field
    return edges.bending_edges(
        looks.point, every, lambda bends: looks.ready(replace(FIRST, bends=bends)).field, LINEAR, PERCENT, FLOOR
    )


def off(hot, found):
    return max(abs(100.0 * (hot[part] / rise - 1.0)) for part, rise in found.hot_quadratic.items())


def test_few_middles_do_what_all_of_them_do(looks, found):
    bare, every = looks.hot(FIRST), looks.size(replace(FIRST, bends=Bends.everywhere(LINEAR)))[1]
    few, none = looks.size(replace(FIRST, bends=found.bends))[1], looks.size(FIRST)[1]
    assert off(found.hot, found) < 2.0 * PERCENT < 5.0 < off(bare, found)  # the first order is within a factor two
    assert few - none < 0.7 * (every - none)
