"""Correlations by one test for all: none is forgotten, dimensions fit, ranges warn; published values of the rest."""

import importlib
import inspect
import math
import pkgutil
import warnings
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import lumped.correlations
from lumped.correlations import Info, RangeWarning, air_gap, contacts, ducts, end_space, fins, forced, natural, rotating
from lumped.correlations.bearings import (
    brush_friction,
    brush_resistance,
    commutator_share,
    kylander_bearing,
    mean_surface_speed,
    skf_friction,
)
from lumped.correlations.fins import exponential_decay, heiles, heiles_decaying, mean_of_decay, straight_decay
from lumped.correlations.views import coaxial_discs, enclosed, groove, parallel_rectangles
from lumped.properties import air, ethylene_glycol

AIR, GLYCOL = air(60.0), ethylene_glycol(60.0, 0.5)


def fixed(fluid):
    """Properties that do not depend on temperature."""
    return lambda T: fluid


# name -> ((fluid, unit of length, unit of speed, unit of temperature) -> h, reachable point outside the range)
CASES = {
    "churchill_chu_cylinder": (
        lambda f, m, v, K: natural.churchill_chu_cylinder(0.3 * m, 60 * K, 20 * K, fixed(f)),
        lambda: natural.churchill_chu_cylinder(9.0, 300.0, 20.0),
    ),
    "churchill_chu_plate": (
        lambda f, m, v, K: natural.churchill_chu_plate(0.3 * m, 60 * K, 20 * K, fixed(f)),
        lambda: natural.churchill_chu_plate(9.0, 300.0, 20.0),
    ),
    "popiel_cylinder": (
        lambda f, m, v, K: natural.popiel_cylinder(0.3 * m, 0.02 * m, 60 * K, 20 * K, fixed(f)),
        lambda: natural.popiel_cylinder(9.0, 0.2, 300.0, 20.0),
    ),
    "mcadams_plate": (
        lambda f, m, v, K: natural.mcadams_plate(0.1 * m, 60 * K, 20 * K, True, fixed(f)),
        lambda: natural.mcadams_plate(0.003, 21.0, 20.0),
    ),
    "van_de_pol_tierney": (None, lambda: fins.van_de_pol_tierney(0.05, 0.05, 0.05, 200.0, 20.0)),
    "jones_smith": (
        lambda f, m, v, K: fins.jones_smith(0.012 * m, 60 * K, 20 * K, fixed(f)),
        lambda: fins.jones_smith(0.1, 200.0, 20.0),
    ),
    "elenbaas": (
        lambda f, m, v, K: fins.elenbaas(0.01 * m, 0.2 * m, 60 * K, 20 * K, fixed(f)),
        lambda: fins.elenbaas(0.001, 0.5, 21.0, 20.0),
    ),
    "heiles": (None, lambda: fins.heiles(40.0, 0.02, 0.25)),
    "heiles_decaying": (None, lambda: fins.heiles_decaying(60.0, 0.02, 0.25, straight_decay(0.2))),
    "flat_plate": (lambda f, m, v, K: forced.flat_plate(8 * v, 0.5 * m, f), lambda: forced.flat_plate(400.0, 10.0)),
    "churchill_bernstein": (
        lambda f, m, v, K: forced.churchill_bernstein(8 * v, 0.3 * m, f),
        lambda: forced.churchill_bernstein(1e-6, 0.3),
    ),
    "duct_film": (
        lambda f, m, v, K: ducts.duct_film(8 * v, 0.02 * m, 0.3 * m, f), lambda: ducts.duct_film(5000.0, 0.2, 2.0),
    ),
    "gnielinski_annulus": (
        lambda f, m, v, K: ducts.gnielinski_annulus(8 * v, 0.1 * m, 0.12 * m, 0.3 * m, f),
        lambda: ducts.gnielinski_annulus(1500.0, 0.1, 0.2, 2.0),
    ),
    "schmidt_helical": (
        lambda f, m, v, K: ducts.schmidt_helical(1 * v, 0.01 * m, 0.3 * m, f),
        lambda: ducts.schmidt_helical(500.0, 0.01, 0.3, GLYCOL),
    ),
    "taylor_film": (
        lambda f, m, v, K: air_gap.taylor_film(300 * v / m, 0.1 * m, 0.001 * m, f),
        lambda: air_gap.taylor_film(100.0, 0.1, 0.03),
    ),
    "becker_kaye": (
        lambda f, m, v, K: air_gap.becker_kaye(300 * v / m, 0.1 * m, 0.001 * m, f),
        lambda: air_gap.becker_kaye(100.0, 0.1, 0.03),
    ),
    "romanazzi_howey": (
        lambda f, m, v, K: air_gap.romanazzi_howey(300 * v / m, 0.1 * m, 0.003 * m, f),
        lambda: air_gap.romanazzi_howey(2000.0, 0.1, 0.02),
    ),
    "kosterin_finatev": (
        lambda f, m, v, K: air_gap.kosterin_finatev(300 * v / m, 20 * v, 0.1 * m, 0.003 * m, f),
        lambda: air_gap.kosterin_finatev(300.0, 1.0, 0.1, 0.001),
    ),
    "gazley_slotting": (None, lambda: air_gap.gazley_slotting(0.01, 0.001, 2e4)),
    "rotating_disc": (
        lambda f, m, v, K: rotating.rotating_disc(300 * v / m, 0.1 * m, f), lambda: rotating.rotating_disc(3e4, 0.3),
    ),
    "rotating_shaft": (
        lambda f, m, v, K: rotating.rotating_shaft(300 * v / m, 0.05 * m, f),
        lambda: rotating.rotating_shaft(1.0, 0.05),
    ),
    "saari_windage": (None, lambda: rotating.saari_windage(5e5, 0.1, 0.01, 0.2)),
    "disc_windage": (None, lambda: rotating.disc_windage(3e4, 0.3)),
    "end_space": (None, lambda: end_space.end_space(80.0)),
    "schubert": (None, lambda: end_space.schubert(80.0)),
    "mellor": (None, lambda: end_space.mellor(80.0)),
    "boglietti": (None, lambda: end_space.boglietti(80.0)),
    "stokum": (None, lambda: end_space.stokum(80.0)),
    "di_gerlando": (None, lambda: end_space.di_gerlando(80.0)),
    "hamdi": (None, lambda: end_space.hamdi(80.0)),
    "cooper_mikic_yovanovich": (None, lambda: contacts.cooper_mikic_yovanovich(180.0, 0.1, 2e-6, 1e8, 1e9)),
    "radiation_film": (None, lambda: contacts.radiation_film(1.2, 80.0, 20.0)),
    "kylander_bearing": (None, lambda: kylander_bearing(0.2, 10.0)),
    "hashin_shtrikman": (None, lambda: windings().hashin_shtrikman(0.9, 400.0, 0.2)),
}  # fmt: skip


