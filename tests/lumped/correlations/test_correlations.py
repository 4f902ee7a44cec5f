"""Correlations: published values, limits, continuity, range warnings."""

import math
import warnings

import numpy as np
import pytest

from geom.errors import InputError
from lumped.correlations import film_tabulated
from lumped.correlations.air_gap import becker_kaye, taylor_film
from lumped.correlations.contacts import concentric_cylinders, cooper_mikic_yovanovich, gap_film, groove_emissivity
from lumped.correlations.ducts import hausen_laminar, shah_london, staton_rectangle
from lumped.correlations.forced import flat_plate
from lumped.correlations.natural import churchill_chu_plate
from lumped.correlations.windings import mellor as mellor_circuit
from lumped.transfer.properties import air, ethylene_glycol, mass_fraction_of, water

pytestmark = pytest.mark.filterwarnings("ignore::lumped.correlations.RangeWarning")

GLYCOL = ethylene_glycol(60.0, 0.5)


@pytest.mark.parametrize(("Ta", "films", "whole"), [(60, 2.55, 2.58), (300, 6.1, 6.4), (1000, 11.1, 11.4)])
def test_air_gap_laws_agree_with_the_published_comparison(Ta, films, whole):
    fluid, r, gap = air(80.0), 0.1, 0.001
    omega = Ta * fluid.nu / (r * gap) / math.sqrt(gap / r)
    assert taylor_film(omega, r, gap)[1].numbers["Nu"] == pytest.approx(films, rel=0.01)
    assert becker_kaye(omega, r, gap)[1].numbers["Nu"] == pytest.approx(whole, rel=0.03)


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


def test_grooves_and_gaps_between_grey_walls():
    assert groove_emissivity(1.0, 0.02, 0.01) == 1.0
    assert 0.8 < groove_emissivity(0.8, 0.02, 0.01) < 1.0
    assert concentric_cylinders(1.0, 1.0, 0.9, 0.9) == pytest.approx(1 / (2 / 0.9 - 1))


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


@pytest.mark.parametrize(
    ("T", "rho", "cp", "k", "mu"), [(0, 1074.6, 3203, 0.377, 7.93e-3), (60, 1040.5, 3503, 0.414, 1.37e-3)]
)
def test_glycol_is_the_published_table(T, rho, cp, k, mu):
    f = ethylene_glycol(T, 0.5)
    assert (f.rho, f.cp, f.k) == pytest.approx((rho, cp, k), rel=2e-3)
    assert f.mu == pytest.approx(mu, rel=5e-3)


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


def test_a_tabulated_film_is_the_correlation():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        law = film_tabulated(lambda s, a: churchill_chu_plate(0.3, s, a))
    for d in (3.3, 17.0, 64.0):
        assert law.at(d, 50.0 + d) == pytest.approx(churchill_chu_plate(0.3, 25 + d, 25.0)[0], rel=2e-3)
