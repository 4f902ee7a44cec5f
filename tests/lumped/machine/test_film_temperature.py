"""Forced films of a motor at any film temperature, against the correlations with properties of another library."""

import numpy as np
import pytest

from geom import load_machine
from geom.description.geometry import Duct
from lumped.correlations.air_gap import taylor_film
from lumped.correlations.ducts import duct_film
from lumped.correlations.fins import heiles
from lumped.correlations.forced import flat_plate
from lumped.machine.air import channel_film, gap_film
from lumped.machine.films import face_films, surroundings
from lumped.machine.laws import film_over
from lumped.machine.shapes import Gap
from lumped.transfer.properties import Fluid
from lumped.transfer.terms_value import temperature_value

PASCAL = 101325.0
SURFACE_OVER_FLUID = ((40.0, 0.0), (80.0, 40.0), (60.0, 60.0), (140.0, 60.0))  # degC


def dry_air(T):
    """CoolProp's (Lemmon et al. 2000) at T (degC). Loading it takes three seconds, which other tests do without."""
    PropsSI = pytest.importorskip("CoolProp.CoolProp").PropsSI
    rho, cp, k, mu = (PropsSI(x, "T", T + 273.15, "P", PASCAL, "Air") for x in ("D", "C", "L", "V"))
    return Fluid(rho, cp, k, mu, 1.0 / (T + 273.15))


def film(law, surface, fluid, **inputs):
    factor = np.asarray(law.factor({name: np.array([value]) for name, value in inputs.items()})).item()
    return factor * temperature_value(law.temperature, surface, fluid)


@pytest.mark.parametrize(("hot", "cold"), SURFACE_OVER_FLUID)
@pytest.mark.parametrize(("gap", "within"), [(0.002, 0.015), (0.001, 0.05)])
def test_the_air_gap(hot, cold, gap, within):
    """Full of vortices at all speeds; and narrow, so that they begin between these, earlier in cold air."""
    law, properties = gap_film(Gap(0.1, gap), 3000.0), dry_air(0.5 * (hot + cold))
    for rpm in (1000.0, 2000.0, 3000.0):
        exact = taylor_film(rpm * np.pi / 30, 0.1, gap, properties)[0]
        assert film(law, hot, cold, speed_rpm=rpm) == pytest.approx(exact, rel=within)


@pytest.mark.parametrize(("hot", "cold"), SURFACE_OVER_FLUID)
def test_a_duct(hot, cold):
    """At the usual flow and at a half of it, both turbulent."""
    law, properties = channel_film(Duct(1e-3, 0.2, 0.2), 1.0, 100.0), dry_air(0.5 * (hot + cold))
    for flow in (50.0, 100.0):
        exact = duct_film(flow / 3600 / 1e-3, 0.02, 0.2, properties)[0]
        assert film(law, hot, cold, fan_flow_m3h=flow) == pytest.approx(exact, rel=0.03)


@pytest.mark.parametrize(("hot", "cold"), SURFACE_OVER_FLUID)
def test_what_a_shaft_fan_blows_along_fins_and_over_a_plate(hot, cold):
    properties, speeds = dry_air(0.5 * (hot + cold)), np.linspace(0.0, 3000.0, 61).tolist()
    fins = film_over("speed_rpm", speeds, lambda n, T: heiles(n / 150, 0.02, 0.3, 1.7, dry_air(T))[0], 1500.0, 40.0)
    plate = film_over("speed_rpm", speeds, lambda n, T: flat_plate(n / 150, 0.2, dry_air(T))[0], 1500.0, 40.0)
    for rpm in (750.0, 1500.0):
        exact = heiles(rpm / 150, 0.02, 0.3, 1.7, properties)[0], flat_plate(rpm / 150, 0.2, properties)[0]
        assert film(fins, hot, cold, speed_rpm=rpm) == pytest.approx(exact[0], rel=0.01)
        assert film(plate, hot, cold, speed_rpm=rpm) == pytest.approx(exact[1], rel=0.01)


def test_a_shipped_machine_has_them():
    """Fins of a TEFC machine: a sixth less in air of 100 degC than in air of 20 degC, at the same speed."""
    laws = face_films("housing", "ambient", surroundings(load_machine("tefc-industrial"), ()))
    warm, cool = (film(laws["blown"], T, T, speed_rpm=1460.0) for T in (100.0, 20.0))
    assert 0.82 < warm / cool < 0.88
