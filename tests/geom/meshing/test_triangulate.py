"""Triangulation of single faces: all borders kept, areas exact, also on bad shapes."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings, strategies as st

from geom.description import shapes
from geom.description.part import Part
from geom.meshing.blocks import find_blocks, find_columns
from geom.meshing.delaunay import interior_points, nudged, triangulate_face
from geom.meshing.partition import partition
from geom.meshing.triangulate import triangulate


def flat_area(points, triangles):
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]).sum() / 2


def meshed(*profiles, size, across=1):
    parts = [Part(f"p{i}", "steel", ((profile, 0.0, 1.0),)) for i, profile in enumerate(profiles)]
    cut = partition(parts, 36)
    return triangulate(find_columns(cut, find_blocks(cut)), size, across)


@given(st.floats(0.02, 0.2), st.floats(0.001, 0.1))
@settings(max_examples=25, deadline=None)
def test_comb_with_thin_gaps_is_covered_exactly(size, width):
    """A comb has borders that an unconstrained Delaunay triangulation would cut across."""
    teeth = shapely.union_all(
        [shapely.box(i * 0.2, 0, i * 0.2 + width, 1) for i in range(4)] + [shapely.box(0, -0.1, 1, 0)]
    )
    ring = shapely.get_coordinates(shapely.orient_polygons(teeth).exterior)[:-1]
    points, n = nudged(ring), len(ring)
    border = np.column_stack([np.arange(n), (np.arange(n) + 1) % n])
    inside = interior_points(teeth, size)
    triangles = triangulate_face(np.vstack([points, inside]), border, shapely.Polygon(points))
    assert flat_area(np.vstack([ring, inside]), triangles) == pytest.approx(teeth.area, rel=1e-9)


def test_corners_in_a_line_by_chance_make_no_flat_triangle():
    """A triangle without area has no conductivity; what is left of it is a hole in the mesh."""
    outside = [(0.0326482988936, -0.03764850089333333), (0.0476218, 0.0127538), (-0.0339002, 0.0378999)]
    outside += [(-0.0363756, 0.0354245), (-0.0369493, 0.0348508), (-0.0508707, -0.0004094)]
    hole = [(0.0163715, -0.0188937), (0.013516, -0.0210313), (0.0103854, -0.0227408)]
    rings = [np.array(outside), np.array(hole)]
    border = np.array([*zip(range(6), [1, 2, 3, 4, 5, 0]), (6, 7), (7, 8), (8, 6)])
    points = np.vstack(rings)
    triangles = triangulate_face(points, border, shapely.Polygon(rings[0], rings[1:]))
    assert min(flat_area(points, triangles[[k]]) for k in range(len(triangles))) > 1e-9


@pytest.mark.parametrize("size", [0.004, 0.1])
def test_thin_layer_is_one_element_across(size):
    layer, plate = shapes.rectangle(0, 0.1, 0, 3e-4), shapes.rectangle(0, 0.1, 3e-4, 0.05)
    flat = meshed(layer, plate, size=size)
    assert len(flat.triangles[0]) <= 2 * np.ceil(0.1 / size) + 2


def test_winding_in_a_slot_has_points_inside_even_when_coarse():
    flat = meshed(shapes.rectangle(0.1, 0.13, -0.004, 0.004), size=1.0, across=1)
    inside = (np.abs(flat.points[:, 1]) < 0.0039) & (flat.points[:, 0] > 0.1001) & (flat.points[:, 0] < 0.1299)
    assert inside.sum() >= 2


@pytest.mark.parametrize("size", [0.01, 0.03])
def test_areas_add_up(size):
    flat = meshed(shapes.disc(0.05), shapes.rectangle(0.1, 0.3, -0.1, 0.1), size=size)
    total = sum(flat_area(flat.points, triangles) for triangles in flat.triangles)
    assert total == pytest.approx(18 * 0.05**2 * np.sin(np.pi / 18) + 0.04, rel=1e-6)


@pytest.mark.parametrize("size", [0.01, 0.02])
def test_triangles_of_a_square_are_good(size):
    flat = meshed(shapes.rectangle(0, 0.1, 0, 0.1), size=size)
    corners = flat.points[flat.triangles[0]]
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / 2
    quality = 4 * np.sqrt(3) * area / (sides**2).sum(axis=1)  # 1 for an equilateral triangle
    assert np.median(quality) > 0.8
    assert quality.min() > 0.2