def windings():
    return importlib.import_module("lumped.correlations.windings")


def declared():
    """Every public function of the room that answers with an Info."""
    found = set()
    for module in pkgutil.iter_modules(lumped.correlations.__path__, "lumped.correlations."):
        for name, f in inspect.getmembers(importlib.import_module(module.name), inspect.isfunction):
            if f.__module__ == module.name and not name.startswith("_") and "Info]" in str(f.__annotations__["return"]):
                found.add(name)
    return found


def test_no_correlation_is_missing_from_this_list():
    assert declared() == set(CASES)


@pytest.mark.parametrize("name", CASES)
def test_outside_its_range_it_warns_with_value_and_range(name):
    with pytest.warns(RangeWarning, match=r"= \S+ outside \S+ to \S+"):
        _, info = CASES[name][1]()
    assert isinstance(info, Info)
    assert info.outside


DIMENSIONAL = [name for name, (h, _) in CASES.items() if h is not None]
METRE, SECOND, KILOGRAM, KELVIN = 3.0, 0.25, 7.0, 1.7


@pytest.mark.parametrize("name", DIMENSIONAL)
@pytest.mark.parametrize("fluid", [AIR, GLYCOL], ids=["air", "glycol"])
def test_dimensions_fit(name, fluid, monkeypatch):
    """In other units of length, time, mass and temperature the film is the same, in kg/s3/K."""
    joule, gravity = KILOGRAM * METRE**2 / SECOND**2, natural.G * METRE / SECOND**2
    other = replace(
        fluid, rho=fluid.rho * KILOGRAM / METRE**3, cp=fluid.cp * joule / KILOGRAM / KELVIN,
        k=fluid.k * joule / SECOND / METRE / KELVIN, mu=fluid.mu * KILOGRAM / METRE / SECOND,
        beta=fluid.beta / KELVIN,
    )  # fmt: skip
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        here = CASES[name][0](fluid, 1.0, 1.0, 1.0)[0]
        for module in (natural, fins):
            monkeypatch.setattr(module, "G", gravity)
        there = CASES[name][0](other, METRE, METRE / SECOND, KELVIN)[0]
    assert there == pytest.approx(here * KILOGRAM / SECOND**3 / KELVIN, rel=1e-9)


