"""Films of known surfaces in network.toml are the correlations they name, and every one of them can be declared."""

import pickle
import re
import warnings
from functools import partial

import ht
import numpy as np
import pytest
from fluids import ATMOSPHERE_1976
from jsonschema import Draft202012Validator

from geom.errors import InputError
from lumped.correlations import RangeWarning, air_gap, contacts, ducts, end_space, fins, forced, natural, rotating
from lumped.declarations.films import moving_surfaces, still_surfaces
from lumped.declarations.network import read_network
from lumped.integration.simulate import Record, simulate
from lumped.integration.steady import steady
from lumped.schemas.schema import schema
from lumped.transfer.properties import air, water
from lumped.transfer.terms_value import coefficient

pytestmark = pytest.mark.filterwarnings("ignore::lumped.correlations.RangeWarning")
AREA = 0.4

STILL = {
    "horizontal cylinder": ({"size_m": 0.3}, lambda T: natural.churchill_chu_cylinder(0.3, T, 20.0)),
    "vertical plate": ({"size_m": 0.3}, lambda T: natural.churchill_chu_plate(0.3, T, 20.0)),
    "plate facing up": ({"size_m": 0.1}, lambda T: natural.mcadams_plate(0.1, T, 20.0)),
    "plate facing down": ({"size_m": 0.1}, lambda T: natural.mcadams_plate(0.1, T, 20.0, upward=False)),
    "vertical cylinder": ({"size_m": 0.3, "diameter_mm": 30.0}, lambda T: natural.popiel_cylinder(0.3, 0.03, T, 20.0)),
    "vertical fins": (
        {"size_m": 0.25, "depth_mm": 20.0, "spacing_mm": 10.0},
        lambda T: fins.van_de_pol_tierney(0.02, 0.01, 0.25, T, 20.0),
    ),
    "horizontal fins": ({"spacing_mm": 12.0}, lambda T: fins.jones_smith(0.012, T, 20.0)),
    "parallel plates": ({"size_m": 0.2, "spacing_mm": 10.0}, lambda T: fins.elenbaas(0.01, 0.2, T, 20.0)),
}
MOVING = {
    "plate": ({"size_m": 0.5}, lambda v, fluid: forced.flat_plate(v, 0.5, fluid)),
    "cylinder": ({"size_m": 0.3}, lambda v, fluid: forced.churchill_bernstein(v, 0.3, fluid)),
    "fin channel": (
        {"size_m": 0.25, "diameter_mm": 20.0, "speed_at_end": 0.2},
        lambda v, fluid: fins.heiles_decaying(v, 0.02, 0.25, partial(fins.straight_decay, 0.2), fluid=fluid),
    ),
    "duct": ({"size_m": 0.3, "diameter_mm": 20.0}, lambda v, fluid: ducts.duct_film(v, 0.02, 0.3, fluid)),
    "helical pipe": (
        {"diameter_mm": 9.0, "coil_diameter_mm": 200.0},
        lambda v, fluid: ducts.schmidt_helical(v, 0.009, 0.2, fluid),
    ),
    "end space": ({}, lambda v, fluid: end_space.end_space(v)),
}


def document(mechanism, keys):
    return {
        "network": {"name": "n", "boundaries": ["ambient"]},
        "nodes": {"a": {"C_J_K": 900.0}},
        "links": {"out": {"between": ["a", "ambient"], "area_m2": AREA, mechanism: keys}},
        "losses": {"heat": {"kind": "constant", "at": "a", "P_W": 100.0}},
    }


def declared(mechanism, keys):
    data = document(mechanism, keys)
    assert list(Draft202012Validator(schema("network")).iter_errors(data)) == []
    return pickle.loads(pickle.dumps(read_network(data)))


def test_every_surface_has_a_case_here():
    assert set(STILL) == set(still_surfaces())
    assert set(MOVING) == set(moving_surfaces())


@pytest.mark.parametrize("surface", STILL)
def test_in_still_air_a_node_rests_where_the_correlation_says(surface):
    """At rest h A (T - 20) is the loss; 0.3 % for the table between its points (0.1 % for a quarter power)."""
    keys, film = STILL[surface]
    T = steady(declared("natural", {"surface": surface, **keys}), {}, {"ambient": 20.0})["a"]
    assert film(T)[0] * AREA * (T - 20.0) == pytest.approx(100.0, rel=3e-3)


