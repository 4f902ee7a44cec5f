"""Display-only bodies: closed, in their place, cut where the wedge is, warm as the part they stand for, and said so."""

import numpy as np
import pytest
import shapely
from PIL import Image

from extras.portraits.cutting import cut_body
from extras.portraits.dressed import dressed
from extras.portraits.making import ball, bolt, box, extruded, oval, revolved, rod, swept
from extras.portraits.portrait import CAPTION, portrait
from extras.portraits.shape import Body, Finish, joined
from geom import load_machine
from geom.description.roles import Role
from geom.machine_file import machine_from
from viz.rendering.cut import QUARTER
from viz.rendering.nodes import SplitMesh

LARGE = ("series-dc-100kw-air", "series-dc-100kw-jacket-two-zigzag", "tefc-industrial-radial", "ipmsm-48s8p-jacket")
MACHINES = (*(pytest.param(name, marks=pytest.mark.nightly) for name in LARGE), "tefc-industrial", "pmsm-m1")


@pytest.fixture(scope="module", params=MACHINES)
def machine(request):
    return load_machine(request.param)


@pytest.fixture(scope="module")
def bodies(machine):
    return dressed(machine)


def test_every_body_is_closed_and_turned_outwards(bodies):
    assert [b.part for b in bodies if not b.shape.closed or b.shape.volume <= 0] == []
    assert sum(b.added for b in bodies) > 10


def test_every_meshed_part_is_shown_where_it_is(machine, bodies):
    """No part of the mesh is left out; each stays within its own span along the axis, rounder ones within a tenth."""
    for part in machine.parts:
        mine = [b.shape for b in bodies if b.part == part.name and not b.added]
        assert mine, part.name
        z = joined(mine).points[:, 2]
        rounder = part.cad_shape or part.identity.role is Role.WINDING  # than its prisms: a pipe, a slanted coil
        slanted = 0.1 * (part.span[1] - part.span[0]) if rounder else 1e-6
        assert part.span[0] - slanted <= z.min()
        assert z.max() <= part.span[1] + slanted


def test_a_long_shaft_moves_no_end_winding():
    """Its ends are left and right of the body's middle, not of the shaft's."""
    like = {"machine": {"name": "long", "like": "pmsm-m1"}, "geometry": {"shaft": {"extension_mm": 400.0}}}
    machine = machine_from(like)
    (right,) = (b.shape for b in dressed(machine) if b.part == "winding.right")
    assert right.points[:, 2].max() <= machine.part("winding.right").span[1] + 1e-3


def test_revolved_volumes_are_those_of_pappus():
    """Guldin: area times the way of its centroid; 120 chords miss 2 pi^2 / 3 / 120^2 of it, 0.05 %."""
    section = shapely.box(1.0, 0.0, 2.0, 1.0)
    assert revolved(section).volume == pytest.approx(2 * np.pi * 1.5, rel=6e-4)
    assert rod(1.0, 2.0, 0.0, 240).volume == pytest.approx(2 * np.pi, rel=6e-4)
    assert ball(1.0).volume == pytest.approx(4 / 3 * np.pi, rel=0.04)


def test_sharp_extrusions_have_their_exact_volume_and_rounded_ones_a_little_less():
    frame = shapely.box(0, 0, 3, 2).difference(shapely.box(1, 0.5, 2, 1.5))
    assert extruded(frame, 1.0, 2.0).volume == pytest.approx(5.0, abs=1e-12)
    assert 4.9 < extruded(frame, 1.0, 2.0, 0.02).volume < 5.0


def test_a_strip_thinner_than_its_rounding_stays_closed():
    strip = extruded(shapely.box(0, 0, 1, 0.01), 0.0, 1.0, 0.02)
    assert strip.closed
    assert strip.volume == pytest.approx(0.01, rel=0.1)


def test_shapes_keep_their_volume_where_they_are_put():
    for one in (bolt(0.01), box(0.1, 0.2, 0.3, 0.01)):
        for moved in (one.outward(0.7, 1.0, 2.0), one.on_end(0.7, 1.0, 2.0, -1), one.mirrored(), one.turned(1.0)):
            assert moved.closed
            assert moved.volume == pytest.approx(one.volume, rel=1e-9)
    assert box(0.1, 0.2, 0.3, 0.01).outward(0.0, 1.0, 2.0).points[:, 0].min() == pytest.approx(1.0)


def test_a_ring_swept_shut_is_closed():
    t = 2 * np.pi * np.arange(40) / 40
    path = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    ring = swept(path, path, oval(0.2, 0.2, 24, 2.0), shut=True)
    assert ring.closed
    assert ring.volume == pytest.approx(2 * np.pi * np.pi * 0.01, rel=0.02)


def test_nothing_cut_is_left_in_the_wedge_and_caps_close_it():
    ring = Body("ring", Finish.CAST, revolved(shapely.box(1.0, 0.0, 2.0, 1.0)))
    surface, caps = cut_body(ring, QUARTER)
    for piece in (surface, caps):
        x, y = np.asarray(piece.points)[:, :2].T
        assert not ((x < -1e-6) & (y > 1e-6)).any()
    assert surface.area == pytest.approx(0.75 * 2 * np.pi * (1 + 2 + 2 * 1.5), rel=2e-3)
    inner = 2 * 1.0  # the two pieces are closed where they meet as well
    assert caps.area == pytest.approx(2 * 1.0 + inner, rel=2e-3)


def test_bolts_are_never_cut():
    head = bolt(0.01)
    there = Body("a", Finish.STEEL, head.on_end(np.deg2rad(135), 1.0, 0.0, 1), whole=True)
    beside = Body("a", Finish.STEEL, head.on_end(np.deg2rad(60), 1.0, 0.0, 1), whole=True)
    assert cut_body(there, QUARTER) is None
    surface, caps = cut_body(beside, QUARTER)
    assert caps is None
    assert surface.n_cells == len(head.triangles)


def test_bodies_take_the_temperature_of_the_part_they_stand_for():
    """Two parts in one place: a body shows its own, not the nearer one's."""
    from extras.portraits.portrait import Warm

    rng = np.random.default_rng(0)
    points = np.concatenate([rng.random((4000, 3))] * 2)
    owner = np.repeat([0, 1], 4000)
    nodes = SplitMesh(points, np.zeros((0, 4), int), np.zeros(0, int), ("cold", "hot"), np.arange(8000), owner)
    warm = Warm(nodes, np.where(owner == 0, 20.0, 80.0) + 10 * points[:, 2], None)
    at = rng.random((50, 3))
    assert warm.weights("cold", at) @ warm.T == pytest.approx(20 + 10 * at[:, 2], abs=0.8)
    assert warm.weights("hot", at) @ warm.T == pytest.approx(80 + 10 * at[:, 2], abs=0.8)


def test_a_portrait_says_that_its_details_are_only_for_the_eye(tmp_path):
    machine = load_machine("tefc-industrial")
    p = portrait(machine, size=(640, 400), png=tmp_path / "p.png")
    assert p.actors["footnote"].GetInput() == CAPTION
    p.close()
    picture = np.asarray(Image.open(tmp_path / "p.png").convert("RGB")).astype(int)
    assert 0.1 < (picture < 245).any(axis=2).mean() < 0.8
    copper = (picture[..., 0] > picture[..., 2] + 60).mean()
    assert copper > 0.002  # windings are seen in the cut
