"""Stacked prisms as one exact solid: volumes and areas by hand, closed, valid, and the same after STEP."""

import math

import cadquery as cq
import pytest
from OCP.BRepCheck import BRepCheck_Analyzer

from geom.description import shapes
from geom.description.profile import Profile
from geom.solids.stack import stacked
from geom.solids.surfaces import surface

R = 0.02  # m


def checked(prisms, tmp_path=None):
    """The solids: valid, closed, and of the prisms' volume."""
    solids = stacked(prisms)
    for solid in solids:
        assert BRepCheck_Analyzer(solid.wrapped).IsValid()
        mesh = surface(solid, 0.05)
        assert mesh.is_watertight
        assert mesh.volume == pytest.approx(solid.Volume(), rel=0.02)
    exact = sum(profile.area * (z1 - z0) for profile, z0, z1 in prisms)
    assert sum(solid.Volume() for solid in solids) * 1e-9 == pytest.approx(exact, rel=1e-12)
    return solids


def test_stepped_shaft_is_one_solid_with_three_cylinders():
    (shaft,) = checked([(shapes.disc(R), 0.0, 0.1), (shapes.disc(2 * R), 0.1, 0.14), (shapes.disc(R), 0.14, 0.2)])
    around = 2 * math.pi * (R * 0.16 + 2 * R * 0.04) + 2 * math.pi * (2 * R) ** 2
    assert shaft.Area() * 1e-6 == pytest.approx(around, rel=1e-12)
    assert len(shaft.Faces()) == 2 * 3 + 4  # each cylinder in halves; two ends, two shoulders


def test_what_crosses_elsewhere_leaves_no_edges_behind():
    """Bars across a ring cut its circles only on the level where they meet."""
    bar = Profile(shapes.bar_loop(0.8 * R, 2 * R, R / 4))
    (whole,) = checked(
        [(shapes.ring(R, 1.5 * R), 0.0, 0.05), *((p, 0.05, 0.06) for p in shapes.turned(bar, (0.5, 2.0)))]
    )
    assert (
        len(whole.Faces()) == 4 + 1 + 2 + 2 * 7
    )  # ring: walls, foot, two halves of its top; bar: walls, top, two feet
    assert sum(face.geomType() == "CYLINDER" for face in whole.Faces()) == 4 + 2 * 2


def test_a_closed_void_is_a_second_shell_of_the_solid_around_it():
    """Two capsules, one inside the other's void."""

    def capsule(r, z0, z1, wall):
        return [
            (shapes.disc(r), z0, z0 + wall),
            (shapes.ring(r - wall, r), z0 + wall, z1 - wall),
            (shapes.disc(r), z1 - wall, z1),
        ]

    large, small = sorted(checked(capsule(R, 0.0, 0.1, 0.002) + capsule(R / 2, 0.02, 0.08, 0.001)), key=cq.Solid.Volume)
    assert [len(solid.Shells()) for solid in (large, small)] == [2, 2]


def test_prisms_that_touch_in_a_point_or_along_an_edge_stay_apart():
    solids = checked(
        [
            (shapes.rectangle(0, R, 0, R), 0.0, 0.01),
            (shapes.rectangle(R, 2 * R, R, 2 * R), 0.0, 0.01),
            (shapes.rectangle(-R, 0, 0, R), 0.01, 0.02),
        ]
    )
    assert len(solids) == 3


def test_a_ceiling_with_a_hole_that_holds_an_island():
    """A plate on a ring and a post: its underside is a ring around the post."""
    (whole,) = checked(
        [(shapes.ring(2 * R, 3 * R), 0.0, 0.01), (shapes.disc(R), 0.0, 0.01), (shapes.disc(3 * R), 0.01, 0.02)]
    )
    under = [face for face in whole.Faces() if abs(face.Center().z - 10.0) < 1e-9]
    assert [face.Area() * 1e-6 for face in under] == [pytest.approx(math.pi * 3 * R**2)]
