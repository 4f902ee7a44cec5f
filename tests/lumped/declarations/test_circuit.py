"""Coolant circuits: exact balance, series and parallel, one- and two-sided, the closed loop, pressure and power."""

import sys

import ht
import numpy as np
import pytest
from numpy.testing import assert_allclose

from geom.errors import InputError, MissingDependency
from lumped.circuits.circuit import film_in
from lumped.circuits.hydraulics import Duct, friction, helical_friction, parallel_shares, pressure_drop
from lumped.declarations.circuit import read_circuits
from lumped.declarations.films import read_coolant
from lumped.declarations.network import read_network
from lumped.integration.steady import steady
from lumped.schemas.reader import Table
from lumped.transfer.coolant import coolant, glycol
from lumped.transfer.exchanger import counterflow, crossflow, parallel_flow
from lumped.transfer.properties import oil, water
from lumped.transfer.ranges import RangeWarning
from lumped.transfer.terms_value import coefficient

CHANNEL = {"wall": "housing", "width_mm": 20, "height_mm": 6, "length_m": 1.2, "bends": 2}
LOSS, LOSS_W = {"kind": "constant", "at": "housing", "P_W": 12420.0}, 12420.0


def network(circuit, closed=False, loss=LOSS_W):
    boundaries = ["ambient"] if closed else ["ambient", "inlet"]
    data = {
        "network": {"name": "jacket", "boundaries": boundaries},
        "nodes": {"housing": {"C_J_K": 20000.0}, "flange": {"C_J_K": 8000.0}},
        "links": {"h-f": {"between": ["housing", "flange"], "G_W_K": 5.0}},
        "losses": {"heat": {**LOSS, "P_W": loss}},
        "circuits": {"water": circuit},
    }
    return read_network(data)


def circuit(**more):
    return {
        "coolant": {"name": "ethylene glycol", "mass_percent": 50},
        "at_degC": 60.0,
        "flow_l_min": 8,
        "inlet": "inlet",
        "passes": [CHANNEL],
        **more,
    }


def closed(**more):
    loop = circuit(reservoir={"volume_l": 6.0, "UA_W_K": 333.0, "air": "ambient", "air_flow_m3_h": 2500}, **more)
    del loop["inlet"]
    return loop


def heat_rate(degC, flow=8.0):
    """m cp (W/K) of a flow (l/min) of glycol."""
    fluid = glycol("ethylene", 50)(degC)
    return flow / 60000 * fluid.rho * fluid.cp


HOT = glycol("ethylene", 50)(60.0)
MCP = heat_rate(60.0)


def test_one_pass_warms_the_coolant_by_25_6_K():
    """12.4 kW into 8 L/min of 50/50 glycol, as it is at 60 degC."""
    rest = steady(network(circuit(films="fixed")), {}, {"ambient": 20.0, "inlet": 20.0})
    assert rest["water.outlet"] - 20.0 == pytest.approx(LOSS_W / MCP, rel=1e-10)
    assert rest["water.outlet"] - 20.0 == pytest.approx(25.6, abs=0.1)


def test_cells_along_an_even_wall_are_the_exact_exponential():
    """A wall held at one temperature: (T_out - T_in) / (T_wall - T_in) = 1 - exp(-h A / m cp), whatever the cells."""
    for cells in (1, 4, 16):
        net = network(circuit(cells=cells, films="fixed"))
        made = read_circuits(
            Table({"circuits": {"water": circuit(cells=cells)}}, "t"), ["housing", "flange"], ["ambient", "inlet"]
        )
        duct = made["water"].branches["1"][0].duct
        N = film_in(duct, 8 / 60000, HOT)[0] * duct.wall / MCP
        rest = steady(net, {}, {"ambient": 20.0, "inlet": 20.0})
        share = (rest["water.outlet"] - 20.0) / (rest["housing"] - 20.0)
        assert N / cells < 1
        assert share == pytest.approx(-np.expm1(-N), rel=1e-9)


