"""The material table and the homogenised winding."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from geom import InputError, material, material_table, winding_conductivity


@pytest.mark.parametrize("name", material_table())
def test_material_is_physical_and_says_where_it_comes_from(name):
    found = material(name)
    assert 0.02 < found.k_plane < 450
    assert 0.02 < found.k_axial < 450
    assert 100 < found.rho < 10_000
    assert 100 < found.cp < 4500
    assert 0 < found.emissivity < 1
    assert 0 < found.spread <= 0.5
    assert len(found.source) > 10


def test_unknown_material_lists_the_known():
    with pytest.raises(InputError, match="steel"):
        material("cheese")


@given(st.floats(0.0, 0.95))
def test_bundle_lies_between_series_and_parallel(fill):
    across, along = winding_conductivity(fill, 385.0, 0.2)
    assert 1 / (fill / 385.0 + (1 - fill) / 0.2) <= across * (1 + 1e-12)
    assert across <= along * (1 + 1e-12)


def test_dilute_wires_follow_maxwell_and_rayleigh():
    """Well conducting dilute cylinders raise the conductivity by 1 + 2 v (Rayleigh 1892)."""
    across, _ = winding_conductivity(1e-4, 1e9, 0.2)
    assert across / 0.2 - 1 == pytest.approx(2e-4, rel=1e-3)


def test_laminations_conduct_along_their_sheets():
    steel = material("electrical-steel")
    assert steel.k_plane > 10 * steel.k_axial
