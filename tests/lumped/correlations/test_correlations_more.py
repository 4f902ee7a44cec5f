"""Published values and physics that single correlations must show; for all of them: test_correlations_all.py."""

import math
from functools import partial

import numpy as np
import pytest

from lumped.correlations import contacts, ducts, natural, rotating
from lumped.correlations.bearings import brush_friction, skf_friction
from lumped.correlations.contacts import coaxial_discs, parallel_rectangles
from lumped.correlations.fins import heiles, heiles_decaying, mean_of_decay, straight_decay
from lumped.transfer.properties import air


def test_a_wide_vertical_cylinder_is_a_plate_and_a_slender_one_is_better():
    plate = natural.churchill_chu_plate(0.3, 60.0, 20.0)[0]
    assert natural.popiel_cylinder(0.3, 1.0, 60.0, 20.0)[0] == pytest.approx(plate, rel=0.01)
    assert natural.popiel_cylinder(0.3, 0.01, 60.0, 20.0)[0] > 1.1 * plate


def test_an_annulus_as_wide_as_a_tube_is_near_the_tube_s_turbulent_film():
    """Gnielinski's annulus with heat inside lies within 25 % of a duct of the same hydraulic diameter."""
    annulus = ducts.gnielinski_annulus(20.0, 0.02, 0.06, 4.0)[0]
    assert annulus == pytest.approx(ducts.duct_film(20.0, 0.04, 4.0)[0], rel=0.25)


def test_a_leaking_channel_lies_between_its_ends():
    whole, far = heiles(10.0, 0.02, 0.25)[0], heiles(2.0, 0.02, 0.25)[0]
    straight = heiles_decaying(10.0, 0.02, 0.25, partial(straight_decay, 0.2))[0]
    steep = heiles_decaying(10.0, 0.02, 0.25, lambda x: 0.2**x)[0]
    assert far < steep < straight < whole
    assert heiles_decaying(10.0, 0.02, 0.25, partial(straight_decay, 1.0))[0] == pytest.approx(whole, rel=1e-12)
    assert mean_of_decay(0.2) == pytest.approx(np.mean([straight_decay(0.2, x) for x in np.linspace(0, 1, 101)]))


def test_view_factors_are_the_published_values():
    """Incropera et al. 2007, 13.2: discs one radius apart 0.382, unit squares one apart 0.1998; reciprocity, sums."""
    assert coaxial_discs(1.0, 1.0, 1.0) == pytest.approx(0.382, abs=5e-4)
    assert parallel_rectangles(1.0, 1.0, 1.0) == pytest.approx(0.1998, abs=5e-5)
    assert coaxial_discs(1.0, 2.0, 1.5) == pytest.approx(coaxial_discs(2.0, 1.0, 1.5) * 4.0, rel=1e-12)
    assert parallel_rectangles(1.0, 1.0, 1e-6) == pytest.approx(1.0, abs=1e-4)


def test_disc_friction_is_the_moment_of_von_karman():
    """Laminar free disc, both faces: C_M = 3.87 / sqrt(Re) (Schlichting 1979), M = C_M rho omega^2 r^5 / 2."""
    fluid, omega, r = air(60.0), 20.0, 0.15
    moment = 3.87 / math.sqrt(omega * r * r / fluid.nu) * fluid.rho * omega**2 * r**5 / 2
    assert 2 * rotating.disc_windage(omega, r, fluid=fluid)[0] == pytest.approx(moment * omega, rel=1e-12)


def test_bearings_and_brushes():
    assert skf_friction(2000.0, 0.05, 100.0) == pytest.approx(7.5)
    assert brush_friction(4e-3, 10.0) == pytest.approx(0.2 * 2e4 * 4e-3 * 10.0)


@pytest.mark.parametrize("area", [0.2, 2.0])
def test_frames_from_0_2_to_2_m2_lie_in_the_measured_envelope(area):
    """Boglietti et al. 2003: still air and radiation together, R0 = 0.167 A^-1.039 K/W within a factor 1.5.

    A frame of square side view (length = diameter) whose fins double its area; between fins the air is 0.8 as good,
    and only the envelope, half the area, radiates.
    """
    diameter, rise = math.sqrt(area / 2 / (1.5 * math.pi)), 40.0
    h = 0.8 * natural.churchill_chu_cylinder(diameter, 20 + rise, 20.0)[0]
    h += 0.5 * contacts.radiation_film(0.9, 20 + rise, 20.0)[0]
    assert 1 / 1.5 < 1 / (h * area) / (0.167 * area**-1.039) < 1.5
