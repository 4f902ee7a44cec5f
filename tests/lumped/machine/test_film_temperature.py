"""Forced films of a motor at any film temperature, against the correlations with properties of another library."""

import numpy as np
import pytest

from geom import load_machine
from geom.description.geometry import Duct
from lumped.correlations.air_gap import taylor_film
from lumped.correlations.ducts import duct_film
from lumped.correlations.forced import flat_plate
from lumped.machine.air import channel_film, gap_film
from lumped.machine.films import face_films, surroundings
from lumped.machine.outer import cowl_of
from lumped.machine.shapes import Gap, extent
from lumped.transfer.properties import Fluid
from lumped.transfer.terms_value import coefficient

PASCAL = 101325.0
SURFACE_OVER_FLUID = ((40.0, 0.0), (140.0, 60.0))  # degC


def dry_air(T):
    """CoolProp's (Lemmon et al. 2000) at T (degC). Loading it takes three seconds, which other tests do without."""
    PropsSI = pytest.importorskip("CoolProp.CoolProp").PropsSI
    rho, cp, k, mu = (PropsSI(x, "T", T + 273.15, "P", PASCAL, "Air") for x in ("D", "C", "L", "V"))
    return Fluid(rho, cp, k, mu, 1.0 / (T + 273.15))


def film(law, surface, fluid, **inputs):
    return coefficient(law, {name: np.array([value]) for name, value in inputs.items()}, surface, fluid)


@pytest.mark.parametrize(("hot", "cold"), SURFACE_OVER_FLUID)
@pytest.mark.parametrize("gap", [0.002, 0.001])
def test_the_air_gap(hot, cold, gap):
    """Full of vortices at all speeds; and narrow, so that they begin between, earlier in cold air; at rest."""
    law, properties = gap_film(Gap(0.1, gap), 3000.0), dry_air(0.5 * (hot + cold))
    for rpm in (0.0, 300.0, 1000.0, 2000.0, 3000.0, 9000.0):
        exact = taylor_film(rpm * np.pi / 30, 0.1, gap, properties)[0]
        assert film(law, hot, cold, speed_rpm=rpm) == pytest.approx(exact, rel=0.015)


@pytest.mark.parametrize(("hot", "cold"), SURFACE_OVER_FLUID)
def test_a_duct(hot, cold):
    """From laminar flow through the transition to four times the usual flow."""
    law, properties = channel_film(Duct(1e-3, 0.2, 0.2), lambda *_: 1.0, 100.0), dry_air(0.5 * (hot + cold))
    for flow in (1.0, 5.0, 10.0, 50.0, 100.0, 400.0, 1000.0):
        exact = duct_film(flow / 3600 / 1e-3, 0.02, 0.2, properties)[0]
        assert film(law, hot, cold, fan_flow_m3h=flow) == pytest.approx(exact, rel=0.015)


@pytest.mark.parametrize(("hot", "cold"), SURFACE_OVER_FLUID)
def test_what_a_shaft_fan_blows_over_a_shield_beside_still_air(hot, cold):
    """Both are one film, the cube root of the sum of cubes (Churchill 1977): never their sum."""
    laws = face_films("endcap.left", "ambient", surroundings(load_machine("tefc-industrial"), ()))
    machine, properties = load_machine("tefc-industrial"), dry_air(0.5 * (hot + cold))
    cowl, high = cowl_of(machine), extent(machine.part("endcap.left")).size[1]
    share = cowl.rear_share if cowl.rear == "left" else cowl.front_share
    still = film(laws["natural"], hot, cold)
    for rpm in (0.0, 300.0, 1460.0, 6000.0):
        blown = flat_plate(share * cowl.air_speed * rpm / cowl.at_rpm, high, properties)[0]
        whole = still + film(laws["blown"], hot, cold, speed_rpm=rpm)
        assert whole == pytest.approx((blown**3 + still**3) ** (1 / 3), rel=0.015)
