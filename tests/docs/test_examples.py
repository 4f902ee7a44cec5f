"""The examples run as they stand, and what they compute agrees with what they compare it to."""

import runpy
import sys

import numpy as np
import pytest
from example_references import REFERENCE

TOLERANCE = {
    "one_node": ("error_K", 1e-2),
    "residuals": ("error_K", 1e-9),
    "machine": ("error", 1e-9),
    "live_bench": ("error", 0.5),
}
WRITES = {
    "one_node": [],
    "residuals": ["residuals-1.png", "residuals-2.png", "parity.html"],
    "machine": ["machine.svg"],
    "live_bench": ["live-odds.png"],
}
LONG = {"residuals", "fan_for_a_while"}  # which calibrate a measured case, and diagnose
TESTED_ELSEWHERE = {"hust", "tclab"}


@pytest.mark.parametrize("name", [pytest.param(n, marks=[pytest.mark.nightly] if n in LONG else []) for n in TOLERANCE])
def test_example(name, root, tmp_path, monkeypatch):
    """one_node: a step of the integrator may be wrong by 10 mK, of 30 K here; live_bench: 0 for the right name.

    The others are the same sums.
    """
    monkeypatch.setattr(sys, "argv", [name, str(tmp_path)])
    left = runpy.run_path(str(root / "examples" / f"{name}.py"))
    key, tolerance = TOLERANCE[name]
    assert abs(left[key]) < tolerance
    assert all((tmp_path / file).stat().st_size > 1000 for file in WRITES[name])


@pytest.mark.parametrize("name", [pytest.param(n, marks=[pytest.mark.nightly] if n in LONG else []) for n in REFERENCE])
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
