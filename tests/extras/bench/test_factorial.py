"""Designs and effects: closed forms, a textbook experiment, and the published screening."""

import numpy as np
import pytest

from extras.bench.factors.factorial import Factor, Varied, effects, fractional, full, lenth, morris, sobol
from extras.bench.factors.screening import RESPONSES, TABLE_I, WITH_GAP, screen, varied
from extras.bench.reduction.pm_network import bundle, filled
from geom import load_machine
from geom.errors import InputError

ABC = tuple(Factor(c, c.lower(), -1, 1) for c in "ABC")


def test_full_design_is_orthogonal():
    signs = full(TABLE_I).signs
    assert signs.shape == (128, 7)
    assert np.array_equal(signs.T @ signs, 128 * np.eye(7))
    assert len(np.unique(signs, axis=0)) == 128


def test_effects_are_twice_the_coefficients():
    """y = 10 + 3 A - 2 B + 0.5 A C: effects 6, -4, and 1 for AC, the others 0."""
    design = full(ABC)
    A, B, C = design.signs.T
    found = effects(design, 10 + 3 * A - 2 * B + 0.5 * A * C).effects
    assert found == pytest.approx({"A": 6, "B": -4, "C": 0, "AB": 0, "AC": 1, "BC": 0})


def test_lenth_by_hand():
    """Contrasts 1..6 and one of 40: s0 = 1.5 x 4; those below 2.5 s0 have median 3.5. Lenth's table for 7 contrasts."""
    error, margin, simultaneous = lenth(np.array([1.0, -2, 3, 4, 5, -6, 40]))
    assert error == pytest.approx(1.5 * 3.5)
    assert margin == pytest.approx(3.764 * error, rel=1e-3)
    assert simultaneous == pytest.approx(9.008 * error, rel=1e-3)


def test_filtration_rate_of_the_textbooks():
    """Montgomery's pilot plant, 2^4: A, C, D, AC and AD are beyond the margin of error 6.75; PSE is 2.625."""
    rates = [45, 71, 48, 65, 68, 60, 80, 65, 43, 100, 45, 104, 75, 86, 70, 96]
    found = effects(full([Factor(c, c, 0, 1) for c in "ABCD"]), rates, order=4)
    assert found.effects["A"] == pytest.approx(21.625)
    assert found.effects["AC"] == pytest.approx(-18.125)
    assert {e for e, value in found.ranked if abs(value) > found.margin} == {"A", "C", "D", "AC", "AD"}
    assert [found.PSE, found.margin, found.simultaneous] == pytest.approx([2.625, 6.748, 13.699], abs=2e-3)
    assert set(found.active) == {"A", "D", "AC", "AD"}


def test_fraction_and_its_aliases():
    """2^(7-1) with G = ABCDEF is of resolution VII; 2^(5-2) with D = AB, E = AC mixes D with AB."""
    half = fractional(TABLE_I, {"G": "ABCDEF"})
    assert (len(half.signs), half.resolution) == (64, 7)
    assert half.aliases("A") == ()
    quarter = fractional([Factor(c, c, 0, 1) for c in "ABCDE"], {"D": "AB", "E": "AC"})
    assert quarter.resolution == 3
    assert quarter.aliases("D") == ("AB",)
    assert "AB" not in effects(quarter, np.arange(8.0)).effects
    with pytest.raises(InputError, match="products of ABCDEF"):
        fractional(TABLE_I, {"G": "ABG"})


@pytest.fixture(scope="module")
def published():
    return screen(load_machine("pmsm-m1"), full(TABLE_I))


def test_published_screening(published):
    """128 runs, 4 responses: convection, emissivity and base lead at the magnets; more magnetic loss warms them."""
    assert published.rises.shape == (128, len(RESPONSES))
    magnets = published.effects["magnets"]
    assert {letters for letters, _ in magnets.ranked[:3]} == {"A", "B", "C"}
    assert {"A", "B", "C", "G"} <= set(magnets.active)
    assert magnets.effects["A"] < 0 < magnets.effects["C"]
    assert magnets.effects["G"] > 0


def test_impregnation_sets_the_step_from_winding_to_magnets(published):
    step = published.effects["winding minus magnets"]
    assert step.ranked[0][0] == "D"
    assert abs(step.effects["D"]) > 3 * abs(step.ranked[1][1])


