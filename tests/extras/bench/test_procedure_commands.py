"""curves, screen, two-paths and carry through the command line: exit codes, documents, and what they refuse."""

import json
import shutil

import numpy as np
import pytest
from small_case import small_case

NETWORK = """
[network]
name = "two"
boundaries = ["ambient"]
[nodes.winding]
C_J_K = 3000
[nodes.core]
C_J_K = 60000
[links.slot]
between = ["winding", "core"]
G_W_K = 20
[links.film]
between = ["core", "ambient"]
G_W_K = 5
[losses.copper]
at = "winding"
kind = "copper"
R20_ohm = 1.0
currents = ["current_A"]
"""
SHEET = """
[test]
time = "time_s"
[columns.current_A]
quantity = "current"
unit = "A"
[columns.T_air]
quantity = "temperature"
unit = "degC"
place = "ambient"
[columns.T_core]
quantity = "temperature"
unit = "degC"
place = "core"
sigma_K = 0.5
"""
RUNS = ("run-1", "run-2", "run-3")


def warmed(time, current=15.0, off_s=np.inf, step=5.0):
    """Winding and core (2, n) degC of the network above, by its own equations: backward Euler.  off_s : of the load"""
    T, out = np.array([20.0, 20.0]), []
    A = np.array([[3000 / step + 20, -20.0], [-20.0, 60000 / step + 25.0]])
    for now in np.arange(0.0, time[-1] + step, step):
        out.append(T)
        heat = current**2 * (1 + 0.00393 * (T[0] - 20.0)) * (now + step <= off_s)
        T = np.linalg.solve(A, np.array([heat, 5.0 * 20.0]) + np.array([3000, 60000]) / step * T)
    return np.array([np.interp(time, np.arange(len(out)) * step, body) for body in np.transpose(out)])


def equal_tests(folder, offsets, currents=(15.0, 15.0, 15.0)):
    """A case of equal tests of 20 h at 15 A, each read with its own offset (K).  currents : what really flowed (A)"""
    (folder / "tests").mkdir(parents=True)
    (folder / "network.toml").write_text(NETWORK)
    time = np.arange(0.0, 72001.0, 600.0)
    entries = "".join(f'[tests.{name}]\nrole = "calibrate"\n' for name in RUNS)
    (folder / "case.toml").write_text(f'[case]\nname = "two"\nnetwork = "network.toml"\nsample_s = 600\n{entries}')
    for name, off, current in zip(RUNS, offsets, currents, strict=True):
        true = warmed(time, current)[1]
        rows = "".join(f"{t:g},15,20,{T + off:.3f}\n" for t, T in zip(time, true, strict=True))
        (folder / "tests" / f"{name}.csv").write_text(f"time_s,current_A,T_air,T_core\n{rows}")
        (folder / "tests" / f"{name}.toml").write_text(SHEET)
    return folder


def test_curves_of_equal_tests(thermoscope, tmp_path):
    """20 h are seven time constants: equilibrium; the rise over ambient follows the two resistances by hand."""
    done = thermoscope("curves", equal_tests(tmp_path / "two", (-0.3, 0.0, 0.3)), "--json", "-")
    assert done.code == 0, done.err
    found = done.document
    assert found["agrees"]
    (curve,) = found["tests"][1]["curves"]
    rise = 15.0**2 / (5.0 - 15.0**2 * 0.00393 * (1 + 5 / 20))  # copper's loss grows with the winding's rise
    assert curve["equilibrium"]["reached"]
    assert found["tests"][1]["assemblies"][0]["measured"] - 20.0 == pytest.approx(rise, rel=0.02)
    assert found["tests"][1]["assemblies"][0]["verdict"] == "calibrated"
    assert {"a_degC", "b", "c_1_min", "tau95_min", "ci95", "warnings"} <= set(curve["eq8"])
    (equal,) = found["repeats"]
    assert (equal["tests"], equal["place"], equal["n"], equal["repeat"]) == (list(RUNS), "core", 3, True)


def test_curves_that_do_not_repeat_exit_with_1(thermoscope, tmp_path):
    case = equal_tests(tmp_path / "two", (-4.0, 0.0, 4.0))
    code, out, _ = thermoscope("curves", case, "--all", "--json", tmp_path / "found.json")
    assert code == 1
    assert json.loads((tmp_path / "found.json").read_text())["repeats"][0]["repeat"] is False
    assert "run-1, run-2, run-3" in out


def test_a_later_test_repeats_an_earlier_one(thermoscope, tmp_path):
    """The last test is the later one; what an offset of a sigma adds is within uncertainty."""
    case = equal_tests(tmp_path / "two", (0.0, 0.0, 0.4))
    done = thermoscope("curves", case, "--against", "run-1", "--json", "-")
    assert done.code == 0, done.err
    assert (done.document["test"], done.document["against"]) == ("run-3", "run-1")
    assert (done.document["verdict"], done.document["part"]) == ("equal", None)
    assert {c["quantity"] for c in done.document["changes"]} == {"rise", "time constant"}


