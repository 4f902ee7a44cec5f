"""Parts: named where they are seen, and pulled apart without overlap."""

from itertools import pairwise

import numpy as np
import pytest
from PIL import Image
from small_motor import LEVELS, RADII, motor

from geom.errors import InputError
from viz.machine.parts import assemblies, exploded, regions, shifts
from viz.rendering.cut import cut_away
from viz.rendering.ghost import anchors
from viz.rendering.nodes import split
from viz.rendering.scene import Room, View

NODES = split(motor(24))


@pytest.fixture(scope="module")
def seen():
    found = anchors(cut_away(NODES), View(), Room(0.2, 0.2))
    return {NODES.parts[i]: xyz for i, xyz in found.items()}


def test_every_part_that_the_cut_opens_is_found(seen):
    assert set(NODES.parts) == set(seen)


def test_names_point_at_their_parts(seen):
    """Positions read back from the picture lie on the part's ring, within two pixels (7 mm) of it."""
    for part, (low, high) in {"shaft": (0, 1), "yoke": (5, 6), "housing": (6, 7)}.items():
        r = np.hypot(*seen[part][:2])
        assert RADII[low] - 0.007 < r < RADII[high] + 0.007
    assert LEVELS[8] - 0.007 < seen["flange.right"][2] < LEVELS[9] + 0.007


def test_assemblies_pulled_apart_do_not_overlap():
    groups = assemblies(NODES)
    moved = NODES.points[:, 2] + shifts(NODES, groups)[NODES.owner, 2]
    spans = [(moved[np.concatenate([NODES.of(p) for p in g])]) for g in groups]
    assert len(groups) == 5
    assert all(a.max() < b.min() for a, b in pairwise(spans))


def test_pictures_show_something(tmp_path):
    regions(NODES, title="parts", png=tmp_path / "r.png").close()
    exploded(NODES, np.linspace(20.0, 90.0, NODES.size), png=tmp_path / "e.png").close()
    both = [np.asarray(Image.open(tmp_path / f"{n}.png").convert("RGB")).astype(int) for n in "re"]
    assert all(0.05 < (image < 250).any(axis=2).mean() < 0.9 for image in both)


def test_the_mesh_can_be_seen(tmp_path):
    """Its edges are lines of another shade: thousands of pixels."""
    drawn = []
    for mesh in (False, True):
        regions(NODES, mesh=mesh, png=tmp_path / "m.png").close()
        drawn.append(np.asarray(Image.open(tmp_path / "m.png").convert("L"), float))
    assert (np.abs(drawn[1] - drawn[0]) > 10).sum() > 2000


def test_every_group_stands_under_its_names():
    p = exploded(NODES)
    shown = "".join(a.GetInput() for a in p.actors.values() if hasattr(a, "GetInput") and isinstance(a.GetInput(), str))
    p.close()
    assert all(part in shown for part in NODES.parts)


def test_unknown_part_lists_the_known_ones():
    with pytest.raises(InputError, match=r"unknown part 'rotor'; known: shaft, rotor\.core"):
        exploded(NODES, groups=[["rotor"]])