@pytest.mark.parametrize("degC", [-30.0, 110.0])
@pytest.mark.parametrize("shape", ["vertical plate", "horizontal cylinder"])
def test_still_air_has_the_properties_of_its_film_temperature(shape, degC):
    """Against ht with the air of fluids at (surface + air) / 2; air of 60 degC cools 5 to 7 % less than that of 20."""
    T = steady(declared("natural", {"surface": shape, "size_m": 0.3}), {}, {"ambient": degC})["a"]
    film = 0.5 * (T + degC) + 273.15
    k, mu = ATMOSPHERE_1976.thermal_conductivity(film), ATMOSPHERE_1976.viscosity(film)
    rho = 101325.0 * 28.9644e-3 / (8.31432 * film)
    Pr, Gr = 1005.7 * mu / k, 9.80665 / film * (T - degC) * 0.3**3 * (rho / mu) ** 2
    Nu = {
        "vertical plate": ht.Nu_vertical_plate_Churchill,
        "horizontal cylinder": ht.Nu_horizontal_cylinder_Churchill_Chu,
    }
    assert Nu[shape](Pr, Gr) * k / 0.3 * AREA * (T - degC) == pytest.approx(100.0, rel=3e-3)


def at_film_temperature(network, inputs, degC, film, within=3e-3):
    """A node rests where the film says, with the air of the mean of surface and air; 0.3 % for the table."""
    T = steady(network, inputs, {"ambient": degC})["a"]
    assert film(air(0.5 * (T + degC)))[0] * AREA * (T - degC) == pytest.approx(100.0, rel=within)


@pytest.mark.parametrize("degC", [-10.0, 100.0])
@pytest.mark.parametrize("surface", ["plate", "duct"])
def test_the_edge_of_a_regime_is_where_the_correlation_has_it(surface, degC):
    """A plate's boundary layer turns turbulent at 11 to 25 m/s in air of -10 to 100 degC, a duct of 20 mm at 2 m/s."""
    keys, film = MOVING[surface]
    network = declared("forced", {"surface": surface, "speed": "v"} | keys)
    for v in (1.6, 2.0, 2.5, 3.5, 12.0, 16.0, 20.0, 25.0):
        at_film_temperature(network, {"v": v}, degC, lambda fluid, v=v: film(v, fluid))


@pytest.mark.parametrize("surface", ["plate", "duct"])
def test_declared_properties_of_moving_air_hold(surface):
    keys, film = MOVING[surface]
    declared_air = {"surface": surface, "speed": "v", "fluid_degC": 40.0}
    network = declared("forced", declared_air | keys)
    for v in (2.0, 8.0, 20.0):
        T = steady(network, {"v": v}, {"ambient": 80.0})["a"]
        assert film(v, air(40.0))[0] * AREA * (T - 80.0) == pytest.approx(100.0, rel=3e-3)


@pytest.mark.parametrize("degC", [-10.0, 100.0])
@pytest.mark.parametrize("law", ["taylor", "becker-kaye"])
def test_through_the_gap_the_whole_film_counts(law, degC):
    """Still, and full of vortices."""
    network = declared("gap", {"rotor_radius_mm": 80.0, "gap_mm": 0.7, "law": law})
    film = {"taylor": air_gap.taylor_film, "becker-kaye": air_gap.becker_kaye}[law]
    walls = 0.5 if law == "taylor" else 1.0
    for rpm in (0.0, 9000.0, 15000.0):
        turned = partial(film, rpm * np.pi / 30, 0.08, 0.7e-3)
        at_film_temperature(network, {"speed_rpm": rpm}, degC, lambda x, of=turned: (walls * of(x)[0],))


@pytest.mark.parametrize("degC", [-10.0, 100.0])
@pytest.mark.parametrize(
    ("surface", "film"),
    [
        ("disc", lambda w, x: rotating.rotating_disc(w, 0.1, x)),
        ("shaft", lambda w, x: rotating.rotating_shaft(w, 0.2, x)),
    ],
)
def test_what_turns_in_open_air(surface, film, degC):
    network = declared("rotating", {"surface": surface, "diameter_mm": 200.0})
    for rpm in (500.0, 1500.0, 12000.0):
        at_film_temperature(network, {"speed_rpm": rpm}, degC, lambda x, w=rpm * np.pi / 30: film(w, x))


