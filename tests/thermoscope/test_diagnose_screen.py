"""What `diagnose` shows at 80 columns: sizes with intervals and detection limits, never folded, whatever the unit."""

import pytest

from thermoscope.commands.explain.diagnose import _candidates, _leader
from thermoscope.console.answer import LINES, Answer, lay_out


def candidate(effect, unit, probability=0.99, decision="named", limit=14.14):
    return {
        "effect": effect, "probability": probability, "decision": decision, "smallest_detectable": limit,
        "amplitude": {"value": -0.00956, "unit": unit, "ci95": [-0.0172, -0.00196]}, "rmse_K": None,
        "holdout_rmse_K": {"before": 1.16, "after": 0.93}, "isolating_test": "shield it", "confused_with": [],
        "tests": [],
    }  # fmt: skip


@pytest.mark.parametrize("unit", ["1", "W", "W/m2/K at 10 m/s"])
def test_the_detection_limit_stands_beside_the_size(unit):
    other = candidate("gap_convection@airgap|rotor", "W/K", 0.01, "no", 3.5)
    found = [candidate("convection@flange.right", unit), other]
    lines = [line for line, _ in lay_out(Answer("x", [_candidates(found), *_leader(found)]), 80, LINES)]
    head = next(line for line in lines if line.startswith("effect"))
    assert "size (95 %)" in head
    assert "detectable" in head
    row = next(line for line in lines if line.startswith("convection@flange.right"))
    assert "-0.00956 (-0.0172 ... -0.00196)" in row
    assert "14.14" in row
    assert max(map(len, lines)) <= 80
    said = " ".join(lines)
    assert f"from 14.14{'' if unit == '1' else ' ' + unit} on" in said


def test_without_a_likely_leader_there_is_no_limit_of_it():
    assert _leader([candidate("mass@yoke", "kg", 0.001, "no")]) == []
