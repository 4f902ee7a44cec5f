"""Profiles cut at each other's edges, against areas by hand."""

import math

import numpy as np
import pytest

from geom.description import shapes
from geom.solids.arrangement import arrangement, covers

R = 0.02


def area(plane, inside):
    """Of what is inside on one side of a piece and not on the other (m2), by Green's formula."""
    (x0, y0), (x1, y1) = (plane.points[plane.pieces[:, i]].T for i in (0, 1))
    under = (x0 * y1 - x1 * y0 + plane.radius**2 * (plane.sweep - np.sin(plane.sweep))) / 2
    return float(under @ (inside(plane.left).astype(int) - inside(plane.right)))


def test_two_discs_that_cross_have_the_lens_in_common():
    plane = arrangement([shapes.disc(R), shapes.disc(R, R)])
    lens = R**2 * (2 * math.pi / 3 - math.sqrt(3) / 2)
    assert len(plane.points) == 4 + 2  # two of each circle's own, two crossings
    assert len(plane.pieces) == 8
    assert area(plane, lambda side: side[:, 0] & side[:, 1]) == pytest.approx(lens, rel=1e-12)
    assert area(plane, lambda side: side[:, 0] | side[:, 1]) == pytest.approx(2 * math.pi * R**2 - lens, rel=1e-12)


def test_edges_that_coincide_in_part_are_there_once():
    """A square beside half of another's side, and a sector on the arc of a disc."""
    square = arrangement([shapes.rectangle(0, 2, 0, 2), shapes.rectangle(2, 3, 0, 1)])
    assert (len(square.points), len(square.pieces)) == (7, 8)
    assert area(square, lambda side: side.any(axis=1)) == pytest.approx(5.0, rel=1e-14)
    round_ = arrangement([shapes.disc(R), shapes.sector(R, 2 * R, 0.3, 1.1)])
    assert (len(round_.points), len(round_.pieces)) == (6, 7)
    exact = math.pi * R**2 + 0.8 * 3 * R**2 / 2
    assert area(round_, lambda side: side.any(axis=1)) == pytest.approx(exact, rel=1e-12)


def test_a_bar_across_a_ring_is_inside_and_outside():
    plane = arrangement([shapes.ring(R, 2 * R), shapes.rectangle(0.5 * R, 3 * R, -R / 4, R / 4)])
    under = [math.asin(0.25 / k) * k**2 + math.sqrt(k**2 - 0.25**2) * 0.25 for k in (1.0, 2.0)]
    both = area(plane, lambda side: side[:, 0] & side[:, 1])
    assert both == pytest.approx((under[1] - under[0]) * R**2, rel=1e-12)


@pytest.mark.parametrize("turned", [0.0, 1.0, 4.0])
def test_points_on_the_chord_of_an_arc_are_inside(turned):
    """A circle is two half circles, so that its diameter is the chord of both."""
    loops = shapes.disc(R).rotated(turned).loops
    way = np.array([math.cos(turned), math.sin(turned)])
    assert covers(loops, np.outer([-0.99, -0.3, 0.0, 0.7, 0.99], R * way)).all()
    assert not covers(loops, np.outer([-1.01, 1.01], R * way)).any()


def test_random_points_are_in_a_slotted_profile_where_shapely_says_so():
    from shapely import Polygon, contains_xy

    from geom.description.profile import ArcGrid, Profile

    profile = Profile(shapes.slotted_loop(R, R / 4, R / 2, shapes.evenly(5)), (shapes.circle_loop(R / 5),))
    fine = Polygon(profile.to_polygon(ArcGrid([profile], 5000)))
    points = np.random.default_rng(1).uniform(-1.1 * R, 1.1 * R, (4000, 2))
    said = contains_xy(fine, points)
    assert 0.2 < said.mean() < 0.8
    assert (covers(profile.loops, points) == said).mean() > 0.999  # chords are not arcs
