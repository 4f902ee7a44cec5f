"""The examples run as they stand, and what they compute agrees with what they compare it to."""

import runpy
import sys

import numpy as np
import pytest

TOLERANCE = {"one_node": ("error_K", 1e-2), "residuals": ("error_K", 1e-9), "machine": ("error", 1e-9)}
WRITES = {
    "one_node": [],
    "residuals": ["residuals-1.png", "residuals-2.png", "parity.html"],
    "machine": ["machine.svg"],
}
# What `computed` may differ from `expected` by, and why.
REFERENCE = {
    "slab": 1.0,  # s of 610: zeta is tabulated to four digits (0.1 s), forty cells err by 1/12/40^2 (0.1 s); air 0.5 s
    "hollow_cylinder": 1e-6,  # K: the circuit is exact for the mean
    "jacket": 0.15,  # K: half of a cell's transfer units, 0.005, of what is left of 50 K times 0.6
    "shaft_fan": 0.01,  # K of 50: Radau is exact to 1e-6, the tool's steps keep to a few mK
    "copper_feedback": 1e-6,  # K: Newton's method to rounding
    "duty_cycle": 0.01,  # K of 70: steps of the integrator
    "radiation": 3.6,  # s of 3600: a thousandth, the tool's time steps
    "two_bodies": 0.01,  # K of 80: steps of the integrator
    "own_effect": 1e-6,  # K: linear
    "fin": 2e-4,  # of 0.79: the mean of forty cells errs by (mL)^2 / (4 N^2) = 1.3e-4 at most
    "composite_wall": 1e-6,  # K: resistances in series are exact
    "generation": 1e-6,  # K: the sum over the layers is exact
    "semi_infinite": 0.08,  # K of 80: cells of 2.5 mm in a front of 65 mm err by (1/26)^2 of it at most
    "periodic": 0.01,  # K of 20: steps of the integrator
    "two_blocks": 0.01,  # K of 130: steps of the integrator; the wire takes 1e-6 of the joint's heat
    "free_convection": 0.01,  # K of 100: steps of the integrator
    "short_time_duty": 0.05,  # s of 518: the curve is nearly straight within a sample of 1 s
    "delta_star": 1e-6,  # K: both are exact
    "iron_loss": 1e-6,  # W: linear
    "reciprocity": 1e-12,  # K/W of 0.1: rounding
    "locked_rotor": 1e-3,  # s of 23: the curve is nearly straight within a sample of 0.1 s
    "ramp": 0.01,  # K of 30: what a step of the integrator may be wrong by
    "switched_fan": 0.016,  # K: an input is straight between samples, so the fan starts 0.5 s early; it takes 0.03 K/s
    "thermal_wave": 0.1,  # K of 30: what is left of the start, and the first cell, a tenth of d, by (1/10)^2 / 12 of 30
    "fan_for_a_while": 10.0,  # s: two samples
    "superposition": 0.01,  # K of 57: steps of the integrator
    "field_of_a_ring": 0.1,  # K of 110: 144 chords for a circle and twelve linear cells across
    "gap_laws": 1e-9,  # W/m2/K: conduction, exactly
    "rotor_friction": 1e-6,  # K: linear
    "pressed_and_grey": 1e-6,  # K, W/m2, 1: closed forms
    "duct_shapes": 5e-3,  # of Nu: the polynomial of the table, printed to four digits
}
LONG = {"residuals"}  # a measured case, calibrated
TESTED_ELSEWHERE = {"hust", "tclab"}


@pytest.mark.parametrize("name", [pytest.param(n, marks=[pytest.mark.heavy] if n in LONG else []) for n in TOLERANCE])
def test_example(name, root, tmp_path, monkeypatch):
    """one_node: a step of the integrator may be wrong by 10 mK, of 30 K here; the others are the same sums."""
    monkeypatch.setattr(sys, "argv", [name, str(tmp_path)])
    left = runpy.run_path(str(root / "examples" / f"{name}.py"))
    key, tolerance = TOLERANCE[name]
    assert abs(left[key]) < tolerance
    assert all((tmp_path / file).stat().st_size > 1000 for file in WRITES[name])


@pytest.mark.parametrize("name", REFERENCE)
def test_example_against_its_reference(name, root):
    left = runpy.run_path(str(root / "examples" / f"{name}.py"))
    assert np.shape(left["computed"]) == np.shape(left["expected"])
    assert np.abs(left["computed"] - left["expected"]).max() < REFERENCE[name]


def test_runaway_is_said(root):
    assert runpy.run_path(str(root / "examples" / "copper_feedback.py"))["runaway"]


def test_own_effect_is_placed_where_it_says(root):
    assert runpy.run_path(str(root / "examples" / "own_effect.py"))["places"] == ["housing"]


def test_no_example_is_forgotten(root):
    assert {p.stem for p in (root / "examples").glob("*.py")} == {*TOLERANCE, *REFERENCE, *TESTED_ELSEWHERE}
