"""The committed measurements of cases/road-test: complete, in range, and with the imprint the truth file states."""

import csv
import tomllib

import numpy as np
import pytest

from measured.recordings.sheet import load_sheet

TESTS = ["stand-1", "stand-2", "stand-3", "road-1", "road-2"]


@pytest.fixture(scope="module")
def folder(root):
    return root / "cases" / "road-test" / "tests"


@pytest.fixture(scope="module")
def truth(root):
    return tomllib.loads((root / "simulated" / "road_test.truth.toml").read_text(encoding="utf-8"))


def columns(path):
    with path.open(encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    return dict(zip(header, np.array(rows, float).T))


@pytest.mark.parametrize("name", TESTS)
def test_columns_are_described(folder, name):
    described = load_sheet(folder / f"{name}.toml")
    assert [described.time, *(column.name for column in described.columns)] == [*columns(folder / f"{name}.csv")]


@pytest.mark.parametrize("name", TESTS)
def test_run_balanced(truth, name):
    assert abs(truth["runs"][name]["imbalance"]) < 1e-6


@pytest.mark.parametrize("name", TESTS[3:])
def test_imprint_stands_out_at_the_right_flange_only(truth, name):
    """Several times the thermocouples' 0.3 K there, lost in it at the left flange."""
    imprint = truth["hidden"]["imprint"][name]
    assert imprint["T_flange_right_degC"]["at_end_K"] < -2.0
    assert abs(imprint["T_flange_left_degC"]["at_end_K"]) < 0.3