@pytest.fixture(scope="module")
def with_gap():
    return screen(load_machine("pmsm-m1"), full(WITH_GAP))


@pytest.mark.parametrize("response", ["winding minus magnets", "R_w (mK/W)"])
def test_impregnation_and_liner_gap_set_the_step(with_gap, response):
    """The paper's conclusion: with the gap of table II as an eighth factor the two lead, before films and base.

    The bath fills the gap too, so a wider gap counts for more where little resin is (D H below zero).
    """
    step = with_gap.effects[response]
    assert [letters for letters, _ in step.ranked if len(letters) == 1][:2] == ["D", "H"]
    assert step.effects["D"] < 0 < step.effects["H"]
    assert "DH" in step.active
    assert step.effects["DH"] < 0


def test_voids_between_air_and_resin():
    """Hashin and Shtrikman's bound meets both ends; a bundle in resin alone is that of the closed form."""
    assert filled(0.0, 0.2) == pytest.approx(0.026)
    assert filled(1.0, 0.2) == 0.2
    assert filled(1.0 - 1e-9, 0.2) == pytest.approx(0.2)
    assert bundle(0.45, 0.2, 1.0) == pytest.approx(0.2 * (1.45 * 385 + 0.55 * 0.2) / (0.55 * 385 + 1.45 * 0.2))


def test_half_fraction_ranks_alike():
    """64 of the 128 runs lead to the same three factors."""
    found = screen(load_machine("pmsm-m1"), fractional(TABLE_I, {"G": "ABCDEF"})).effects["magnets"]
    assert {letters for letters, _ in found.ranked[:3]} == {"A", "B", "C"}


def test_sobol_of_ishigami():
    """The function of Ishigami and Homma 1990: ST = 0.5576, 0.4424, 0.2437 (closed form, a = 7, b = 0.1)."""
    factors = [Varied(n, -np.pi, np.pi) for n in "xyz"]
    found = sobol(
        factors, lambda v: np.sin(v["x"]) + 7 * np.sin(v["y"]) ** 2 + 0.1 * v["z"] ** 4 * np.sin(v["x"]), 1024
    )
    assert [found.measure[n] for n in "xyz"] == pytest.approx([0.5576, 0.4424, 0.2437], abs=0.05)


def test_sobol_says_the_same_twice():
    """Its intervals come from resampling: from the same draws every time."""
    once, again = (sobol([Varied("a", 0, 1), Varied("b", 0, 1)], lambda v: v["a"] + 2 * v["b"], 64) for _ in range(2))
    assert once == again


def test_morris_of_a_line():
    """Elementary effects of a linear function are its slopes times the range, without spread."""
    factors = [Varied("a", 0.0, 2.0), Varied("b", 0.0, 1.0), Varied("c", 0.0, 1.0)]
    found = morris(factors, lambda v: 3 * v["a"] - 5 * v["b"])
    assert found.ranked[:2] == ["a", "b"]
    assert found.measure["a"] == pytest.approx(6.0)
    assert found.measure["b"] == pytest.approx(5.0)
    assert found.spread["a"] == pytest.approx(0.0, abs=1e-9)
    assert found.measure["c"] == 0.0


def test_correlated_factors_are_judged_together():
    """Two factors of which only the sum counts: as a group they hold what is theirs, 2/3 of the variance."""
    factors = [Varied("a", 0, 1, "films"), Varied("b", 0, 1, "films"), Varied("c", 0, 1)]
    found = sobol(factors, lambda v: v["a"] + v["b"] + v["c"], 256)
    assert found.measure == pytest.approx({"films": 2 / 3, "c": 1 / 3}, abs=0.05)
    assert morris(factors, lambda v: v["a"] + v["b"]).ranked[0] == "films"
    with pytest.raises(InputError, match="low below high"):
        sobol([Varied("a", 1.0, 0.0)], lambda v: 0.0)


def test_morris_ranks_as_the_factorial():
    """Films and base lead at the magnets, voids and gap in the slot at the path from winding to magnets."""
    factors, responses = varied(load_machine("pmsm-m1"))
    magnets = morris(factors, responses["magnets"], trajectories=6)
    step = morris(factors, responses["R_w (mK/W)"], trajectories=6)
    assert set(magnets.ranked[:3]) == {"convection", "emissivity", "base"}
    assert step.ranked[:2] == ["impregnation", "liner gap"]
