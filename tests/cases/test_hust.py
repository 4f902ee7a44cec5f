"""The measured motor: what its files are, and that the effects named there pay on profiles never used."""

import sys

import numpy as np
import pandas as pd
import pytest

from lumped.simulate import Record, simulate
from thermoscope.folder import load_case
from validation.compare import compare

HELD_OUT = {"id_5", "id_8", "id_11", "id_15"}
NAMED = ("time.offset@id_6", "loss.rotor.load@rotor", "convection.rotation@rotor")


@pytest.fixture(scope="module")
def folder(root):
    return load_case(root / "cases" / "hust-ipmsm", bare=True)


@pytest.fixture(scope="module")
def example(root):
    sys.path.insert(0, str(root / "examples"))
    import hust

    return hust


def test_the_held_out_profiles(folder):
    assert {t.name for t in folder.case.tests if t.role == "hold-out"} == HELD_OUT
    assert len(folder.case.tests) == 12


@pytest.mark.parametrize(("profile", "share"), [(0, 0.05), (14, 0.05), (6, 0.1), (7, 0.1)])
def test_undoing_the_filter_gives_the_recorders_grid(root, profile, share):
    """y += share (x - y), undone, lands on multiples of 0.1 K: the lag declared in the sheets is that of the file."""
    table = pd.read_csv(root / "cases" / "hust-ipmsm" / "tests" / f"id_{profile}.csv.gz", nrows=1500)
    for column in ("activewind_1", "slotbottom", "outer_yoke", "ambient"):
        y = table[column].to_numpy()
        x = 10.0 * (y[:-1] + np.diff(y) / share)
        assert np.mean(np.abs(x - np.round(x)) < 0.02) > 0.99


@pytest.mark.parametrize(("name", "share"), [("id_0", 0.05), ("id_7", 0.1)])
def test_declared_lag_is_the_filters_time_constant(folder, name, share):
    test = next(t for t in folder.case.tests if t.name == name)
    assert all(c.lag_s == pytest.approx(-1.0 / np.log(1.0 - share), abs=0.1) for c in test.channels)


def test_steady_state_at_standstill_by_hand(folder):
    """No iron loss: all copper loss passes winding-stator and stator-coolant, the rotor sits at the stator."""
    time = np.concatenate([[0.0], np.cumsum(np.geomspace(1.0, 1e5, 60))])
    at = np.ones_like(time)
    record = Record(
        time, {"id_A": 0 * at, "iq_A": 100 * at, "speed_rpm": 0 * at}, {"coolant": 25 * at, "ambient": 25 * at}, 25.0
    )
    z = simulate(folder.case.model.network, record, keep_states=True).z[-1]
    loss = 1.5 * 4.67e-3 * 100.0**2 * (1 + 0.0039 * (z[0] - 20.0))
    assert z[1] - 25.0 == pytest.approx(0.01879 * loss, rel=1e-4)
    assert z[0] - z[1] == pytest.approx(0.01375 * loss, rel=1e-4)
    assert z[2] == pytest.approx(z[1], abs=1e-2)


def test_named_effects_lower_the_error_on_profiles_never_used(folder, example):
    """The effects of the case's README, one after the other, as `thermoscope add` does it."""
    start = compare(folder.case)
    case = example.calibrated(folder.case)
    for name in NAMED:
        case = example.added(case, name)

    def whole(comparison):
        return np.sqrt(np.mean(np.square(list(example.errors(comparison, "hold-out").values()))))

    assert whole(compare(case)) < 0.7 * whole(start)
