"""Odd times, flows and capacities through `thermoscope use simulate`: one message, or the result of SciPy's Radau."""

from itertools import pairwise

import numpy as np
import pytest
from command_line import answered, refusal
from scipy.integrate import solve_ivp

HEAVY, P, G, DENSITY, CP = 2000.0, 150.0, 8.0, 1053.0, 3413.0
NETWORK = """
[network]
name = "pumped"
boundaries = ["air", "inlet", "sump"]
[nodes.winding]
C_J_K = 2000
[nodes.jacket]
C_J_K = {capacity}
kind = "fluid"
[links.winding-jacket]
between = ["winding", "jacket"]
G_W_K = 8
[links.jacket-air]
between = ["jacket", "air"]
G_W_K = 2
[streams.water]
path = ["inlet", "jacket"]
density_kg_m3 = 1053
cp_J_kgK = 3413
flow_l_min_input = "flow_l_min"
{back}
[losses.heat]
kind = "constant"
at = "winding"
P_W = 150
"""
SHEET = """
[test]
time = "time_s"
[columns.flow]
quantity = "water_flow"
unit = "l/min"
[columns.air]
quantity = "temperature"
unit = "degC"
place = "air"
[columns.inlet]
quantity = "temperature"
unit = "degC"
place = "inlet"
[columns.sump]
quantity = "temperature"
unit = "degC"
place = "sump"
[columns.T_winding]
quantity = "temperature"
unit = "degC"
place = "winding"
"""
EVEN = np.arange(0.0, 1201.0, 10.0)
BACK = 'backwards_from = "sump"'


def pump(t):
    """l/min: starts between two samples, then stays."""
    return np.where(t < 305.0, 0.0, 6.0)


def case_of(folder, time=EVEN, flow=pump, capacity="300", sample="", back=""):
    (folder / "tests").mkdir(parents=True)
    (folder / "network.toml").write_text(NETWORK.format(capacity=capacity, back=back))
    said = f"sample_s = {sample}" if sample else ""
    head = f'[case]\nname = "pumped"\nnetwork = "network.toml"\n{said}\n'
    (folder / "case.toml").write_text(head + '[tests.one]\nrole = "calibrate"\n')
    (folder / "tests/one.toml").write_text(SHEET)
    rows = [f"{t:.9g},{q:.9g},20,30,50,20" for t, q in zip(time, flow(np.asarray(time)), strict=True)]
    (folder / "tests/one.csv").write_text("\n".join(["time_s,flow,air,inlet,sump,T_winding", *rows]))
    return folder


def exact(time, flow, capacity):
    """Largest temperature (degC) of winding and jacket; inputs are straight lines between the rows."""
    time = np.asarray(time, float)

    def slope(t, T):
        q = np.interp(t, time, flow(time))
        mcp = DENSITY * CP * abs(q) / 60000.0
        jacket = G * (T[0] - T[1]) - 2.0 * (T[1] - 20.0) - mcp * (T[1] - (30.0 if q >= 0.0 else 50.0))
        return [(P - G * (T[0] - T[1])) / HEAVY, jacket / capacity]

    out = np.array([[20.0], [20.0]])
    for a, b in pairwise(time):
        run = solve_ivp(slope, (a, b), out[:, -1], method="Radau", rtol=1e-8, atol=1e-8)
        out = np.hstack([out, run.y])
    return out[:, -1]


RIGHT = {
    "plain": {},
    "rows 10 h apart": {"time": np.arange(0.0, 10.0) * 36000.0, "sample": "36000"},
    "backwards": {"flow": lambda t: np.where(t < 305.0, 6.0, -3.0), "back": BACK},
    "through zero": {"flow": lambda t: 4.0 * np.cos(t / 100.0), "back": BACK},
    "a capacity of 1e-9": {"capacity": "1e-9"},
}
WRONG = {
    "a sample of 0 s": ({"sample": "0"}, ["sample_s", "case.toml"]),
    "a jump of 10 h": ({"time": np.append(EVEN, EVEN[-1] + 36000.0 + EVEN)}, ["from 1200 s to 37200 s", "max_gap_s"]),
    "a flow that turns round": ({"flow": lambda t: np.where(t < 305.0, 6.0, -3.0)}, ["flow_l_min", "backwards_from"]),
}


@pytest.mark.parametrize("change", RIGHT.values(), ids=RIGHT)
def test_the_result_is_right(tmp_path, change):
    """0.1 K or 0.1 % of the range, at the end."""
    case = case_of(tmp_path / "case", **change)
    answer = answered("use", "simulate", case, "--out", tmp_path / "out", "--json", "-")
    assert answer.code == 0, answer.err
    ends = {p["place"]: p["end_C"] for p in answer.document["runs"][0]["places"]}
    given = {"time": EVEN, "flow": pump, "capacity": "300", **change}
    want = exact(given["time"], given["flow"], max(float(given["capacity"]), 1e-3))  # Radau fails below 1e-6
    assert [ends["winding"], ends["jacket"]] == pytest.approx(want, abs=0.1)


@pytest.mark.parametrize(("change", "says"), WRONG.values(), ids=WRONG)
def test_or_there_is_one_message(tmp_path, change, says):
    case = case_of(tmp_path / "case", **change)
    line = refusal(tmp_path, "use", "simulate", case, "--out", tmp_path / "out")
    assert all(word in line for word in says), line
