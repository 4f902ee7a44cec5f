"""A simulated fleet, by physics of its own: the fouled jacket, the loose joint, the drift, and what differs."""

import gzip
import os
import re
import shutil
import tracemalloc
from dataclasses import replace

import numpy as np
import openpyxl
import pandas as pd
import pytest
from numpy.testing import assert_allclose
from scipy.io import savemat

from extras.monitor.fleet import Statistics, UnitHistory, population
from extras.monitor.rows.fleet import Reader, Recording
from geom.errors import InputError
from measured.recordings.sheet import load_sheet
from simulated.fleet import DRIFT_YEAR, written
from thermoscope.case_folder.folder import load_case

pytestmark = pytest.mark.nightly

NAMES, SD = ("a", "b"), np.array([0.5, 0.5])


def history(name, theta, sd, rng, years=(2026.0,), drift=0.0):
    """A motor whose parameters are read with a deviation sd."""
    H = np.diag(1.0 / np.square(sd))
    seen = [theta + drift * (y - 2026.0) + sd * rng.standard_normal(2) for y in years]
    return UnitHistory(name, years, tuple(Statistics(NAMES, SD, np.full(2, 0.3), H, H @ s, 0.1, 100) for s in seen))


def test_mean_spread_and_drift_of_a_normal_population_are_found():
    rng, sd = np.random.default_rng(1), np.array([0.05, 0.05])
    spread, mean, drift = np.array([0.2, 0.0]), np.array([0.1, -0.2]), np.array([-0.1, 0.0])
    units = [
        history(f"u{i}", mean + spread * rng.standard_normal(2), sd, rng, (2025.0, 2026.0, 2027.0), drift)
        for i in range(400)
    ]
    found = population(units)
    assert_allclose(found.mean, mean, atol=3 * 0.2 / 20)
    assert_allclose(found.spread, spread, atol=0.02)
    assert found.spread_probability[0] < 1e-6
    assert found.spread_probability[1] > 0.01
    assert np.all(np.abs(found.drift - drift) < 3 * found.drift_sd)
    assert found.drift_sd.max() < 0.05  # what one motor tells: 0.05 / sqrt(2) a year


def test_equal_fleets_have_an_outlier_in_one_of_a_hundred():
    alarms = 0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        units = [history(f"u{i}", 0.1 * rng.standard_normal(2), np.array([0.05, 0.05]), rng) for i in range(40)]
        alarms += bool(population(units).outliers)
    assert alarms <= 4  # 60 draws of at most 1 in 100; the weights widen nothing


def test_a_motor_at_eight_spreads_is_named_and_does_not_widen_the_others():
    rng = np.random.default_rng(3)
    units = [history(f"u{i}", 0.1 * rng.standard_normal(2), np.array([0.05, 0.05]), rng) for i in range(40)]
    units.append(history("odd", np.array([0.0, -0.8]), np.array([0.05, 0.05]), rng))
    found = population(units)
    assert [(o.unit, o.parameter) for o in found.outliers] == [("odd", "b")]
    assert abs(found.outliers[0].change + 0.8) < 0.3
    assert found.spread[1] < 0.15


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return written(tmp_path_factory.mktemp("fleet"), 24, 3, 7)


@pytest.fixture(scope="module")
def document(thermoscope, made):
    case, fleet = made
    done = thermoscope("use", "fleet", case, fleet, "--json", "-", cwd=case.parent)
    assert done.code == 0, done.err
    return done.document


def test_the_fouled_jacket_and_the_loose_joint_are_found(document):
    found = {(o["unit"], o["parameter"]): o for o in document["outliers"]}
    assert set(found) == {("motor-004", "link.jacket"), ("motor-008", "link.joint")}
    for o in found.values():
        assert o["factor_ci95"][1] < 0.85


def test_what_differs_and_what_drifts_is_said(document):
    rows = {p["name"]: p for p in document["parameters"]}
    assert rows["link.jacket"]["differs"]
    low, high = rows["link.jacket"]["drift_ci95"]
    assert low < 100 * DRIFT_YEAR < high
    assert rows["link.jacket"]["drifts"]
    assert not [n for n, p in rows.items() if p["drifts"] and n != "link.jacket"]
    assert len(document["units"]) == 24


def reader_of(case):
    folder = load_case(case)
    sheets = {one.name: load_sheet(one.sheet) for one in folder.settings.tests}
    return Reader(replace(folder.case, tests=()), folder.case.tests, sheets, 20.0)


def test_memory_does_not_grow_with_the_recording(made, tmp_path):
    """Four times the rows, in pieces of a fixed size."""
    case, fleet = made
    reader, short = replace(reader_of(case), piece=1000), fleet / "motor-001@2025-01.csv"
    head, *rows = short.read_text().splitlines()
    long, rows = tmp_path / "long.csv", rows[:2000]
    short = tmp_path / "short.csv"
    short.write_text("\n".join([head, *rows]))
    late = [f"{float(r.split(',')[0]) + 6000.0 * k},{r.partition(',')[2]}" for k in range(4) for r in rows]
    long.write_text("\n".join([head, *late]))
    peaks = []
    for file in (short, long):
        reader.statistics(Recording(file, "m", 0.0))
        tracemalloc.start()
        found = reader.statistics(Recording(file, "m", 0.0))
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert found.samples > 3 * 3 * 100
    assert peaks[1] < 1.2 * peaks[0]


