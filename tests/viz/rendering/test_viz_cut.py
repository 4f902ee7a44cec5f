"""Cuts against closed forms: areas of the polygon the ring mesh really is."""

import numpy as np
import pytest
from small_motor import LEVELS, RADII, motor

from geom.errors import InputError
from viz.rendering.cut import HALF, QUARTER, Wedge, cut_away, exposed, section
from viz.rendering.nodes import on_nodes, split
from viz.rendering.scene import feature_edges, polydata

NODES = split(motor(32))


def area(surface):
    a, b, c = surface.points[surface.triangles].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def test_parts_share_no_node():
    assert all(len(np.unique(NODES.owner[NODES.tets[NODES.region == i]])) == 1 for i in range(len(NODES.parts)))


def test_parts_that_are_left_out_leave_the_others_as_they_were():
    less = split(motor(32), ["shaft", "flange.left"])
    assert less.parts == tuple(p for p in NODES.parts if p not in ("shaft", "flange.left"))
    np.testing.assert_array_equal(less.points[less.of("yoke")], NODES.points[NODES.of("yoke")])
    kept = np.isin(NODES.region, [NODES.parts.index(p) for p in less.parts])
    np.testing.assert_array_equal(less.points[less.tets], NODES.points[NODES.tets[kept]])


def test_section_through_mesh_lines_has_the_area_of_the_half_planes():
    shaft = 2 * RADII[1] * LEVELS[-1]
    flange = 2 * (RADII[-1] - RADII[1]) * (LEVELS[2] - LEVELS[1])
    cut = section(NODES, np.array([1.0, 0.0, 0.0]))
    for part, expected in (("shaft", shaft), ("flange.left", flange)):
        assert area(cut.only(cut.part == NODES.parts.index(part))) == pytest.approx(expected)


@pytest.mark.parametrize("start", [0.0, 13.7, 90.0])
def test_wedge_and_the_rest_make_up_the_outside(start):
    """Two complementary half cuts have the whole outside and the section twice."""
    normal = np.array([-np.sin(np.deg2rad(start)), np.cos(np.deg2rad(start)), 0.0])
    both = area(cut_away(NODES, Wedge(start, 180))) + area(cut_away(NODES, Wedge(start + 180, 180)))
    assert both == pytest.approx(area(exposed(NODES)) + 2 * area(section(NODES, normal)))


@pytest.mark.parametrize("wedge", [QUARTER, HALF, Wedge(33.3, 71.0)])
def test_a_linear_field_is_drawn_exactly(wedge):
    surface = cut_away(NODES, wedge)
    field = NODES.points @ [30.0, -20.0, 55.0] + 40.0
    np.testing.assert_allclose(surface.values(field), surface.points @ [30.0, -20.0, 55.0] + 40.0, atol=1e-9)


def test_nothing_is_left_inside_the_wedge():
    points = cut_away(NODES, QUARTER).points
    assert not ((points[:, 0] < -1e-9) & (points[:, 1] > 1e-9)).any()


def test_flat_sections_have_no_lines_inside_a_part():
    """The yoke's section is two rectangles: their edges are on its outline only."""
    cut = section(NODES, np.array([np.sin(0.3), np.cos(0.3), 0.0]))
    yoke = cut.only(cut.part == NODES.parts.index("yoke")).compact()
    length = feature_edges(polydata(yoke)).compute_cell_sizes(volume=False, area=False)["Length"].sum()
    z = LEVELS[8] - LEVELS[2]
    radial = np.ptp(np.hypot(*yoke.points[:, :2].T))
    assert length == pytest.approx(4 * (z + radial), rel=1e-3)


@pytest.mark.parametrize(
    ("T", "says"), [(np.zeros(7), f"{NODES.size} values"), (np.full(NODES.size, np.nan), "finite")]
)
def test_temperatures_are_one_finite_number_a_node(T, says):
    with pytest.raises(InputError, match=says):
        on_nodes(NODES, T)


def test_wedge_wider_than_half_is_refused():
    with pytest.raises(InputError, match="at most 180"):
        Wedge(0.0, 200.0)
