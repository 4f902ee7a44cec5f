"""Helical channels: volume and area in closed form, closed, inside their housing, and the same after STEP."""

import math

import cadquery as cq
import pytest
from OCP.BRepCheck import BRepCheck_Analyzer
from scipy.integrate import quad

from geom.description import shapes
from geom.description.part import CadShape, Helix, Rod
from geom.solids.cad import carved
from geom.solids.screw import channel
from geom.solids.surfaces import surface

HELICES = [
    Helix(0.100, 0.110, 0.020, 0.120, 0.020, 0.015, 0.004, 0.7),
    Helix(0.050, 0.080, 0.010, 0.040, 0.025, 0.020, 0.020, -2.0),  # as blunt as wide: no end plane is left
    pytest.param(Helix(1.500, 1.520, 0.100, 2.900, 0.070, 0.040, 0.010, 3.0), marks=pytest.mark.nightly),  # forty turns
    Helix(0.010, 0.012, 0.005, 0.009, 0.003, 0.002, 0.001, 0.0),
]
CASES = pytest.mark.parametrize("helix", HELICES, ids=lambda h: f"{h.turns:.1f} turns")


def area(h):
    """Walls at both radii, two helicoids, what the end planes cut, two blunt ends (m2)."""
    strip = 2 * h.volume / (h.outer**2 - h.inner**2)  # angle times height
    rise = h.pitch / (2 * math.pi)
    slant = (h.width - h.blunt) / rise
    whole = 2 * math.pi * h.turns

    def primitive(r):  # of sqrt(r2 + rise2)
        return (r * math.hypot(r, rise) + rise**2 * math.asinh(r / rise)) / 2

    screws = 2 * (whole - slant) * (primitive(h.outer) - primitive(h.inner))
    planes = slant * (h.outer**2 - h.inner**2)
    return strip * (h.inner + h.outer) + screws + planes + 2 * h.blunt * (h.outer - h.inner)


def around(h):
    """A wall that holds it."""
    return (shapes.ring(0.8 * h.inner, 1.2 * h.outer), h.bottom - h.width, h.top + h.width)


@CASES
def test_channel_has_its_exact_volume_and_area_and_is_closed(helix):
    solid = channel(helix)
    assert BRepCheck_Analyzer(solid.wrapped).IsValid()
    assert solid.Volume() * 1e-9 == pytest.approx(helix.volume, rel=1e-11)
    assert solid.Area() * 1e-6 == pytest.approx(area(helix), rel=1e-9)
    mesh = surface(solid, 0.02)
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(solid.Volume(), rel=2e-3)  # chords of 0.1 rad


@CASES
def test_wall_around_a_channel_lacks_just_that(helix):
    profile, z0, z1 = around(helix)
    (wall,) = carved(CadShape((around(helix),), (helix,)))
    assert wall.Volume() * 1e-9 == pytest.approx(profile.area * (z1 - z0) - helix.volume, rel=1e-12)
    assert len(wall.Shells()) == 2
    assert surface(wall, 0.05).is_watertight


def test_a_port_opens_the_channel():
    """One shell is left; it lacks the bore from the channel's radius to that of the wall."""
    helix = HELICES[0]
    r1, bore = helix.outer, 0.006
    middle = helix.bottom + helix.blunt - helix.width / 2 + helix.pitch  # of the channel, a turn after its start
    port = Rod(helix.angle, middle, r1 - 0.003, 1.3 * r1, bore)
    (closed,), (opened,) = (carved(CadShape((around(helix),), (helix, *ports))) for ports in ((), (port,)))
    assert len(opened.Shells()) == 1
    assert surface(opened, 0.05).is_watertight
    half, r2 = bore / 2, 1.2 * r1
    lost, _ = quad(
        lambda y: 2 * math.sqrt(half**2 - y**2) * (math.sqrt(r2**2 - y**2) - math.sqrt(r1**2 - y**2)), -half, half
    )
    assert (
        lost > 1e-4 * closed.Volume() * 1e-9
    )  # a hundred times what is let pass: of bored faces OpenCASCADE integrates
    assert opened.Volume() == pytest.approx(closed.Volume() - lost * 1e9, rel=1e-6)


def test_channel_is_the_same_after_step(tmp_path):
    (wall,) = carved(CadShape((around(HELICES[0]),), (HELICES[0],)))
    cq.exporters.export(cq.Workplane(wall), str(tmp_path / "wall.step"))
    back = cq.importers.importStep(str(tmp_path / "wall.step")).val()
    assert back.isValid()
    assert back.Volume() == pytest.approx(wall.Volume(), rel=1e-9)
    assert back.Area() == pytest.approx(wall.Area(), rel=1e-9)
