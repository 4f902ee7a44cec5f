"""What `diagnose` shows at 80 columns: sizes with intervals and detection limits, never folded, whatever the unit."""

import pytest

from thermoscope.commands.explain.diagnose import _leader, _lost, diagnosis_summary
from thermoscope.console.summary import LINES, Summary, lay_out
from validation.tables import candidates_table, events_table


def candidate(effect, unit, probability=0.99, decision="named", limit=14.14):
    return {
        "effect": effect,
        "probability": probability,
        "decision": decision,
        "smallest_detectable": limit,
        "amplitude": {"value": -0.00956, "unit": unit, "ci95": [-0.0172, -0.00196]},
        "rmse_K": None,
        "holdout_rmse_K": {"before": 1.16, "after": 0.93},
        "isolating_test": "shield it",
        "confused_with": [],
        "tests": [],
    }


@pytest.mark.parametrize("unit", ["1", "W/m2/K at 10 m/s"])
def test_the_detection_limit_stands_beside_the_size(unit):
    other = candidate("gap_convection@airgap|rotor", "W/K", 0.01, "no", 3.5)
    found = [candidate("convection@flange.right", unit), other]
    lines = [line for line, _ in lay_out(Summary("x", [candidates_table(found), *_leader(found)]), 80, LINES)]
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


def test_why_the_rivals_lost():
    """A refitted rival by the sensor it fits worse, the others by their evidence beside the leader's."""
    lead = {**candidate("convection@flange", "W/K"), "note": "", "score": 37.54}
    close = {**candidate("radiation@flange", "1", 0.2, "no"), "note": "fits T_flange in road worse (log odds -5.1)"}
    close |= {"words": "thermal radiation at flange"}
    far = {**candidate("mass@yoke", "kg", 0.001, "no"), "note": "", "score": -0.16}
    said = _lost([lead, {**close, "score": 20.0}, far], ["convection@flange"])
    assert said == [
        "Against 'thermal radiation at flange': it fits T_flange in road worse (log odds -5.1).",
        "Log odds 37.5 (3 is twenty to one); of each rival alone: mass@yoke (-0.2).",
    ]
    assert _lost([far], []) == []


def test_improbable_stretches_wait_for_all():
    row = {"words": "from 9 to 46 min", "effect": "mass@yoke in town", "value": 1.0, "unit": "kg"}
    events = [{**row, "probability": 0.0}, {**row, "probability": 0.4}]
    assert [r[0] for r in events_table(events).rows] == ["event@2"]
    assert [r[0] for r in events_table(events, likely=False).rows] == ["event@1"]


@pytest.mark.parametrize("accepted", [True, False])
def test_what_add_refuses_is_not_proposed(accepted):
    name = "convection@flange.right"
    row = {**candidate(name, "W/K", 0.4, "group"), "score": 3.0, "note": ""}
    document = {"words": "missing: wind", "verdict": "group", "revision": 1, "named": [name], "candidates": [row]}
    document |= {"cannot_see": [], "odds": [{"effects": [name], "probability": 0.4}]}
    tried = {"effects": [name], "accepted": accepted, "why": "1.0 -> 2.0 K"}
    told = diagnosis_summary({**document, "tried": tried}, "own")
    assert (f"model add own {name}" in told.more) == accepted
    said = [part for part in told.parts if isinstance(part, str) and part.startswith("Not proposed")]
    assert said == ([] if accepted else ["Not proposed, since model add would not accept it: 1.0 -> 2.0 K."])
    quiet = {**document, "named": [], "verdict": "adequate", "revision": 0, "candidates": []}
    assert "model calibrate own" in diagnosis_summary(quiet, "own").more
