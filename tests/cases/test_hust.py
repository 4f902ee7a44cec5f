"""The measured motor: what its files are, and that the effects named there pay on profiles never used."""

import sys

import numpy as np
import pandas as pd
import pytest

from lumped.integration.simulate import Record, simulate
from thermoscope.case_folder.folder import load_case
from validation.comparison.compare import compare
from validation.parameters.unknowns import with_model
from validation.revision.revise import add, calibrate

pytestmark = pytest.mark.heavy
NAMED = ("gap.convection@rotor|stator",)


@pytest.fixture(scope="module")
def folder(root):
    return load_case(root / "cases" / "hust-ipmsm", bare=True)


@pytest.fixture(scope="module")
def example(root):
    sys.path.insert(0, str(root / "examples"))
    import hust

    return hust


@pytest.fixture(scope="module")
def start(folder):
    """The comparison of the model as published."""
    return compare(folder.case)


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
    """No residual loss: all copper loss passes winding-stator, the rotor sits between the stator and the room."""
    time = np.concatenate([[0.0], np.cumsum(np.geomspace(1.0, 1e5, 60))])
    at = np.ones_like(time)
    inputs = {"id_A": 0 * at, "iq_A": 100 * at, "current_A": 100 * at, "speed_rpm": 0 * at}
    record = Record(time, inputs, {"coolant": 25 * at, "ambient": 25 * at}, 25.0)
    z = simulate(folder.case.model.network, record, keep_states=True).z[-1]
    loss = 1.5 * 4.67e-3 * 100.0**2 * (1 + 0.0039 * (z[0] - 20.0))
    through, R_rotor = (z[1] - 25.0) / 0.01879, 0.584867 + 5.0117
    assert z[0] - z[1] == pytest.approx(0.01375 * loss, rel=1e-4)
    assert through + (z[1] - 25.0) / R_rotor == pytest.approx(loss, rel=1e-4)
    assert z[2] - 25.0 == pytest.approx((z[1] - 25.0) * 5.0117 / R_rotor, rel=1e-4)


def published(table):
    """The authors' three-node model, explicit Euler at 1 s as in their notebook: (n, 3) winding, stator, rotor.

    They let what alternating current adds grow with temperature, as direct current's loss does; eddy currents fall.
    """
    T = np.array(
        [table[c].iloc[0].mean() for c in (["activewind_1", "activewind_2"], ["slotbottom", "outer_yoke"])]
        + [table["rotor"].iloc[0]]
    )
    C, out = np.array([3716.15, 5616.32, 5329.69]), [T]
    i, f = np.hypot(table["IdFbk"], table["IqFbk"]).to_numpy() / 370.0, table["speed"].to_numpy() / 4000.0
    ambient, coolant = table["ambient"].to_numpy(), table["water_outlet"].to_numpy()
    residual = 4.656e-6 * i + 247.8 * f + 1151.47 * i * f
    share = np.clip(0.8910 + 0.0231 * i - 0.0397 * f - 0.009 * i * f, 0.0, 1.0)
    R_sr = 0.5769 * np.exp(-0.7913 / 4000.0 * f) + 0.007967
    R_ra = 5.00 * np.exp(-0.3128 / 4000.0 * f) + 0.0117
    for n in range(1, len(table)):
        warm, eddy = 1 + 0.0039 * (T[0] - 20.0), 0.02174 * f[n] + 0.3874 * f[n] ** 2
        copper = 1.5 * 4.67e-3 * (370.0 * i[n]) ** 2 * (warm + eddy / warm)
        ws, sr, ra = (T[0] - T[1]) / 0.01375, (T[1] - T[2]) / R_sr[n], (T[2] - ambient[n]) / R_ra[n]
        sc = (T[1] - coolant[n]) / 0.01879
        heat = [copper - ws, residual[n] * share[n] + ws - sr - sc, residual[n] * (1 - share[n]) + sr - ra]
        T = T + np.array(heat) / C
        out.append(T)
    return np.array(out)


@pytest.mark.parametrize("profile", [11, 13])
def test_the_start_is_the_published_model(root, start, profile):
    """The case's errors are those of the authors' equations, written down once more; the case averages over 20 s
    and has its inputs linear in between, where theirs are held."""
    table = pd.read_csv(root / "cases" / "hust-ipmsm" / "tests" / f"id_{profile}.csv.gz")
    measured = np.column_stack(
        [
            table[["activewind_1", "activewind_2"]].mean(axis=1),
            table[["slotbottom", "outer_yoke"]].mean(axis=1),
            table["rotor"],
        ]
    )
    theirs = np.sqrt(np.mean((published(table) - measured) ** 2, axis=0))
    ours = next(t for t in start.tests if t.name == f"id_{profile}")
    by_name = {c.channel: c.rmse_K for c in ours.channels}
    assert [by_name[c] for c in ("winding", "stator", "rotor")] == pytest.approx(theirs, abs=0.2)


def test_what_is_found_halves_every_error_of_the_published_model_on_profiles_never_used(folder, start, example):
    """What the case's README says is named, as `thermoscope model add` adds it."""
    before = example.role_errors(start)[0]
    case = with_model(folder.case, calibrate(folder.case).model)
    for name in NAMED:
        case = with_model(case, add(case, name).model)
    after = example.role_errors(compare(case))[0]
    assert {c: after[c] <= 0.5 * before[c] for c in before} == dict.fromkeys(before, True)