@pytest.mark.parametrize(("flow", "inlet"), [(0.5, -30.0), (4.0, 20.0), (32.0, 60.0)])
@pytest.mark.parametrize("more", [{}, {"coil_diameter_mm": 250.0}], ids=["straight", "coil"])
def test_at_another_flow_and_temperature_the_wall_is_as_warm_as_by_the_correlation(flow, inlet, more):
    """Of a channel declared at 60 degC and 8 l/min: what leaves T_w - (T_w - T_in) exp(-N), N by Gnielinski or Schmidt
    at the logarithmic mean of the coolant, at a loss that warms it by 10 K. Its heat capacity is the one of then: per
    volume 10 % less at -30 degC than at 60."""
    duct, rate = Duct(0.02, 0.006, 1.2, 2, 1e-3 * more.get("coil_diameter_mm", 0.0)), heat_rate(inlet + 5.0, flow)
    data = circuit(flow_l_min_input="flow_l_min", passes=[{**CHANNEL, **more}])
    net = network(data, loss=10.0 * rate)
    found = steady(net, {"flow_l_min": flow}, {"ambient": 20.0, "inlet": inlet})
    middle = inlet + 5.0
    for _ in range(20):
        N = film_in(duct, flow / 60000, glycol("ethylene", 50)(middle))[0] * duct.wall / rate
        wall = inlet + 10.0 / -np.expm1(-N)
        middle = wall - 10.0 / N
    assert found["water.outlet"] == pytest.approx(inlet + 10.0, abs=0.03)
    assert found["housing"] - middle == pytest.approx(wall - middle, rel=0.02)


@pytest.mark.parametrize("inlet", [-20.0, 80.0])
def test_branches_share_the_flow_as_their_pressures_ask_for_at_any_flow_and_temperature(inlet):
    """A short channel and a long coil; their shares sum to 1, and the circuit carries all heat that comes in."""
    two = [{**CHANNEL, "branch": "a"}, {**CHANNEL, "branch": "b", "length_m": 4.0, "coil_diameter_mm": 250.0}]
    net = network(circuit(flow_l_min_input="flow_l_min", passes=two))
    ducts = [[Duct(0.02, 0.006, 1.2, 2)], [Duct(0.02, 0.006, 4.0, 2, 0.25)]]
    streams = [x.law for x in net.links if x.name.startswith("stream:water.")]
    for flow in (1.0, 8.0, 30.0):
        at = {"flow_l_min": np.array([flow])}
        got = [coefficient(law, at, inlet, 0.0) / heat_rate(inlet, flow) for law in streams]
        assert_allclose(got, parallel_shares(ducts, flow / 60000, glycol("ethylene", 50)(inlet)), rtol=5e-3)
        assert sum(got) == pytest.approx(1.0, rel=1e-5)
    rest = steady(net, {"flow_l_min": 3.0}, {"ambient": 20.0, "inlet": inlet})
    middle = next(x.hot for x in net.links if x.name == "stream:water.a").at(rest.z)
    taken = sum(coefficient(law, {"flow_l_min": np.array([3.0])}, middle, 0.0) for law in streams)
    assert taken * (rest["water.outlet"] - inlet) == pytest.approx(LOSS_W, rel=1e-9)


def test_a_coolant_that_freezes_and_a_flow_beyond_the_correlation_say_so():
    net = network(circuit(flow_l_min_input="flow_l_min"))
    with pytest.warns(RangeWarning, match=r"stream:water: its coolant at -5\d.* degC outside -3[56][.\d]* to"):
        steady(net, {"flow_l_min": 30.0}, {"ambient": 20.0, "inlet": -60.0})
    with pytest.warns(RangeWarning, match=r"duct_film: flow_l_min = 1e\+05 at 6\d.* degC outside 0 to \d"):
        steady(net, {"flow_l_min": 1e5}, {"ambient": 20.0, "inlet": 60.0})


def test_oil_that_is_too_cold_for_its_film_says_so():
    """Below 14 degC its Prandtl number is above 2000."""
    pytest.importorskip("CoolProp")
    net = network(circuit(coolant="oil", flow_l_min=60.0))
    with pytest.warns(RangeWarning, match=r"its coolant at \d[.\d]* degC outside 1[34][.\d]* to 160 \(duct_film\)"):
        steady(net, {}, {"ambient": 20.0, "inlet": 5.0})