def test_each_recording_is_read_as_the_test_that_it_fits(thermoscope, root):
    """Two headers in one folder: of the case's sheets each file finds its own."""
    case = root / "cases" / "tclab"
    headers = {file.read_text().partition("\n")[0] for file in (case / "tests").glob("*.csv")}
    done = thermoscope("use", "fleet", case, case / "tests", "--json", "-")
    assert len(headers) == 2
    assert (done.code, done.document["recordings"]) == (0, 3)


def test_an_added_effect_counts_in_shares_of_its_size_in_the_model(thermoscope, root, tmp_path):
    """Its size is fitted as it is, not by a logarithm: e to the 12 W/m2/K is not a number of anything."""
    case, effect = shutil.copytree(root / "cases" / "tclab", tmp_path / "tclab"), "convection.buoyant@heater1"
    thermoscope("calibrate", case)
    assert thermoscope("add", case, effect).code == 0
    done = thermoscope("use", "fleet", case, case / "tests", "--json", "-")
    (row,) = (p for p in done.document["parameters"] if p["name"] == effect)
    assert 0.3 < row["mean"] < 3.0
    assert all(0.1 < u["parameters"][effect] < 10.0 for u in done.document["units"])


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (["a.csv", "b.csv"], "2 motors are no fleet"),
        (["nothing.csv"], "no such file"),
        (["empty"], "no recording in the folder"),
        (["a.csv", "b.csv", "c@2026-01.csv"], "has no date, others have"),
        (["a@2026-13.csv", "b.csv", "c.csv"], "holds no date that exists"),
        (["a.csv", "b.csv", "short.csv"], "at least 60"),
        (["a.csv", "b.csv", "other.csv"], "column 'current' is not in the header"),
        (["a.csv", "b.csv", "c.csv", "--like", "moon"], "no test 'moon'"),
    ],
)
def test_wrong_fleets_are_one_message(thermoscope, made, tmp_path, names, message):
    case, fleet = made
    rows = (fleet / "motor-001@2025-01.csv").read_text().splitlines()
    for name in ("a.csv", "b.csv", "c.csv", "c@2026-01.csv", "a@2026-13.csv"):
        (tmp_path / name).write_text("\n".join(rows[:200]))
    (tmp_path / "short.csv").write_text("\n".join(rows[:20]))
    (tmp_path / "other.csv").write_text("\n".join([rows[0].replace("current", "amps"), *rows[1:200]]))
    (tmp_path / "empty").mkdir()
    done = thermoscope("use", "fleet", case, *names, cwd=tmp_path)
    assert (done.code, done.err.count("error:")) == (2, 1)
    assert message in done.err


@pytest.mark.parametrize("ending", ["xlsx", "parquet", "csv.gz", "mat", "log"])
def test_a_motor_in_any_format_is_the_same_motor(made, tmp_path, ending):
    case, fleet = made
    table, file = pd.read_csv(fleet / "motor-001@2025-01.csv").head(399), tmp_path / f"a.{ending}"
    table.to_csv(tmp_path / "a.csv", index=False)
    if ending == "xlsx":
        table.to_excel(file, index=False)
    elif ending == "parquet":
        table.to_parquet(file)
    elif ending == "mat":
        savemat(file, {"run": {name: table[name].to_numpy() for name in table}})
    else:
        table.to_csv(file, index=False)
    found, plain = (reader_of(case).statistics(Recording(f, "m", 0.0)) for f in (file, tmp_path / "a.csv"))
    assert found.samples == plain.samples > 30
    assert_allclose(found.H, plain.H, rtol=1e-6)


def test_hostile_files_are_one_message(made, tmp_path):
    """Noise under every ending, zero bytes, a packed gigabyte, a workbook of charts alone, a pipe."""
    case, _ = made
    noise = {".csv": b"\0" * 999, ".txt": b"\xff\xfe\0", ".csv.gz": gzip.compress(bytes(10**9), 1)}
    noise |= {ending: b"PK\x03\x04" + bytes(range(256)) for ending in (".xlsx", ".mat", ".tdms", ".mf4", ".parquet")}
    book = openpyxl.Workbook()
    book.create_chartsheet("chart")
    book.remove(book["Sheet"])
    os.mkfifo(tmp_path / "pipe.csv")
    book.save(tmp_path / "charts.xlsx")
    for ending, content in noise.items():
        (tmp_path / f"noise{ending}").write_bytes(content)
    for file in tmp_path.iterdir():
        with pytest.raises(InputError, match=re.escape(file.name)):
            reader_of(case).statistics(Recording(file, "m", 0.0))