@pytest.mark.parametrize("degC", [20.0, 80.0])
def test_a_liquid_in_a_channel_has_the_properties_of_its_own_temperature(degC):
    """Water, turbulent throughout: as Gnielinski asks for, whatever the wall's temperature."""
    keys = {"surface": "duct", "size_m": 0.5, "diameter_mm": 10.0, "speed": "v", "coolant": "water", "up_to_m_s": 4.0}
    network = declared("forced", keys)
    for v in (1.0, 2.0, 4.0):
        T = steady(network, {"v": v}, {"ambient": degC})["a"]
        h = ducts.duct_film(v, 0.01, 0.5, water(degC))[0]
        assert h * AREA * (T - degC) == pytest.approx(100.0, rel=0.02)


MIXTURES = {
    ("vertical plate", "plate"): (natural.churchill_chu_plate, forced.flat_plate, 3.0),
    ("horizontal cylinder", "cylinder"): (natural.churchill_chu_cylinder, forced.churchill_bernstein, 4.0),
}


@pytest.mark.parametrize("degC", [20.0, 60.0])
@pytest.mark.parametrize("pair", MIXTURES, ids=" ".join)
def test_still_and_moving_air_mix_by_churchill(pair, degC):
    """(h_f^n + h_n^n)^(1/n), from still air through 0.1 < Gr/Re^2 < 10 to wind; 0.3 % for the table."""
    still, moving, n = MIXTURES[pair]
    keys = {"natural": {"surface": pair[0], "size_m": 0.3}, "exponent": n}
    keys["forced"] = {"surface": pair[1], "size_m": 0.3, "speed": "v", "up_to_m_s": 20.0}
    network = declared("mixed", keys)
    assert len(network.links) == 2  # still air, and what moving air adds to it
    for v in (0.0, 0.2, 0.5, 1.0, 2.0, 6.0, 20.0):
        T = steady(network, {"v": v}, {"ambient": degC})["a"]
        blown = moving(v, 0.3, air(0.5 * (T + degC)))[0]
        h = (still(0.3, T, degC)[0] ** n + blown**n) ** (1 / n)
        assert h * AREA * (T - degC) == pytest.approx(100.0, rel=3e-3)


def test_a_mixture_has_one_multiplier_and_warns_once():
    keys = {"natural": {"surface": "vertical plate", "size_m": 0.3}}
    keys["forced"] = {"surface": "plate", "size_m": 0.3, "speed": "v", "up_to_m_s": 20.0}
    data = document("mixed", keys)
    data["links"]["out"]["prior_sd"] = 0.2
    network = read_network(data)
    (parameter,) = network.parameters
    assert {name for name, _ in parameter.targets} == {link.name for link in network.links}
    with pytest.warns(RangeWarning, match="v = 8000 at .* degC outside 0 to") as said:
        simulate(network, Record(np.arange(3.0), {"v": 8000.0}, {"ambient": 20.0}))
    assert len(said) == 1


@pytest.mark.parametrize(
    ("keys", "h"),
    [
        ({"gap_mm": 0.037}, contacts.gap_film(0.037e-3)),
        ({"joint": "lamination - metal, average"}, contacts.gap_film(0.03e-3)),
        ({"pair": "copper - copper"}, np.sqrt(10000.0 * 25000.0)),
    ],
)
def test_a_joint_is_its_gap_or_its_pair(keys, h):
    T = steady(declared("contact", keys), {}, {"ambient": 20.0})["a"]
    assert pytest.approx(100.0 / (h * AREA), rel=1e-9) == T - 20.0


def test_thin_air_cools_less():
    low, high = (
        declared("natural", {"surface": "vertical plate", "size_m": 0.3, "altitude_m": m}) for m in (0.0, 3000.0)
    )
    assert steady(high, {}, {"ambient": 20.0})["a"] > steady(low, {}, {"ambient": 20.0})["a"] + 2.0


@pytest.mark.parametrize("surface", MOVING)
def test_anywhere_on_the_map_it_is_the_correlation(surface):
    """0 to three times the largest speed that is expected, -40 to 150 degC, at 2,500 m; all of it in
    benchmarks/operating_points.py."""
    keys, film = MOVING[surface]
    data = {"surface": surface, "speed": "v", "up_to_m_s": 20.0, "altitude_m": 2500.0}
    law = declared("forced", data | keys).links[0].law
    for v, hot, cold in np.random.default_rng(48).uniform((0.0, -40.0, -40.0), (60.0, 150.0, 80.0), (20, 3)):
        h = film(v, air(0.5 * (hot + cold), altitude_m=2500.0))[0]
        assert coefficient(law, {"v": np.array([v])}, hot, cold) == pytest.approx(h, rel=3e-3)


