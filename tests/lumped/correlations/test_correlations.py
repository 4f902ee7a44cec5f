"""Correlations: published values, limits, continuity, range warnings."""

import math
import warnings

import ht
import numpy as np
import pytest

from geom.errors import InputError
from lumped.correlations import RangeWarning, film_tabulated
from lumped.correlations.air_gap import becker_kaye, taylor_film
from lumped.correlations.contacts import (
    concentric_cylinders,
    cooper_mikic_yovanovich,
    gap_film,
    groove_emissivity,
    radiation_film,
)
from lumped.correlations.ducts import duct_film, hausen_laminar, shah_london, staton_rectangle
from lumped.correlations.end_space import end_space
from lumped.correlations.fins import heiles, van_de_pol_tierney
from lumped.correlations.forced import churchill_bernstein, flat_plate
from lumped.correlations.natural import churchill_chu_cylinder, churchill_chu_plate
from lumped.correlations.rotating import saari_windage
from lumped.correlations.windings import mellor as mellor_circuit
from lumped.transfer.properties import air, ethylene_glycol, mass_fraction_of, water

pytestmark = pytest.mark.filterwarnings("ignore::lumped.correlations.RangeWarning")

GLYCOL = ethylene_glycol(60.0, 0.5)
AIR60 = air(60.0)


def test_standing_rotor_is_pure_conduction_through_the_gap():
    k, gap = air(80.0).k, 0.001
    two_films = 1 / (2 / taylor_film(0.0, 0.1, gap)[0])
    assert two_films == pytest.approx(k / gap, rel=1e-12)
    assert becker_kaye(0.0, 0.1, gap)[0] == pytest.approx(k / gap, rel=1e-12)
    exact = k / (0.1 * math.log(0.101 / 0.1))
    assert two_films == pytest.approx(exact, rel=0.01)


@pytest.mark.parametrize(
    ("Ta", "films", "whole"), [(60, 2.55, 2.58), (100, 3.52, 3.77), (300, 6.1, 6.4), (1000, 11.1, 11.4)]
)
def test_air_gap_laws_agree_with_the_published_comparison(Ta, films, whole):
    fluid, r, gap = air(80.0), 0.1, 0.001
    omega = Ta * fluid.nu / (r * gap) / math.sqrt(gap / r)
    assert taylor_film(omega, r, gap)[1].numbers["Nu"] == pytest.approx(films, rel=0.01)
    assert becker_kaye(omega, r, gap)[1].numbers["Nu"] == pytest.approx(whole, rel=0.03)


@pytest.mark.parametrize(("spacing", "h"), [(0.004, 0.9), (0.008, 3.4), (0.012, 4.4), (0.020, 4.9)])
def test_van_de_pol_tierney_worked_values(spacing, h):
    """Depth 20 mm, height 0.25 m, 40 K above an ambient that is not stated (30 degC here: 2 to 4 %)."""
    assert van_de_pol_tierney(0.02, spacing, 0.25, 70.0, 30.0)[0] == pytest.approx(h, rel=0.05)


@pytest.mark.parametrize(("speed", "h"), [(1, 6.9), (3, 17), (5, 26), (10, 45), (15, 63)])
def test_heiles_worked_values(speed, h):
    assert heiles(speed, 0.02, 0.25, turbulence=1.0)[0] == pytest.approx(h, rel=0.04)


def test_vertical_plate_worked_example():
    """Incropera et al. 2007, example 9.2: glass fire screen 0.71 m, 232 and 23 degC, h = 7.0 W/m2/K."""
    assert churchill_chu_plate(0.71, 232.0, 23.0)[0] == pytest.approx(7.0, abs=0.15)


def test_cylinder_in_cross_flow_worked_example():
    """Incropera et al. 2007, example 7.4: 12.7 mm, 10 m/s, 26 and 128 degC, h = 96 W/m2/K."""
    assert churchill_bernstein(10.0, 0.0127, air(77.0))[0] == pytest.approx(96.0, rel=0.03)


