"""Wires in resin: the unit cell against the exact lattice sums, and the formula where it holds."""

import pytest

from fem.matrices.material import Conductivity
from fem.matrices.winding import HEXAGONAL, SQUARE, bundle, flat_cell, homogenised, unit_cell
from geom.description.materials import filled, material, winding_conductivity
from geom.errors import InputError

COPPER, RESIN = 400.0, 0.2


def perrins(f, ratio, sides):
    """Perrins, McKenzie, McPhedran 1979, Proc. R. Soc. A 369, 207, eq. 14: conductivity over the matrix's.

    Truncated lattice sums: good to 1e-4 up to f = 0.75 (hexagonal) and 0.5 (square).
    """
    T = (1 + ratio) / (1 - ratio)
    a, b, c, m = (0.075422, 1.060283, 0.000076, 6) if sides == 6 else (0.305827, 1.402958, 0.013362, 4)
    return 1 - 2 * f / (T + f - a * T * f**m / (T * T - b * f ** (2 * m)) - c * f ** (2 * m) / T)


@pytest.mark.parametrize(("fill", "ratio"), [(0.2, 0.1), (0.65, 5.0), (0.75, 2000.0)])
def test_hexagonal_cell_is_exact(fill, ratio):
    assert unit_cell([(fill, ratio)], 1.0) == pytest.approx(perrins(fill, ratio, 6), rel=1e-4)


def test_square_cell_is_exact():
    assert unit_cell([(0.5, 50.0)], 1.0, SQUARE) == pytest.approx(perrins(0.5, 50.0, 4), rel=1e-4)


def test_cell_converges():
    """A fine mesh moves the result by less than 1e-3, even at a fill of 85 %."""
    coarse, fine = (unit_cell([(0.85, COPPER)], RESIN, HEXAGONAL, n, m) for n, m in ((16, 8), (32, 16)))
    assert coarse == pytest.approx(fine, rel=1e-3)


@pytest.mark.parametrize(("fill", "off"), [(0.3, 0.001), (0.6, 0.007)])
def test_formula_holds_below_65_percent(fill, off):
    formula = winding_conductivity(fill, COPPER, RESIN)[0]
    assert formula == pytest.approx(unit_cell([(fill, COPPER)], RESIN), rel=off)


def test_formula_is_a_lower_bound_that_fails_at_high_fill():
    for packing in (HEXAGONAL, SQUARE):
        for fill in (0.7, 0.75):
            assert unit_cell([(fill, COPPER)], RESIN, packing) > 1.02 * winding_conductivity(fill, COPPER, RESIN)[0]


def test_bundle_takes_formula_or_cell():
    low, high = bundle(0.6, COPPER, RESIN), bundle(0.8, COPPER, RESIN)
    assert low.k_r == winding_conductivity(0.6, COPPER, RESIN)[0]
    assert high.k_r == unit_cell([(0.8, COPPER)], RESIN)
    assert (low.k_z, high.k_z) == pytest.approx((0.6 * COPPER + 0.4 * RESIN, 0.8 * COPPER + 0.2 * RESIN))


def test_enamel_counts():
    """Enamel as good as the resin changes nothing; air between enamelled wires is far worse than resin."""
    assert bundle(0.7, COPPER, RESIN, 0.08, RESIN).k_r == pytest.approx(bundle(0.7, COPPER, RESIN).k_r, rel=1e-4)
    assert bundle(0.6, COPPER, 0.026, 0.08, 0.2).k_r < 0.5 * bundle(0.6, COPPER, RESIN, 0.08, 0.2).k_r


def test_isotropic_across():
    """A cell of resin in resin conducts like resin, whatever the packing."""
    for packing in (HEXAGONAL, SQUARE):
        assert unit_cell([(0.5, 3.0)], 3.0, packing) == pytest.approx(3.0, rel=1e-12)


@pytest.mark.parametrize(("packing", "fill"), [(HEXAGONAL, 0.91), (SQUARE, 0.79)])
def test_wires_that_overlap_are_refused(packing, fill):
    with pytest.raises(InputError, match="packing"):
        unit_cell([(fill, COPPER)], RESIN, packing)


@pytest.mark.parametrize("fill", [0.3, 0.95])
def test_flat_cell_obeys_the_law_of_exchange(fill):
    """Keller 1964, J. Math. Phys. 5, 548: conductor and resin exchanged, k k' = k_conductor k_resin."""
    exchanged = flat_cell(fill, COPPER, RESIN) * flat_cell(fill, RESIN, COPPER)
    assert exchanged == pytest.approx(COPPER * RESIN, rel=2e-4)


def test_windings_of_the_table_take_their_cell_above_65_percent():
    """Round wires hexagonal, flat ones square; up to 65 % the numbers of the materials table."""
    low, field = material("winding"), material("field-winding").mixture
    assert homogenised(low.mixture) == Conductivity(low.k_plane, low.k_plane, low.k_axial)
    assert homogenised(field).k_r == flat_cell(0.7, 385.0, 0.25)
    dense = homogenised(filled("winding", 0.75, 1.0).mixture)
    assert dense.k_r == pytest.approx(0.2 * perrins(0.75, 385.0 / 0.2, 6), rel=1e-4)
    assert dense.k_r > 1.04 * filled("winding", 0.75, 1.0).k_plane