def test_water_under_pressure_is_liquid_above_100_degC():
    """At 3 bar up to 133 degC, by IAPWS; without a pressure what boils is said."""
    hot = network(circuit(coolant={"name": "water", "pressure_bar": 3.0}))
    rest = steady(hot, {}, {"ambient": 20.0, "inlet": 110.0})
    mean = water(0.5 * (rest["water.outlet"] + 110.0), 3.0)
    assert LOSS_W / (rest["water.outlet"] - 110.0) == pytest.approx(mean.rho * mean.cp * 8.0 / 6e4, rel=2e-3)
    with pytest.warns(RangeWarning, match=r"its coolant at 1\d\d.* degC outside 0 to 100"):
        steady(network(circuit(coolant="water")), {}, {"ambient": 20.0, "inlet": 110.0})


def test_series_passes_heat_the_second_wall_with_what_the_first_gave():
    both = circuit(passes=[CHANNEL, {**CHANNEL, "wall": "flange"}], films="fixed")
    rest = steady(network(both), {}, {"ambient": 20.0, "inlet": 20.0})
    assert rest["housing"] > rest["flange"] > 25.0
    assert rest["water.outlet"] - 20.0 == pytest.approx(LOSS_W / MCP, rel=1e-9)


def test_two_sides_cool_better_than_one():
    """The same channel wetting the flange as well draws heat there; the housing gives its half."""
    one = steady(network(circuit()), {}, {"ambient": 20.0, "inlet": 20.0})
    both = network(circuit(passes=[{**CHANNEL, "wall": {"housing": 0.5, "flange": 0.5}}]))
    two = steady(both, {}, {"ambient": 20.0, "inlet": 20.0})
    assert two["housing"] > one["housing"]
    assert two["flange"] < one["flange"]
    assert two["water.outlet"] == pytest.approx(one["water.outlet"], rel=1e-3)


def test_equal_branches_share_alike_and_long_ones_get_less():
    fluid, short, long = water(40.0), Duct(0.02, 0.006, 1.0), Duct(0.02, 0.006, 4.0)
    assert_allclose(parallel_shares([[short], [short]], 2e-4, fluid), [0.5, 0.5], rtol=1e-9)
    a, b = parallel_shares([[short], [long]], 2e-4, fluid)
    assert a > b
    assert pressure_drop(short, a * 2e-4, fluid) == pytest.approx(pressure_drop(long, b * 2e-4, fluid), rel=1e-6)


@pytest.mark.parametrize(
    ("ours", "name"), [(counterflow, "counterflow"), (parallel_flow, "parallel"), (crossflow, "crossflow approximate")]
)
def test_effectiveness_against_the_library(ours, name):
    for N in (0.1, 1.0, 4.0):
        for ratio in (0.2, 0.7, 0.999):
            expected = ht.effectiveness_from_NTU(NTU=N, Cr=ratio, subtype=name)
            assert ours(np.array([N]), np.array([ratio]))[0] == pytest.approx(expected, rel=1e-6)


def test_effectiveness_at_even_rates_has_no_jump():
    N = np.array([2.0])
    assert counterflow(N, np.array([1.0]))[0] == pytest.approx(counterflow(N, np.array([1 - 2e-6]))[0], rel=1e-5)


def test_pressure_in_developed_laminar_flow_is_poiseuille():
    """Long channel, Re 64: dp = 64/Re L/D rho v^2/2 plus 1.57 velocity heads."""
    fluid, duct = water(20.0), Duct(0.01, 0.01, 10.0)
    speed = 64 * fluid.nu / duct.diameter
    expected = (duct.length / duct.diameter + 0.57 + 1.0) * 0.5 * fluid.rho * speed**2
    assert pressure_drop(duct, speed * duct.section, fluid) == pytest.approx(expected, rel=1e-9)


def test_friction_at_1e5_is_the_moody_value_and_has_no_jump():
    """Smooth pipe, Re 1e5: 0.0180 (Moody 1944)."""
    assert friction(1e5) == pytest.approx(0.0180, rel=5e-3)
    for law in (lambda Re: friction(Re), lambda Re: helical_friction(Re, 0.009, 0.3)):
        Re = np.linspace(500, 20000, 8001)
        drop = np.array([law(r) * r * r for r in Re])
        assert np.all(np.diff(drop) > 0)
        assert (np.diff(drop) / drop[1:]).max() < 0.02