def test_flat_plate_far_above_transition_is_the_known_formula():
    fluid = air(30.0)
    h, info = flat_plate(30.0, 10.0, fluid)
    known = (0.037 * info.numbers["Re"] ** 0.8 - 871) * fluid.Pr ** (1 / 3) * fluid.k / 10.0
    assert h == pytest.approx(known, rel=1e-3)


def test_laminar_and_rectangular_limits():
    """Shah and London 1978, square and parallel plates: 3.608, 8.235 at constant flux; 2.976, 7.541 at constant T."""
    assert hausen_laminar(100.0, 0.7, 0.01, 1e9) == pytest.approx(3.66, rel=1e-6)
    assert shah_london(1.0) == pytest.approx(3.608, rel=1e-3)
    assert shah_london(1e-9) == pytest.approx(8.235, rel=1e-3)
    assert staton_rectangle(1.0) == pytest.approx(2.976, rel=0.01)
    assert staton_rectangle(0.0) == pytest.approx(7.541, rel=0.01)


def test_heiles_agrees_with_duct_flow():
    """Published cross-check at 20 mm, 0.25 m, 5 m/s: 26 against 24 W/m2/K."""
    assert heiles(5.0, 0.02, 0.25, 1.0)[0] == pytest.approx(duct_film(5.0, 0.02, 0.25)[0], rel=0.2)


def test_smooth_duct_film_is_between_laminar_and_turbulent_in_transition():
    v = 3000 * GLYCOL.nu / 0.009
    Nu = duct_film(v, 0.009, 0.5, GLYCOL)[1].numbers["Nu"]
    assert hausen_laminar(2300, GLYCOL.Pr, 0.009, 0.5) < Nu < ht.turbulent_Gnielinski(4000, GLYCOL.Pr, 0.0416)


def test_radiation_film_worked_values():
    """6.9 W/m2/K at emissivity 0.9 between 80 and 20 degC; 1.5 at 0.2."""
    assert radiation_film(0.9, 80.0, 20.0)[0] == pytest.approx(6.9, abs=0.05)
    assert radiation_film(0.2, 80.0, 20.0)[0] == pytest.approx(1.5, abs=0.05)


def test_grooves_and_gaps_between_grey_walls():
    assert groove_emissivity(1.0, 0.02, 0.01) == 1.0
    assert 0.8 < groove_emissivity(0.8, 0.02, 0.01) < 1.0
    assert concentric_cylinders(1.0, 1.0, 0.9, 0.9) == pytest.approx(1 / (2 / 0.9 - 1))


def test_frame_of_a_motor_lies_in_the_measured_envelope():
    """Boglietti et al. 2003: still air and radiation together, R0 = 0.167 A^-1.039 K/W, within a factor 1.5."""
    area, rise = 0.5, 40.0
    h = churchill_chu_cylinder(0.3, 20 + rise, 20.0)[0] + radiation_film(0.9, 20 + rise, 20.0)[0] * 0.4
    assert 1 / 1.5 < 1 / (h * area) / (0.167 * area**-1.039) < 1.5


def test_contacts():
    assert gap_film(0.037e-3) == pytest.approx(703, rel=0.01)
    weak, strong = (cooper_mikic_yovanovich(180.0, 0.1, 2e-6, p, 1e9)[0] for p in (1e5, 1e7))
    assert 2200 < weak < strong < 4e5


def test_mellor_circuit_is_exact_for_a_heated_cylinder_cooled_outside():
    """Mean of q (r1^2 - r^2)/4k + q r2^2/2k ln(r/r1), integrated over the area; insulated inside and at the ends."""
    r1, r2, L, k = 0.1, 0.04, 0.2, 20.0
    T = mellor_circuit(r1, r2, L, k, k)
    r = np.linspace(r2, r1, 20001)
    q = 1.0 / (math.pi * (r1**2 - r2**2) * L)
    field = q * (r1**2 - r**2) / (4 * k) + q * r2**2 / (2 * k) * np.log(r / r1)
    mean = np.trapezoid(field * 2 * r, r) / (r1**2 - r2**2)
    assert T.outer + T.radial_mean == pytest.approx(mean, rel=1e-7)


