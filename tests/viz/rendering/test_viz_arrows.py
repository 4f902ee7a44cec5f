"""Heat flux against closed forms."""

import numpy as np
import pytest
from PIL import Image
from small_motor import motor

from fem.matrices.material import Conductivity, isotropic
from geom.errors import InputError
from viz import flux_arrows, heat_flux, split
from viz.machine.arrows import on_faces
from viz.machine.parts import exploded
from viz.rendering.cut import QUARTER

NODES = split(motor(24))
GRADIENT = np.array([30.0, -20.0, 55.0])
LINEAR = NODES.points @ GRADIENT + 40.0


def test_flux_of_a_linear_field_is_exact():
    k = dict.fromkeys(NODES.parts, isotropic(50.0))
    np.testing.assert_allclose(
        heat_flux(NODES, LINEAR, k), np.broadcast_to(-50.0 * GRADIENT, (len(NODES.tets), 3)), rtol=1e-9
    )


def test_laminations_carry_less_along_the_shaft():
    k = dict.fromkeys(NODES.parts, Conductivity(30.0, 30.0, 2.0))
    np.testing.assert_allclose(heat_flux(NODES, LINEAR, k)[7], -GRADIENT * [30.0, 30.0, 2.0], rtol=1e-9)


def test_arrows_lie_in_the_cut_faces():
    flux = np.broadcast_to(-50.0 * GRADIENT, (len(NODES.tets), 3))
    at, arrows = on_faces(NODES, flux, QUARTER)
    for edge in QUARTER.edges():
        normal = np.cross(edge, [0.0, 0.0, 1.0])
        mine = np.abs(at @ normal) < 1e-12
        assert mine.sum() > 20
    off = np.minimum(*(np.abs(at @ np.cross(e, [0.0, 0.0, 1.0])) for e in QUARTER.edges()))
    assert off.max() < 1e-12
    np.testing.assert_allclose(arrows[:, 2], -50.0 * GRADIENT[2])


def test_the_picture_has_arrows_and_says_how_much(tmp_path):
    hot = 40.0 + 60.0 * np.exp(-(((np.hypot(*NODES.points[:, :2].T) - 0.1) / 0.06) ** 2))
    p = flux_arrows(NODES, hot, dict.fromkeys(NODES.parts, isotropic(50.0)), png=tmp_path / "a.png")
    assert "kW/m²" in p.actors["headline"].GetInput()
    low, high = p.scalar_bars["°C"].GetLookupTable().GetRange()
    assert low <= hot.min() < hot.max() <= high  # between whole degrees, no further out than that
    assert (low % 1, high % 1) == (0.0, 0.0)
    assert high - low < np.ptp(hot) + 2.0
    p.close()
    dark = np.asarray(Image.open(tmp_path / "a.png").convert("L")) < 60
    assert 0.002 < dark.mean() < 0.2


def test_colours_are_of_the_range_that_is_asked_for():
    """Of the case, wider than the one field that is shown."""
    hot, k = np.linspace(20.0, 60.0, NODES.size), dict.fromkeys(NODES.parts, isotropic(50.0))
    for p in (flux_arrows(NODES, hot, k, limits=(0.0, 100.0)), exploded(NODES, hot, limits=(0.0, 100.0))):
        assert p.scalar_bars["°C"].GetLookupTable().GetRange() == (0.0, 100.0)
        p.close()


def test_a_part_without_conductivity_is_named():
    with pytest.raises(InputError, match="no conductivity for shaft"):
        heat_flux(NODES, LINEAR, {p: isotropic(1.0) for p in NODES.parts if p != "shaft"})