def test_oil_is_a_mineral_oil():
    """Incropera et al. 2007, table A.5 at 310 and 350 K: rho 878, 854; cp 1951, 2118; k 0.145, 0.138; all but viscosity
    are alike among mineral oils, within 10 %. Viscosity falls with temperature, by more than half every 25 K."""
    pytest.importorskip("CoolProp")
    for kelvin, rho, cp, k in ((310, 877.9, 1951.0, 0.145), (350, 853.9, 2118.0, 0.138)):
        fluid = coolant("oil")(kelvin - 273.15)
        assert (fluid.rho, fluid.cp, fluid.k) == pytest.approx((rho, cp, k), rel=0.1)
        assert fluid.beta == pytest.approx(7e-4, rel=0.2)
    assert coolant("oil")(65.0).nu < 0.5 * coolant("oil")(40.0).nu < 0.25 * coolant("oil")(15.0).nu
    with pytest.raises(InputError, match="oil"):
        coolant("oil")(900.0)


def test_an_oil_by_its_data_sheet_is_that_oil():
    """Texatherm 22 of CoolProp, of which only its viscosities at 40 and 100 degC and its density at 15 are said."""
    pytest.importorskip("CoolProp")
    sheet = {
        "viscosity_40C_mm2_s": 1e6 * oil(40.0).nu,
        "viscosity_100C_mm2_s": 1e6 * oil(100.0).nu,
        "density_15C_kg_m3": oil(15.0).rho,
    }
    said = read_coolant(Table({"coolant": {"name": "oil", **sheet}}, "test"))
    for T in (20.0, 40.0, 60.0, 80.0, 100.0, 120.0):
        mine, tabled = said(T), oil(T)
        assert (mine.rho, mine.cp, mine.k) == pytest.approx((tabled.rho, tabled.cp, tabled.k), rel=0.003)
        assert mine.nu == pytest.approx(tabled.nu, rel=0.015)
        assert mine.beta == pytest.approx(-(np.log(said(T + 0.1).rho / said(T - 0.1).rho)) / 0.2, rel=1e-3)
    for wrong, words in (
        ({"viscosity_40C_mm2_s": 5.0, "viscosity_100C_mm2_s": 6.0}, "falls with temperature"),
        ({"name": "water"}, "data sheet"),
        ({"density_15C_kg_m3": 0.85}, "500 to 1500"),
    ):
        with pytest.raises(InputError, match=words):
            read_coolant(Table({"coolant": {"name": "oil", **sheet, **wrong}}, "test"))


def test_ATF_needs_no_package_and_has_the_viscosities_of_its_data_sheet():
    fluid = coolant("ATF")
    assert (1e6 * fluid(40.0).nu, 1e6 * fluid(100.0).nu) == pytest.approx((29.0, 6.5), rel=1e-12)
    assert fluid(15.0).rho == pytest.approx(845.0)
    with pytest.raises(InputError, match="-20 to 160 degC"):
        fluid(-30.0)


def test_oil_without_its_package_is_one_message(monkeypatch):
    monkeypatch.setitem(sys.modules, "CoolProp.CoolProp", None)
    oil.cache_clear()
    with pytest.raises(MissingDependency, match=r"pip install 'thermoscope\[oil\]'"):
        coolant("oil")(40.0)


def test_a_share_by_volume_is_another_mixture_than_by_mass():
    mass, volume = glycol("ethylene", 50)(20.0), glycol("ethylene", volume_percent=50)(20.0)
    assert volume.rho > mass.rho
    with pytest.raises(InputError, match="mass_percent or volume_percent"):
        glycol("ethylene")
    with pytest.raises(InputError, match="only for"):
        coolant("water", mass_percent=10.0)


SLIPS = {
    "share not stated": ({"coolant": "ethylene glycol"}, "mass_percent or volume_percent"),
    "unknown wall": ({"passes": [{**CHANNEL, "wall": "hosing"}]}, "hosing.*did you mean 'housing'"),
    "too many walls": ({"passes": [{**CHANNEL, "wall": {"housing": 0.8, "flange": 0.8}}]}, "sum to 1.6"),
}


@pytest.mark.parametrize(("slip", "message"), SLIPS.values(), ids=SLIPS)
def test_slips_are_named(slip, message):
    with pytest.raises(InputError, match=message):
        network(circuit(**slip))
