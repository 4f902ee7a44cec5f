"""thermoscope protocol through the command: the list, a good record from files, a refusal with exit code 2."""

import json

import numpy as np
import pandas as pd
import pytest

from geom.errors import InputError
from thermoscope.commands.protocol import protocol, read_record

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
        ("range_ohm = 4.0", "range_ohm = 40.0", "range up to 40 ohm"),
        ("rated_kW", "rated_W", "rated_kW"),
        ('column = "R_ohm"', 'column = "R"', "known: time_s, R_ohm"),
        ("room_degC", "room_C", "room_degC"),
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
    with pytest.raises(InputError, match="no list of pairs"):
        read_record(record)
