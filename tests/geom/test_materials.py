"""The material table and the homogenised winding."""

import pytest
from hypothesis import given, strategies as st

from geom import InputError, material, material_table, winding_conductivity
from geom.description.materials import CONDUCTOR, K_AIR, filled, read_entry, with_properties
from geom.machine_file import machine_from

VALUES = {"k_plane", "k_axial", "rho", "cp", "emissivity"}


@pytest.mark.parametrize("name", material_table())
def test_material_is_physical_and_says_where_it_comes_from(name):
    found = material(name)
    assert 0.02 < found.k_plane < 450
    assert 0.02 < found.k_axial < 450
    assert 100 < found.rho < 10_000
    assert 100 < found.cp < 4500
    assert 0 < found.emissivity < 1
    assert set(found.spreads) == set(found.sources) == VALUES
    for value in VALUES:
        assert 0 < found.spreads[value] <= 0.6
        assert len(found.sources[value]) >= 7
    assert (found.spread, found.source) == (found.spreads["k_plane"], found.sources["k_plane"])


@given(st.floats(0.0, 0.95))
def test_bundle_lies_between_series_and_parallel(fill):
    across, along = winding_conductivity(fill, 385.0, 0.2)
    assert 1 / (fill / 385.0 + (1 - fill) / 0.2) <= across * (1 + 1e-12)
    assert across <= along * (1 + 1e-12)


def test_dilute_wires_follow_maxwell_and_rayleigh():
    """Well conducting dilute cylinders raise the conductivity by 1 + 2 v (Rayleigh 1892)."""
    across, _ = winding_conductivity(1e-4, 1e9, 0.2)
    assert across / 0.2 - 1 == pytest.approx(2e-4, rel=1e-3)


def with_winding(**winding):
    return machine_from({"machine": {"family": "pmsm"}, "geometry": {"winding": winding}})


def test_more_copper_conducts_and_weighs_more():
    loose, tight = (with_winding(fill=fill).material_of("winding") for fill in (0.3, 0.6))
    assert loose.k_plane < tight.k_plane
    assert loose.k_axial == pytest.approx(0.3 * 385.0 + 0.7 * 0.2)
    assert tight.rho == pytest.approx(0.6 * 8930.0 + 0.4 * 1350.0)


@given(st.floats(0.0, 1.0))
def test_air_between_wires_lowers_the_conductivity_down_to_that_of_air(impregnation):
    found = with_winding(impregnation=impregnation).material_of("winding")
    dry, full = (winding_conductivity(0.45, 385.0, k)[0] for k in (K_AIR, 0.2))
    assert dry * (1 - 1e-9) <= found.k_plane <= full * (1 + 1e-9)


OWN = {"like": "steel", "k": 43.0, "rho": 7800, "source": "data sheet"}
WRONG = {
    "a word for a number": ({"k": "much"}, ["k = much", "0.005 to 2500"]),
    "not a number": ({"cp": float("nan")}, ["cp = nan", "50 to 6000"]),
    "a key nobody knows": ({"lambda": 1.0}, ["lambda", "k_plane"]),
    "a material nobody knows": ({"like": "cheese"}, ["cheese", "steel"]),
}


def with_housing(entry, part="housing"):
    return machine_from({"machine": {"family": "tefc"}, "materials": {part: entry}}, "own.toml")


def test_own_values_stand_in_place_of_those_of_the_table():
    found, usual = with_housing(OWN).material_of("housing"), material("steel")
    assert (found.k_plane, found.k_axial, found.rho) == (43.0, 43.0, 7800.0)
    assert (found.cp, found.emissivity, found.spreads) == (usual.cp, usual.emissivity, usual.spreads)
    assert found.sources == usual.sources | dict.fromkeys(("k_plane", "k_axial", "rho"), "data sheet")


def test_without_like_the_rest_is_the_usual_of_the_part():
    machine, usual = with_housing({"k_axial": 99.0}), machine_from({"machine": {"family": "tefc"}})
    assert machine.part("housing").material == usual.part("housing").material
    assert machine.material_of("housing").k_axial == 99.0
    assert machine.material_of("housing").k_plane == usual.material_of("housing").k_plane


@pytest.mark.parametrize("case", WRONG)
def test_wrong_own_values_are_one_message(case):
    entry, words = WRONG[case]
    with pytest.raises(InputError) as caught:
        with_housing(entry)
    for word in ("own.toml [materials] housing", *words):
        assert word in str(caught.value)


def test_values_of_a_winding_are_refused():
    """They follow from fill and impregnation; another material by name is fine."""
    with pytest.raises(InputError, match="fill and impregnation"):
        with_housing({"k": 2.0}, "winding")
    assert with_housing({"like": "copper", "k": 390.0}, "winding").material_of("winding").k_axial == 390.0


def test_a_winding_has_the_conductor_of_its_file():
    """By volume, as in its closed forms: of copper only what is conductor changes, resin and fill stay."""
    usual, (name, properties) = (
        filled("winding", 0.4, 1.0),
        read_entry({"k_conductor": 220, "rho_conductor": 2700}, "winding", ""),
    )
    light = with_properties(usual, properties)
    assert name == "winding"
    assert light.rho == pytest.approx(0.4 * 2700 + 0.6 * 1350)
    assert light.rho * light.cp == pytest.approx(0.4 * 2700 * 390 + 0.6 * 1350 * 1500)
    across, along = winding_conductivity(0.4, 220.0, usual.mixture.k_between)
    assert (light.k_plane, light.k_axial) == pytest.approx(
        (across, light.mixture.along * along + (1 - light.mixture.along) * across)
    )
    copper = tuple((key, value, "") for key, value in CONDUCTOR.items())
    same = with_properties(usual, copper)
    assert (same.k_plane, same.rho, same.cp) == pytest.approx((usual.k_plane, usual.rho, usual.cp))


@pytest.mark.parametrize(
    ("entry", "usual", "words"),
    [({"k_conductor": 400}, "steel", "unknown key"), ({"rho": 8900}, "winding", "rho of a winding")],
)
def test_values_of_conductors_are_those_of_windings(entry, usual, words):
    with pytest.raises(InputError, match=words):
        read_entry(entry, usual, "[materials] part")