def test_faster_than_expected_is_the_correlation_and_beyond_its_range_warns():
    """Up to a Reynolds number of 1e8."""
    network = declared("forced", {"surface": "plate", "speed": "v", "size_m": 0.5, "up_to_m_s": 10.0})
    at_film_temperature(network, {"v": 200.0}, 20.0, lambda fluid: forced.flat_plate(200.0, 0.5, fluid))
    with pytest.warns(RangeWarning, match=r"v = 5000 at .* degC outside 0 to \d+"):
        simulate(network, Record(np.arange(3.0), {"v": 5000.0}, {"ambient": 20.0}))


@pytest.mark.parametrize(
    ("mechanism", "keys", "message"),
    [
        ("natural", {"surface": "vertical fins", "size_m": 0.2, "depth_mm": 20.0}, "spacing_mm"),
        ("natural", {"surface": "sphere"}, "'sphere'.*vertical fins"),
        ("forced", {"surface": "plate", "size_m": 0.5}, "'speed' is missing"),
        ("contact", {"joint": "glue"}, "'glue'.*known"),
        ("mixed", {"natural": {"surface": "vertical plate", "size_m": 0.2}}, "mixed forced.*'surface' is missing"),
    ],
)
def test_slips_are_named(mechanism, keys, message):
    with pytest.raises(InputError, match=message):
        read_network(document(mechanism, keys))


@pytest.mark.parametrize(
    ("watts", "ambient", "said"),
    [
        (60.0, 20.0, []),
        (60.0, -80.0, [r"its film at -80 degC outside -60 to 200"]),
        (4000.0, 20.0, [r"\d+ K beside its air outside 0 to 300", r"its film at [\d.]+ degC outside -60 to 200"]),
    ],
)
def test_still_air_beyond_its_table_is_said(watts, ambient, said):
    """Too cold, too hot, and too far above the air; where properties are declared, the last alone."""
    data = document("natural", {"surface": "vertical plate", "size_m": 0.3})
    data["losses"]["heat"]["P_W"] = watts
    for fixed in (False, True):
        if fixed:
            data["links"]["out"]["natural"]["fluid_degC"] = 20.0
        record = Record(np.linspace(0.0, 5e4, 200), {}, {"ambient": ambient}, ambient)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            simulate(read_network(data), record)
        words = sorted({str(w.message) for w in caught})
        assert len(words) == len(kept := [x for x in said if not (fixed and "film" in x)])
        assert all(re.search(pattern, word) for pattern, word in zip(kept, words, strict=True))


@pytest.mark.parametrize(
    ("size", "watts", "said"),
    [
        (0.005, 100.0, r"mcadams_plate: Ra = \d\d\d.* outside 10000 to 1e\+11"),
        (0.05, 0.2, r"mcadams_plate: [\d.]+ K beside its air outside 0\.\d+ to 300"),
        (0.05, 100.0, ""),
    ],
)
def test_still_air_outside_its_correlation_is_said_once(size, watts, said):
    """A size for which it never holds, and a rise that stays too small: one that begins at none is not meant."""
    data = document("natural", {"surface": "plate facing up", "size_m": size})
    data["losses"]["heat"]["P_W"] = watts
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", RangeWarning)
        simulate(read_network(data), Record(np.linspace(0.0, 5e4, 20), {}, {"ambient": 20.0}, 20.0))
    assert [bool(re.search(said, str(w.message))) for w in caught] == [True] * bool(said)


def test_a_shaft_fan_blows_over_a_face_that_stands():
    """h = 40 W/m2/K at 1460 1/min, with n^0.8, backwards as forwards; at rest nothing but what else is declared."""
    network = declared("fan", {"h_W_m2K": 40.0, "at_rpm": 1460.0})
    for rpm in (730.0, 1460.0, -2920.0):
        T = steady(network, {"speed_rpm": rpm}, {"ambient": 20.0})["a"]
        assert 40.0 * (abs(rpm) / 1460.0) ** 0.8 * AREA * (T - 20.0) == pytest.approx(100.0, rel=1e-9)
    with pytest.raises(InputError, match=r"exponent = 1\.4"):
        read_network(document("fan", {"h_W_m2K": 40.0, "at_rpm": 1460.0, "exponent": 1.4}))
