"""AC loss of layers of bars: Dowell's sum, its limits, the diffusion equation solved for each layer, temperature."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geom.errors import InputError
from lumped.declarations.loss_tables import loss_laws
from lumped.schemas.reader import Table
from lumped.sources.layer_loss import MU_0, RESISTIVITY, by_dowell, dowell, from_map
from lumped.sources.loss_laws import CopperLoss
from lumped.transfer.terms_value import coefficient

COPPER = CopperLoss(0.01, ("current_A",), 3.0)
HEIGHT, SHARE, POLE_PAIRS = 2.9e-3, 0.8, 4


def total(x, layers):
    """Dowell 1966, equation 10, as textbooks print it."""
    skin = (np.sinh(2 * x) + np.sin(2 * x)) / (np.cosh(2 * x) - np.cos(2 * x))
    return x * (skin + 2 * (layers**2 - 1) / 3 * (np.sinh(x) - np.sin(x)) / (np.cosh(x) + np.cos(x)))


def diffusion(x, layer, cells=2000):
    """AC over DC loss of a layer from H'' = 2j x^2 H, height and current 1, H = m - 1 and m at its faces."""
    z = np.linspace(0.0, 1.0, cells + 1)
    d = 1.0 / cells
    main = np.full(cells - 1, -2.0 / d**2 - 2j * x**2)
    matrix = np.diag(main) + np.diag(np.full(cells - 2, 1 / d**2), 1) + np.diag(np.full(cells - 2, 1 / d**2), -1)
    right = np.zeros(cells - 1, complex)
    right[0], right[-1] = -(layer - 1) / d**2, -layer / d**2
    H = np.concatenate([[layer - 1], np.linalg.solve(matrix, right), [layer]])
    return float(np.sum(np.abs(np.diff(H) / d) ** 2) * (z[1] - z[0]))


@pytest.mark.parametrize("layers", [1, 6])
def test_layers_add_up_to_dowells_total(layers):
    x = np.array([0.05, 0.3, 1.0, 2.0, 5.0, 15.0])
    mean = np.mean([dowell(x, m) for m in range(1, layers + 1)], axis=0)
    assert_allclose(mean, total(x, layers), rtol=1e-12)


@pytest.mark.parametrize(("layer", "x"), [(1, 3.0), (3, 0.4), (6, 1.3)])
def test_a_layer_is_the_diffusion_equation_solved(layer, x):
    assert dowell(x, layer) == pytest.approx(diffusion(x, layer, 400), rel=1e-3)  # 400 cells, second order: 5e-5 x^2


def test_low_frequency_is_direct_current_and_adds_as_the_fourth_power():
    """x^4 (4/45 + m (m - 1)/3): the series of both quotients."""
    for m in (1, 2, 6):
        assert dowell(0.05, m) - 1.0 == pytest.approx(0.05**4 * (4 / 45 + m * (m - 1) / 3), rel=2e-3)


@pytest.mark.parametrize(("speed", "T"), [(300.0, 95.0), (2730.0, -40.0), (16000.0, 180.0)])
def test_the_law_follows_speed_and_its_own_temperature(speed, T):
    """Within 0.3 % of the whole: what straight lines leave between 200 sizes and 19 temperatures."""
    resistivity = RESISTIVITY * (1.0 + COPPER.alpha * (T - 20.0))
    x = HEIGHT * np.sqrt(np.pi * POLE_PAIRS * speed / 60 * MU_0 * SHARE / resistivity)
    law, inputs = (
        by_dowell(COPPER, "speed_rpm", POLE_PAIRS, HEIGHT, SHARE, 6),
        {"current_A": np.array([100.0]), "speed_rpm": np.array([speed])},
    )
    copper = coefficient(COPPER, inputs, T, 0.0)
    assert copper + coefficient(law, inputs, T, 0.0) == pytest.approx(copper * float(dowell(x, 6)), rel=3e-3)


def test_a_map_of_dowells_factors_is_dowell():
    law = by_dowell(COPPER, "speed_rpm", POLE_PAIRS, HEIGHT, SHARE, 5)
    speeds = np.linspace(0.0, 16000.0, 81)
    x = HEIGHT * np.sqrt(np.pi * POLE_PAIRS * speeds[1:] / 60 * MU_0 * SHARE / RESISTIVITY)
    mapped = from_map(COPPER, "speed_rpm", speeds.tolist(), [1.0, *dowell(x, 5)])
    for T, speed in ((20.0, 5100.0), (150.0, 14000.0)):
        inputs = {"current_A": np.array([100.0]), "speed_rpm": np.array([speed])}
        assert coefficient(mapped, inputs, T, 0.0) == pytest.approx(coefficient(law, inputs, T, 0.0), rel=0.01)


FAULTS = {
    "no rise": ({"at_speed": [0, 0], "factors": [1, 2]}, "at_speed rising"),
    "one short": ({"at_speed": [0, 10], "factors": [1]}, "one factor per speed"),
    "no bars": ({"pole_pairs": 4}, "bar_height_mm"),
    "nothing": ({}, "coefficients"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_faults_are_one_message(fault):
    ac, words = FAULTS[fault]
    table = {"kind": "copper", "currents": ["I"], "R20_ohm": 0.1, "ac": {"input": "speed_rpm", **ac}}
    with pytest.raises(InputError, match=words) as caught:
        loss_laws({"copper": Table(table, "net.toml [losses.copper]")})
    assert "[losses.copper] ac" in str(caught.value)