def test_windage_is_zero_at_rest_and_near_cubic_at_speed():
    assert saari_windage(0.0, 0.1, 0.001, 0.2)[0] == 0.0
    low, high = (saari_windage(w, 0.1, 0.001, 0.2)[0] for w in (300.0, 600.0))
    assert 2.2 < math.log2(high / low) < 3.0


@pytest.mark.parametrize(
    ("T", "rho", "cp", "k", "mu"), [(0, 1074.6, 3203, 0.377, 7.93e-3), (60, 1040.5, 3503, 0.414, 1.37e-3)]
)
def test_glycol_is_the_published_table(T, rho, cp, k, mu):
    f = ethylene_glycol(T, 0.5)
    assert (f.rho, f.cp, f.k) == pytest.approx((rho, cp, k), rel=2e-3)
    assert f.mu == pytest.approx(mu, rel=5e-3)


def test_what_a_coolant_is_not_known_at_is_said_in_tenths():
    with pytest.raises(InputError, match=r"T = -50 degC; -35\.9 to 100 degC"):
        ethylene_glycol(-50.0, 0.5)
    ethylene_glycol(-35.9, 0.5)


def test_fluids_at_20_degC():
    """IAPWS and US Standard Atmosphere: water 998.2 kg/m3, 1.002 mPa s; air 1.204 kg/m3, 18.1 uPa s, Pr 0.71."""
    assert (water(20.0).rho, water(20.0).mu) == pytest.approx((998.2, 1.002e-3), rel=2e-3)
    assert (air(20.0).rho, air(20.0).mu) == pytest.approx((1.204, 18.1e-6), rel=5e-3)
    assert air(20.0).Pr == pytest.approx(0.71, abs=0.01)
    assert air(20.0, 2000.0).rho / air(20.0).rho == pytest.approx(0.785, abs=0.003)


@pytest.mark.parametrize("degC", [100.0, 117.0, 133.0])
def test_water_under_pressure_is_that_of_iapws(degC):
    """CoolProp's IAPWS-95 at 3 bar; it boils at 133.5 degC."""
    exact = pytest.importorskip("CoolProp.CoolProp").PropsSI
    hot, names = water(degC, 3.0), ("D", "C", "L", "V", "isobaric_expansion_coefficient")
    expected = [exact(name, "T", degC + 273.15, "P", 3e5, "Water") for name in names]
    assert (hot.rho, hot.cp, hot.k, hot.mu) == pytest.approx(expected[:4], rel=5e-3)
    assert hot.beta == pytest.approx(expected[4], rel=0.01)
    with pytest.raises(InputError, match=r"T = 134 degC; 0 to 133\.5 degC"):
        water(134.0, 3.0)
    with pytest.raises(InputError, match=r"T = 101 degC; 0 to 100 degC"):
        water(101.0)


def test_half_by_volume_is_more_than_half_by_mass():
    assert mass_fraction_of(0.5) == pytest.approx(0.527, abs=0.001)


def test_out_of_range_warns_with_value_and_range():
    with pytest.warns(RangeWarning, match=r"v = 80 outside 0 to 50"):
        info = end_space(80.0)[1]
    assert info.outside == ("v",)


def test_a_tabulated_film_is_the_correlation():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        law = film_tabulated(lambda s, a: churchill_chu_plate(0.3, s, a))
    for d in (3.3, 17.0, 64.0):
        assert law.at(d, 50.0 + d) == pytest.approx(churchill_chu_plate(0.3, 25 + d, 25.0)[0], rel=2e-3)
