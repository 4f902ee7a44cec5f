"""thermoscope bench protocol through the command: the list, a good record from files, a refusal with exit code 2."""

import json

import numpy as np
import pandas as pd
import pytest

from extras.bench.commands.protocol import protocol
from extras.bench.measuring.protocol import protocol as judged
from extras.bench.measuring.record_file import read_record
from geom.errors import InputError
from thermoscope.console.summary import limited_lines

RECORD = """
[machine]
rated_kW = 7
[cold]
room_degC = 21.2
machine_degC = 21.0
resistance_ohm = 0.52
range_ohm = 4.0
emf_V = 290.0
speed_rpm = 383
[load]
file = "run.xlsx"
column = "T_lamination"
[hot]
ambient_degC = 22.0
file = "cooling.csv"
column = "R_ohm"
emf_V = 274.8
speed_rpm = 383
[coefficients]
alpha_percent_K = [-0.11, -0.10]
"""


@pytest.fixture
def record(tmp_path):
    t = np.arange(0.0, 36000.0, 120.0)
    pd.DataFrame({"time_s": t, "T_lamination": 70 - 49 * np.exp(-t / 3600)}).to_excel(
        tmp_path / "run.xlsx", index=False
    )
    after = np.arange(25.0, 330.0, 15.0)
    ohm = 0.52 * (1 + 0.3925e-2 * (60.0 + 12.0 * np.exp(-after / 150.0)))
    pd.DataFrame({"time_s": after, "R_ohm": ohm}).to_csv(tmp_path / "cooling.csv", index=False)
    path = tmp_path / "record.toml"
    path.write_text(RECORD)
    return path


def test_the_list_needs_no_record(capsys):
    with limited_lines(None):
        assert protocol(None, None) == 0
    assert "before connecting the motor" in capsys.readouterr().out


def test_good_record(record, tmp_path):
    assert protocol(record, str(tmp_path / "out.json")) == 0
    found = json.loads((tmp_path / "out.json").read_text())
    assert found["complete"] is True
    assert found["winding_rise_K"]["value"] == pytest.approx(72.0, abs=0.2)
    low, high = found["winding_rise_K"]["worst"]
    assert high - low > found["winding_rise_K"]["gum95"][1] - found["winding_rise_K"]["gum95"][0]
    assert found["temperatures_degC"]["magnets"] == pytest.approx(71.0, abs=0.5)


def test_unfinished_record_is_exit_1(record):
    record.write_text(RECORD.split("[hot]")[0])
    assert protocol(record, None) == 1


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("machine_degC = 21.0", "machine_degC = 25.0", "off the room"),
        *(("range_ohm = 4.0", "range_ohm = 40.0", "range up to 40 ohm"), ("rated_kW", "rated_W", "rated_kW")),
        *(('column = "R_ohm"', 'column = "R"', "known: time_s, R_ohm"), ("room_degC", "room_C", "room_degC")),
    ],
)
def test_wrong_records_are_refused(record, old, new, words):
    record.write_text(RECORD.replace(old, new))
    with pytest.raises(InputError, match=words):
        protocol(record, None)


def test_readings_may_stand_in_the_record(record):
    text = RECORD.replace('file = "cooling.csv"\ncolumn = "R_ohm"', "readings = [[25, 0.66], [40, 0.659], [60, 0.658]]")
    record.write_text(text)
    assert read_record(record).hot.cooling[1] == (40.0, 0.659)
    record.write_text(text.replace("[[25, 0.66]", "[[25]"))
    with pytest.raises(InputError, match="not a list of pairs"):
        read_record(record)


METERS = """[meters]
resistance = [
    { range = [0.2, 2.0], percent = 0.05, offset = 0.0005 },
    { range = [2.0, 20.0], percent = 0.05, offset = 0.005 },
]
emf = { range = [0, 600], percent = 0.05, offset = 0.2 }
"""


def width(file, rise):
    low, high = judged(read_record(file)).document()[rise]["worst"]
    return high - low


def test_other_meters(record):
    """Finer meters, smaller worst cases: near 0.52 and 0.67 ohm 0.0008 instead of 0.0033 and 0.0037 ohm."""
    before = {rise: width(record, rise) for rise in ("winding_rise_K", "magnet_rise_K")}
    record.write_text(RECORD.replace("range_ohm = 4.0", "range_ohm = 2.0") + METERS)
    assert width(record, "winding_rise_K") == pytest.approx(before["winding_rise_K"] * 0.8 / 3.5, rel=0.1)
    assert width(record, "magnet_rise_K") < before["magnet_rise_K"]
    record.write_text(RECORD.replace("range_ohm = 4.0", "range_ohm = 20.0") + METERS)
    with pytest.raises(InputError, match="range up to 20 ohm"):
        protocol(record, None)
    record.write_text(RECORD + METERS.replace("[0.2, 2.0]", "[2.0, 0.2]"))
    with pytest.raises(InputError, match="lowest, highest"):
        read_record(record)


def test_saturation_curve_of_the_magnets(record):
    """A straight curve through the origin changes nothing; a saturated one reads the magnets warmer."""

    def warm(remanence):
        curve = f"saturation = {{ emf_V = [240, 270, 300], remanence_T = {remanence} }}\n"
        record.write_text(RECORD + curve)
        return judged(read_record(record)).temperatures["magnets"]

    plain = judged(read_record(record)).temperatures["magnets"]
    assert warm([0.96, 1.08, 1.2]) == pytest.approx(plain, abs=1e-6)
    assert warm([0.96, 1.08, 1.3]) > plain + 5.0


def test_documented_record_is_one(record, root):
    """The record in the how-to, with the recordings of this test, is complete; every key of it is known."""
    page = (root / "docs" / "how-to" / "thermal-test.md").read_text(encoding="utf-8")
    (text,) = [block.split("```")[0] for block in page.split("```toml\n") if "[machine]\nrated_kW" in block]
    (record.parent / "run.csv").write_text(pd.read_excel(record.parent / "run.xlsx").to_csv(index=False))
    record.write_text(text)
    assert protocol(record, None) == 0