def rises_without_a_jump(f, top, tolerance=0.02):
    x = np.linspace(top / 4000, top, 4001)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        h = np.array([f(v) for v in x])
        assert 0.0 <= f(0.0) <= h[0] * (1 + 1e-12)
    assert np.all(np.diff(h) >= -1e-12 * h[1:])
    assert np.diff(h)[1:].max() <= tolerance * h.max()


CURVES = {
    "popiel_cylinder": (lambda x: natural.popiel_cylinder(0.4, 0.05, 20 + x, 20.0)[0], 200.0),
    "gnielinski_annulus": (lambda x: ducts.gnielinski_annulus(x, 0.1, 0.12, 0.5)[0], 40.0),
    "kosterin_finatev": (lambda x: air_gap.kosterin_finatev(300.0, x, 0.1, 0.003)[0], 60.0),
    "heiles_decaying": (lambda x: heiles_decaying(x, 0.02, 0.25, straight_decay(0.2))[0], 30.0),
    "disc_windage": (lambda x: rotating.disc_windage(x, 0.2)[0], 600.0),
    "gazley_slotting": (lambda x: air_gap.gazley_slotting(0.01, 0.001, x)[0], 9000.0),
}


@pytest.mark.parametrize(("curve", "top"), CURVES.values(), ids=CURVES)
def test_it_rises_without_a_jump(curve, top):
    rises_without_a_jump(curve, top)


def test_a_wide_vertical_cylinder_is_a_plate_and_a_slender_one_is_better():
    plate = natural.churchill_chu_plate(0.3, 60.0, 20.0)[0]
    assert natural.popiel_cylinder(0.3, 1.0, 60.0, 20.0)[0] == pytest.approx(plate, rel=1e-12)
    assert natural.popiel_cylinder(0.3, 0.01, 60.0, 20.0)[0] > 1.1 * plate


def test_an_annulus_as_wide_as_a_tube_is_near_the_tube_s_turbulent_film():
    """Gnielinski's annulus with heat inside lies within 25 % of a duct of the same hydraulic diameter."""
    annulus = ducts.gnielinski_annulus(20.0, 0.02, 0.06, 4.0)[0]
    assert annulus == pytest.approx(ducts.duct_film(20.0, 0.04, 4.0)[0], rel=0.25)


def test_slots_change_nothing_at_rest_and_a_tenth_at_most():
    assert air_gap.gazley_slotting(0.01, 0.001, 0.0)[0] == 1.0
    assert air_gap.gazley_slotting(0.01, 0.001, 9e3)[0] == pytest.approx(1.1)


def test_without_through_flow_the_gap_is_taylor_s():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        blown = air_gap.kosterin_finatev(300.0, 0.0, 0.1, 0.001)[0]
    assert blown == air_gap.taylor_film(300.0, 0.1, 0.001)[0]


