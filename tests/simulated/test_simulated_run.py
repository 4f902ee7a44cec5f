"""Ten minutes of road on a coarse mesh: heat balance, the hidden effect's sign, and the files' format."""

import csv
from dataclasses import fields, replace

import numpy as np
import pytest

from measured.recordings.sheet import load_sheet
from simulated import road_test
from simulated.physics.draws import Draws
from simulated.road import drive, files, sensors
from simulated.road.run import run


@pytest.fixture(scope="module")
def draws():
    return Draws(road_test.SEED)


@pytest.fixture(scope="module")
def plant(draws):
    return road_test.motor(draws, road_test.QUICK)


@pytest.fixture(scope="module")
def ten_minutes(draws):
    whole = drive.drives(draws)["road-1"]
    return replace(whole, **{f.name: getattr(whole, f.name)[:600] for f in fields(whole) if f.name != "start"})


@pytest.fixture(scope="module")
def result(plant, draws, ten_minutes):
    return run(plant, ten_minutes, sensors.install(plant.body, draws), 120)


@pytest.fixture(scope="module")
def sheltered(plant, draws, ten_minutes):
    """The same minutes with the hidden effect off."""
    still = replace(plant, films=replace(plant.films, shelter=0.0))
    return run(still, ten_minutes, sensors.install(plant.body, draws), 120)


def channel(result, name):
    return result.T[:, [*sensors.THERMOCOUPLES].index(name)]


def test_heat_made_is_stored_or_carried_off(result):
    assert abs(result.imbalance) < 1e-6
    assert min(result.made, result.stored, result.exhaust, result.outside) > 0


def test_hidden_effect_cools_the_right_flange(result, sheltered):
    assert channel(sheltered, "T_flange_right_degC")[-1] > channel(result, "T_flange_right_degC")[-1] + 0.3


def test_nothing_happens_to_a_motor_at_rest_in_its_own_ambient(plant):
    n = 240
    zero = np.zeros(n)
    rest = drive.Drive(zero, zero, zero, zero + 138.0, zero + 20.0, 20.0)
    cold = run(plant, rest, (), 120)
    assert cold.made == 0.0
    assert max(cold.hottest.values()) == pytest.approx(20.0, abs=1e-6)


def test_files_agree_with_each_other(result, plant, draws, tmp_path):
    installed = sensors.install(plant.body, draws)
    files.write_csv(tmp_path / "x.csv", result, installed, "road-1", draws)
    files.write_sheets(tmp_path, {"x": "ten minutes"})
    with (tmp_path / "x.csv").open() as file:
        header, *rows = csv.reader(file)
    described = load_sheet(tmp_path / "x.toml")
    assert header == [described.time, *(column.name for column in described.columns)]
    assert [float(row[0]) for row in rows] == [120.0 * i for i in range(6)]
