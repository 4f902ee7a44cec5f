"""Resistance and back-EMF as sensors: they reach compare and calibrate like any thermocouple."""

import numpy as np
import pandas as pd
import pytest
from small_case import small_case

from geom.errors import InputError
from thermoscope.case_folder.folder import load_case
from validation.comparison.compare import compare

R0, COLD, BETA = 0.52, 21.0, 0.3925e-2
COLUMN = """
[columns.R_winding]
quantity = "resistance"
unit = "ohm"
place = "winding"
cold = { reading = 0.52, at_degC = 21.0 }
coefficient_percent_K = [0.392, 0.393]
meter = { percent = 0.25, offset = 0.002, resolution = 0.002, range = [0.4, 4.0] }
"""
MAGNETS = """
[columns.emf]
quantity = "back_emf"
unit = "V"
place = "flange"
cold = { reading = 290.0, at_degC = 21.0, rpm = 383 }
coefficient_percent_K = [-0.11, -0.10]
meter = { percent = 0.1, offset = 1.0 }
speed_rpm = 383
"""


def electrical_case(folder, column=COLUMN):
    """The small case with the winding's thermocouple replaced by a resistance read every 200 s, and a back-EMF."""
    case = small_case(folder)
    for name in ("stand", "road", "town"):
        path = case / "tests" / f"{name}.csv"
        table = pd.read_csv(path)
        seldom = np.arange(len(table)) % 20 == 0
        table["R_winding"] = np.where(seldom, R0 * (1 + BETA * (table["T_winding"] - COLD)), np.nan)
        table["emf"] = np.where(seldom, 290 * (1 - 0.105e-2 * (table["T_flange"] - COLD)), np.nan)
        table.to_csv(path, index=False)
        sheet = case / "tests" / f"{name}.toml"
        head, tail = sheet.read_text().split("[columns.T_winding]")
        sheet.write_text(head + "[columns.T_yoke]" + tail.split("[columns.T_yoke]")[1] + column + MAGNETS)
    return case


def test_resistance_is_the_windings_temperature(tmp_path):
    plain = load_case(small_case(tmp_path)).case.tests[0].channels[0]
    found = {c.name: c for c in load_case(electrical_case(tmp_path / "e")).case.tests[0].channels}
    R = found["R_winding"]
    seen = np.isfinite(R.y)
    assert R.y[seen] == pytest.approx(plain.y[seen], abs=0.5)  # one reading against the mean of two
    assert R.row.index.tolist() == plain.row.index.tolist()
    assert found["emf"].place == "flange"


def test_its_uncertainty_is_that_of_the_meters(tmp_path):
    """0.25 % + 2 mohm near 0.5 ohm, even: (3.3 (+) 3.9 mohm) / sqrt 3 over R0 beta = 1.4 K; back-EMF several kelvin."""
    found = {c.name: c for c in load_case(electrical_case(tmp_path)).case.tests[0].channels}
    assert found["R_winding"].sigma_K == pytest.approx(1.44, abs=0.1)
    assert 2.0 < found["emf"].sigma_K < 4.0


def test_saturation_curve_in_a_sheet(tmp_path):
    """B_r as the square of the back-EMF, tabulated: its fall, and by eq. 2 the rise, is nearly twice as large."""
    volts = np.arange(240.0, 301.0, 5.0)
    curve = f"saturation = {{ emf_V = {volts.tolist()}, remanence_T = {(1e-5 * volts**2).tolist()} }}\n"
    case = electrical_case(tmp_path)
    sheet = case / "tests" / "stand.toml"
    sheet.write_text(sheet.read_text() + curve)
    y = {c.name: c for c in load_case(case).case.tests[0].channels}["emf"].y
    least = pd.read_csv(case / "tests" / "stand.csv")["emf"].min()
    assert np.nanmax(y) == pytest.approx(21.0 + ((least / 290.0) ** 2 - 1) / -0.105e-2, abs=0.05)


def test_compare_and_calibrate_take_them(tmp_path):
    from validation.calibration.calibrate import calibrated
    from validation.parameters.unknowns import working

    case = load_case(electrical_case(tmp_path)).case
    rows = {c.channel: c for c in compare(case).tests[0].channels}
    assert rows["R_winding"].verdict == "within"
    network, unknowns = working(case)
    fit = calibrated(network, case.tests[:1], unknowns, {}, rounds=1)
    assert {s.channel for s in fit.parts} == {"T_yoke", "T_flange", "R_winding", "emf"}


def test_switch_off_readings_stand_at_the_end(tmp_path):
    """Readings of the cooling winding, carried back, are the last reading of the record."""
    after = 'after = { file = "cooling.csv", method = "exponentials", ambient_degC = 21.0, rated_kW = 7 }\n'
    case = electrical_case(tmp_path, COLUMN + after)
    t = np.arange(30.0, 331.0, 15.0)
    T = 60.0 + 12.0 * np.exp(-t / 150.0)
    pd.DataFrame({"time_s": t, "R_winding": R0 * (1 + BETA * (T - COLD))}).to_csv(
        case / "tests/cooling.csv", index=False
    )
    R = {c.name: c for c in load_case(case).case.tests[0].channels}["R_winding"]
    assert R.y[np.isfinite(R.y)][-1] == pytest.approx(72.0, abs=0.1)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("cold = { reading = 0.52, at_degC = 21.0 }\n", "", "no cold reading"),
        ("reading = 0.52", "reading = 5.2", "outside the ranges"),
        ("[0.392, 0.393]", "[0.392, 0.393, 0.394]", "one number, or"),
        ("[0.4, 4.0]", "[4.0, 0.4]", "lowest, highest"),
        ("percent = 0.25,", "precent = 0.25,", "did you mean 'percent'"),
        ("meter = {", 'after = { file = "no.csv", ambient_degC = 20 }\nmeter = {', "no such file"),
    ],
)
def test_wrong_sheets(tmp_path, old, new, words):
    assert old in COLUMN
    with pytest.raises(InputError, match=words):
        load_case(electrical_case(tmp_path, COLUMN.replace(old, new)))
