"""What looks odd and is right: read with the same result as the plain case, with a note where something was done."""

import gzip

import numpy as np
import pytest
from input_cases import STAND, case_of, cell, changed, edited

from thermoscope.case_folder.folder import load_case
from validation.comparison.compare import compare


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    return compare(load_case(case_of(tmp_path_factory.mktemp("plain"))).case).rmse_K


def marked(case):
    for name in ("case.toml", "network.toml", STAND, "tests/stand.csv"):
        (case / name).write_bytes(b"\xef\xbb\xbf" + (case / name).read_bytes())


def packed(case):
    file = case / "tests/stand.csv"
    (case / "tests/stand.csv.gz").write_bytes(gzip.compress(file.read_bytes()))
    file.unlink()


def said_which(case):
    """Both are there, and case.toml says which."""
    (case / "tests/stand.csv.gz").write_bytes(b"nothing")
    edited(case / "case.toml", "[tests.stand]", '[tests.stand]\nfile = "tests/stand.csv"')


def ending_commas(case):
    file = case / "tests/stand.csv"
    head, *rows = file.read_text().splitlines()
    file.write_text("\n".join([head, *(f"{row}," for row in rows)]))


def windows(case):
    file = case / "tests/stand.csv"
    file.write_bytes(file.read_bytes().replace(b"\n", b"\r\n"))


def spaced_header(case):
    file = case / "tests/stand.csv"
    file.write_text(file.read_text().replace("T_winding,T_yoke", " T_winding , T_yoke", 1))


SAME = {
    "byte-order marks": (marked, ""),
    "packed": (packed, ""),
    "said which": (said_which, ""),
    "commas at the ends": (ending_commas, ""),
    "line ends of Windows": (windows, ""),
    "spaces in the header": (spaced_header, ""),
    "sensor in capitals": (lambda case: edited(case / STAND, "sigma_K = 0.4", 'sigma_K = 0.4\nsensor = "PT100"'), ""),
    "constant that no law reads": (
        lambda case: edited(case / STAND, "[columns.air]", "[inputs]\npressure_bar = 1.0\n[columns.air]"),
        "no law of the model reads 'pressure_bar'",
    ),
    "open thermocouple": (cell("T_winding", 30, 1370.0), "T_winding': 1 readings of 1370 are a logger's code"),
    "nines": (cell("T_flange", 30, -999.0), "1 readings of -999"),
    "overrange of a meter": (cell("T_flange", 30, 9.9e37), "1 readings of 9.9e+37"),
}


@pytest.mark.parametrize(("change", "note"), SAME.values(), ids=SAME)
def test_the_same_result_and_a_note(tmp_path, plain, change, note):
    case = case_of(tmp_path)
    change(case)
    folder = load_case(case)
    assert note in " ".join(folder.notes)
    # one of 150 readings is missing, or its instant interpolated: far less than a hundredth of a kelvin
    assert compare(folder.case).rmse_K == pytest.approx(plain, abs=0.02)


def test_a_code_in_an_input_is_kept_and_doubted(tmp_path):
    """It may be what was read: 1370 rpm is a speed, and -9999 hardly a current."""
    case = case_of(tmp_path)
    cell("current", 30, -9999.0)(case)
    assert "'current': 1 readings of -9999 are kept: a logger's code" in " ".join(load_case(case).notes)
    cell("current", 30, 1370.0)(case)
    assert "code" not in " ".join(load_case(case).notes)


def test_rows_far_apart_are_said(tmp_path):
    case = case_of(tmp_path)
    edited(case / STAND, 'time = "time_s"', 'time = "time_s"\ntime_unit = "h"')
    assert "rows are 36000 s apart, sample_s is 20 s" in " ".join(load_case(case).notes)


@pytest.mark.parametrize(("name", "unit", "held"), [("duty", "%", 0.005), ("duty_percent", "1", 50.0)])
def test_a_share_is_held_as_its_input_is_named(tmp_path, name, unit, held):
    case = case_of(tmp_path)
    edited(case / STAND, '"vehicle_speed"\nunit = "km/h"', f'"share"\nunit = "{unit}"\ninput = "{name}"')
    changed(case, "stand", lambda table: table.__setitem__("wind", 0.5))
    stand = load_case(case).case.tests[0]
    assert np.allclose(stand.inputs[name], held)


def test_noise_of_a_power_meter_around_nothing(tmp_path):
    case = case_of(tmp_path)
    edited(
        case / "network.toml",
        'kind = "copper"\nR20_ohm = 0.02\ncurrents = ["current_A"]',
        'kind = "constant"\nP_W = 1.0\nof = { input = "power_W", at = 1.0 }',
    )
    for test in ("stand", "road", "town"):
        edited(case / f"tests/{test}.toml", 'quantity = "current"\nunit = "A"', 'quantity = "power"\nunit = "W"')
    changed(case, "stand", lambda table: table.__setitem__("current", table["current"].where(table.index > 9, -0.4)))
    folder = load_case(case)
    assert folder.case.tests[0].inputs["power_W"].min() == 0.0
    assert "readings down to -0.4 are taken as 0" in " ".join(folder.notes)


def test_a_current_may_be_negative(tmp_path, plain):
    """Copper does not mind the direction."""
    case = case_of(tmp_path)
    changed(case, "stand", lambda table: table.__setitem__("current", -table["current"]))
    assert compare(load_case(case).case).rmse_K == pytest.approx(plain)