def test_a_leaking_channel_lies_between_its_ends():
    whole, far = heiles(10.0, 0.02, 0.25)[0], heiles(2.0, 0.02, 0.25)[0]
    straight = heiles_decaying(10.0, 0.02, 0.25, straight_decay(0.2))[0]
    steep = heiles_decaying(10.0, 0.02, 0.25, exponential_decay(0.2))[0]
    assert far < steep < straight < whole
    assert heiles_decaying(10.0, 0.02, 0.25, straight_decay(1.0))[0] == pytest.approx(whole, rel=1e-12)
    assert mean_of_decay(0.2) == pytest.approx(np.mean([straight_decay(0.2)(x) for x in np.linspace(0, 1, 101)]))


def test_view_factors_are_the_published_values():
    """Incropera et al. 2007, 13.2: discs one radius apart 0.382, unit squares one apart 0.1998; reciprocity, sums."""
    assert coaxial_discs(1.0, 1.0, 1.0) == pytest.approx(0.382, abs=5e-4)
    assert parallel_rectangles(1.0, 1.0, 1.0) == pytest.approx(0.1998, abs=5e-5)
    assert coaxial_discs(1.0, 2.0, 1.5) == pytest.approx(coaxial_discs(2.0, 1.0, 1.5) * 4.0, rel=1e-12)
    assert parallel_rectangles(1.0, 1.0, 1e-6) == pytest.approx(enclosed(), abs=1e-4)
    assert groove(0.0, 1.0) == 1.0
    assert groove(1.0, 1.0) == pytest.approx(math.sqrt(2) - 1)


def test_disc_friction_is_the_moment_of_von_karman():
    """Laminar free disc, both faces: C_M = 3.87 / sqrt(Re) (Schlichting 1979), M = C_M rho omega^2 r^5 / 2."""
    fluid, omega, r = air(60.0), 20.0, 0.15
    moment = 3.87 / math.sqrt(omega * r * r / fluid.nu) * fluid.rho * omega**2 * r**5 / 2
    assert 2 * rotating.disc_windage(omega, r, fluid=fluid)[0] == pytest.approx(moment * omega, rel=1e-12)


def test_bearings_and_brushes():
    """Kylander at 60 mm, standing: 0.45 * 0.06 * 33 = 0.891 K/W."""
    assert kylander_bearing(0.06, 0.0)[0] == pytest.approx(0.891)
    assert kylander_bearing(0.06, 300.0)[0] < 0.891
    assert skf_friction(2000.0, 0.05, 100.0) == pytest.approx(7.5)
    assert brush_friction(4e-3, mean_surface_speed(0.2, 1000.0)) == pytest.approx(
        0.2 * 2e4 * 4e-3 * math.pi * 0.2 / 0.06
    )
    assert brush_resistance(0.03, 1e-3) == pytest.approx(1.0)
    copper, carbon = commutator_share(2.0, 500.0, 250.0)
    assert copper + carbon == pytest.approx(2.0 * 500.0 + 250.0)


@pytest.mark.parametrize("pair", contacts.PRESSED)
def test_pressed_contacts_are_spread_over_their_table(pair):
    mean, sd = contacts.contact_film(pair)
    low, high = contacts.PRESSED[pair]
    assert_allclose([mean * math.exp(-2 * sd), mean * math.exp(2 * sd)], [low, high], rtol=1e-12)


@pytest.mark.parametrize("area", [0.2, 0.5, 1.0, 2.0])
def test_frames_from_0_2_to_2_m2_lie_in_the_measured_envelope(area):
    """Boglietti et al. 2003: still air and radiation together, R0 = 0.167 A^-1.039 K/W within a factor 1.5.

    A frame of square side view (length = diameter) whose fins double its area; between fins the air is 0.8 as good,
    and only the envelope, half the area, radiates.
    """
    diameter, rise = math.sqrt(area / 2 / (1.5 * math.pi)), 40.0
    h = 0.8 * natural.churchill_chu_cylinder(diameter, 20 + rise, 20.0)[0]
    h += 0.5 * contacts.radiation_film(0.9, 20 + rise, 20.0)[0]
    assert 1 / 1.5 < 1 / (h * area) / (0.167 * area**-1.039) < 1.5
