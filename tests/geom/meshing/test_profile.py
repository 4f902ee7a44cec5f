"""Profiles: exact areas against closed forms, and faceting that neighbours share."""

import math

import pytest
from hypothesis import given, strategies as st

from geom.description import shapes
from geom.description.profile import ArcGrid, Profile, loop_length
from geom.machine_file import load_machine

angles = st.floats(0.05, 3.0)


@given(st.floats(0.01, 1.0), st.floats(0.1, 0.9))
def test_ring_area_is_pi_times_the_difference_of_squares(outer, ratio):
    assert shapes.ring(outer * ratio, outer).area == pytest.approx(math.pi * outer**2 * (1 - ratio**2))


@given(angles)
def test_sector_area_is_its_share_of_the_ring(sweep):
    assert shapes.sector(0.1, 0.2, 0.3, 0.3 + sweep).area == pytest.approx(sweep * (0.2**2 - 0.1**2) / 2)


def test_slots_and_bars_together_fill_the_disc():
    turns = shapes.evenly(12)
    core = Profile(shapes.slotted_loop(0.1, 0.01, 0.07, turns))
    assert core.area + 12 * Profile(shapes.bar_loop(0.07, 0.1, 0.01)).area == pytest.approx(math.pi * 0.01)


def test_fin_adds_its_rectangle_less_the_circular_segment_it_stands_on():
    r, w, tip, n = 0.1, 0.004, 0.12, 20
    root = shapes.on_circle(r, w / 2)
    half = math.asin(w / 2 / r)
    segment = r**2 * (2 * half - math.sin(2 * half)) / 2
    expected = math.pi * r**2 + n * (w * (tip - root) - segment)
    assert Profile(shapes.finned_loop(r, w, tip, shapes.evenly(n))).area == pytest.approx(expected)


@given(angles, st.integers(12, 90))
def test_neighbours_across_an_arc_leave_neither_gap_nor_overlap(sweep, segments):
    inner, outer = shapes.sector(0.05, 0.1, 0.0, sweep), shapes.ring(0.1, 0.12)
    grid = ArcGrid([inner, outer], segments)
    a, b = inner.to_polygon(grid), outer.to_polygon(grid)
    assert a.intersection(b).area < 1e-13
    assert a.distance(b) < 1e-13


def test_faceted_circle_loses_the_area_of_an_inscribed_polygon():
    circle = shapes.disc(0.1)
    n = 72
    assert circle.to_polygon(ArcGrid([circle], n)).area == pytest.approx(n / 2 * 0.01 * math.sin(2 * math.pi / n))


@pytest.mark.parametrize("name", ["series-dc-100kw-jacket-one", "tefc-industrial-radial", "pmsm-m1"])
def test_bounds_are_those_of_a_fine_polygon(name):
    """Chords of 1 / 720 turn stay within R (1 - cos(pi / 720)), 3 um of 300 mm, inside."""
    for profile in {profile for part in load_machine(name).parts for profile, _, _ in part.prisms}:
        fine = profile.to_polygon(ArcGrid([profile], 720)).bounds
        assert profile.bounds == pytest.approx(fine, abs=4e-6)


def test_the_length_of_a_loop_counts_its_arcs():
    disc = shapes.circle_loop(0.1)
    assert loop_length(disc) == pytest.approx(2.0 * math.pi * 0.1, rel=1e-12)
    assert loop_length(shapes.rectangle(0.0, 0.3, 0.0, 0.2).outer) == pytest.approx(1.0, rel=1e-12)


def corners(off):
    """Of a circle on the grid of two sectors that meet, one turned by `off` (rad)."""
    grid = ArcGrid([shapes.sector(0.1, 0.2, 0.0, 1.0), shapes.sector(0.1, 0.2, 1.0 + off, 6.0)])
    return len(grid.facet(shapes.circle_loop(0.1)))


def test_ends_that_differ_by_rounding_cut_a_circle_once():
    assert corners(3e-10) == corners(0.0) == corners(1e-3) - 1