def test_a_drift_is_told_and_pictured(thermoscope, tmp_path):
    """5 % more current than was read: a tenth more heat, and a rise by the two resistances at either current."""
    case = equal_tests(tmp_path / "two", (0.0, 0.0, 0.0), (15.0, 15.0, 15.75))
    done = thermoscope("curves", case, "--against", "run-2", "--out", tmp_path / "out", "--json", "-")
    assert done.code == 1, done.err
    rises = [i**2 / (5.0 - i**2 * 0.00393 * (1 + 5 / 20)) for i in (15.0, 15.75)]
    (rise,) = [c for c in done.document["changes"] if c["quantity"] == "rise"]
    assert (rise["before"], rise["after"]) == pytest.approx(rises, rel=0.03)  # 2 % is to come in the last quarter
    assert rise["percent"] == pytest.approx(100 * (rises[1] / rises[0] - 1), abs=rise["U95_percent"])
    assert (rise["verdict"], done.document["part"]) == ("changed", "core")
    assert "it cools as before" in done.document["sentence"]
    assert (tmp_path / "out" / "run-3-run-2.png").stat().st_size > 10_000


def test_a_second_case_may_have_the_earlier_test(thermoscope, tmp_path):
    cases = [equal_tests(tmp_path / name, (0.0, 0.0, 0.0)) for name in ("now", "then")]
    done = thermoscope("curves", cases[0], "--against", cases[1], "--test", "run-2", "--json", "-")
    assert (done.code, done.document["against"]) == (0, "two/run-2")


@pytest.mark.parametrize(
    ("command", "words"),
    [
        (("curves", "nowhere"), "no such case folder"),
        (("bases", "nowhere"), "no such case folder"),
        (("bases", "CASE"), "the network knows no bases"),
        (("two-paths", "CASE"), "unknown place 'winding.copper'"),
        (("two-paths", "CASE", "--winding", "winding", "--machine", "yok"), "unknown place 'yok'"),
        (("carry", "CASE", "nowhere"), "no such case folder"),
        (("screen", "pmsm-m9"), "no such machine file"),
        (("screen", "ipmsm-48s8p-jacket"), "has a housing or no magnets"),
        (("screen", "pmsm-m1", "--design", "thirds"), "no design 'thirds'"),
    ],
)
def test_what_they_refuse(thermoscope, tmp_path, command, words):
    """One message on stderr, exit code 2, nothing on stdout."""
    case = small_case(tmp_path)
    code, out, err = thermoscope(*(case if word == "CASE" else word for word in command))
    assert (code, out) == (2, ""), err
    (message,) = [line for line in err.splitlines() if line.startswith("error:")]
    assert words in message
    assert "Traceback" not in err


def test_resolution_has_to_be_one(thermoscope, case):
    done = thermoscope("curves", case, "--resolution", "0")
    assert done.code == 2
    assert "--resolution" in done.err


def test_screen_gives_the_effects(thermoscope, tmp_path):
    """Tables on stdout, and a half-normal plot with its Pareto chart for every response."""
    code, out, err = thermoscope("screen", "pmsm-m1", "--design", "half", "--all", "--out", tmp_path)
    assert code == 0
    names = {"magnets", "winding", "end-winding", "lamination", "winding-minus-magnets", "R_w"}
    assert {p.stem for p in tmp_path.glob("*.png")} == names
    assert "magnets.png" in err
    assert "R_w (mK/W)" in out
    assert "high - low (mK/W)" in out


def test_two_paths_by_hand(thermoscope, tmp_path):
    """R_w of two nodes is 1 / 20 K/W, R_ext 1 / 5 K/W, and constant resistances leave nothing at other loads."""
    case = equal_tests(tmp_path / "two", (0.0, 0.0, 0.0))
    code, out, _ = thermoscope("two-paths", case, "--winding", "winding", "--machine", "core", "--json", "-")
    found = json.loads(out)["tests"]["run-1"]
    assert code == 0
    assert found["R_w"] == pytest.approx(0.05, rel=1e-6)
    assert found["R_ext"] == pytest.approx(0.2, rel=1e-6)
    assert found["largest_residual_K"] < 1e-6


def test_carry_to_another_case(thermoscope, tmp_path):
    """A machine that is the same agrees; one that is read 6 K off does not, and the exit code says so."""
    source = equal_tests(tmp_path / "two", (0.0, 0.0, 0.0))
    other = shutil.copytree(source, tmp_path / "other")
    assert thermoscope("carry", source, other, "--json", "-")[0] == 0
    shutil.rmtree(other)
    equal_tests(other, (0.0, 6.0, 0.0))
    code, out, _ = thermoscope("carry", source, other, "--json", "-")
    assert code == 1
    rows = json.loads(out)["targets"][0]["rows"]
    assert [r["within"] for r in rows] == [True, False, True]
