"""Oil in circuits by hand: nozzles and bores as passes, rotor ends in a coolant; balances, regimes, ranges, slips."""

import numpy as np
import pytest

from geom.errors import InputError
from lumped.circuits.circuit import film_in
from lumped.circuits.hydraulics import Bore, Nozzles
from lumped.correlations.oil import sprayed_face
from lumped.correlations.rotating import levich_disc, rotating_shaft
from lumped.declarations.network import read_network
from lumped.integration.balance import balance
from lumped.integration.simulate import Record
from lumped.integration.steady import steady
from lumped.transfer.coolant import coolant
from lumped.transfer.ranges import RangeWarning
from lumped.transfer.terms_value import coefficient

ATF = coolant("ATF")
REAR = {"wall": "rear", "branch": "rear", "nozzles": 8, "nozzle_mm": 1.5, "area_m2": 0.03, "run_mm": 60}
FRONT = {**REAR, "wall": "front", "branch": "front"}


def oiled(*passes, links=(), **more):
    spray = {"coolant": "ATF", "at_degC": 80, "flow_l_min": 5, "flow_l_min_input": "flow", "inlet": "oil", "cells": 2}
    data = {
        "network": {"name": "oiled", "boundaries": ["oil"]},
        "nodes": {"rear": {"C_J_K": 900.0}, "front": {"C_J_K": 900.0}},
        "links": {"both": {"between": ["rear", "front"], "G_W_K": 5.0}, **dict(links)},
        "losses": {"heat": {"kind": "constant", "at": {"rear": 0.5, "front": 0.5}, "P_W": 1500.0}},
        "circuits": {"spray": {**spray, "passes": list(passes), **more}},
    }
    return read_network(data)


@pytest.fixture(scope="module")
def net():
    return oiled(REAR, FRONT)


def test_heat_into_the_oil_is_what_it_carries_off(net):
    time = np.arange(0.0, 1800.0, 5.0)
    run = balance(
        net, Record(time, {"flow": 5.0 + 2.0 * np.sin(time / 100)}, {"oil": 70 + 5 * np.sin(time / 300)}, 70.0)
    )
    assert np.abs(run.residual).max() < 5e-5
    rest = steady(net, {"flow": 5.0}, {"oil": 70.0})
    middle = ATF(70.0 + 0.5 * (rest["spray.outlet"] - 70.0))
    rise = rest["spray.outlet"] - 70.0
    assert 5 / 6e4 * middle.rho * middle.cp * rise == pytest.approx(1500.0, rel=2e-3)


@pytest.mark.parametrize(("flow", "T"), [(2.0, 100.0), (8.0, 60.0)])
def test_the_film_follows_flow_and_temperature_together(net, flow, T):
    """Onto what leaves one of two cells: (e^N - 1) / N of the correlation, called directly."""
    (link,) = [x for x in net.links if x.name == "film:spray.rear.1:rear"]
    q, fluid = 0.5 * flow / 6e4, ATF(T)
    h = sprayed_face(q, 8, 1.5e-3, 0.03, 0.06, fluid)[0]
    N = h * 0.015 / (q * fluid.rho * fluid.cp)
    onto = coefficient(link.law, {"flow": np.array([flow])}, T, 0.0)
    assert onto == pytest.approx(0.015 * h * np.expm1(N) / N, rel=5e-3)


def test_oil_too_cold_for_its_jets_says_so_with_value_and_range(net):
    with pytest.warns(RangeWarning, match=r"sprayed_face: flow = 3 at \S+ degC outside \S+ to"):
        steady(net, {"flow": 3.0}, {"oil": 20.0})


def test_a_bore_is_a_round_duct_and_drips_have_no_jets():
    h, info = film_in(Bore(0.012, 0.2), 2 / 6e4, ATF(80.0))
    Re = 4 * (2 / 6e4) / (np.pi * 0.012 * ATF(80.0).nu)
    X = 0.012 / 0.2 * Re * ATF(80.0).Pr
    assert info.numbers["Re"] == pytest.approx(Re)
    assert h == pytest.approx((3.66 + 0.065 * X / (1 + 0.04 * X ** (2 / 3))) * ATF(80.0).k / 0.012)
    dripping = Nozzles(8, 1.5e-3, 0.03, 0.06, drip=True)
    assert film_in(dripping, 2.5 / 6e4, ATF(80.0))[0] < film_in(Nozzles(8, 1.5e-3, 0.03, 0.06), 2.5 / 6e4, ATF(80.0))[0]


@pytest.mark.parametrize("surface", ["disc", "shaft"])
def test_a_rotor_end_in_oil_has_the_film_of_the_oil_at_its_own_temperature(surface):
    table = {"surface": surface, "diameter_mm": 140, "coolant": "ATF", "speed": "rpm", "up_to_rpm": 12000}
    link = {"between": ["rear", "oil"], "area_m2": 0.02, "rotating": table}
    (law,) = [x.law for x in oiled(REAR, FRONT, links={"end": link}.items()).links if x.name == "link:end:rotating"]
    for T in (60.0, 90.0):
        turns = 3000 * np.pi / 30
        direct = levich_disc(turns, 0.07, ATF(T)) if surface == "disc" else rotating_shaft(turns, 0.14, ATF(T))
        assert coefficient(law, {"rpm": np.array([3000.0])}, T, 0.0) == pytest.approx(direct[0], rel=3e-3)


@pytest.mark.parametrize(
    ("slip", "words"),
    [
        ({"nozzles": 0}, "nozzles = 0"),
        ({"nozzles": 2.5}, "whole number"),
        ({"area_m2": None}, "area_m2"),
        ({"width_mm": 20}, "unknown key 'width_mm'"),
        ({"drip": "yes"}, "true or false"),
    ],
)
def test_a_slip_is_one_message(slip, words):
    wrong = {key: value for key, value in {**REAR, **slip}.items() if value is not None}
    with pytest.raises(InputError, match=words):
        oiled(wrong, FRONT)
