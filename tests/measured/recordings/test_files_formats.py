"""The recordings people have, each written by its own library and read back: the same numbers from every format."""

import io
import struct

import numpy as np
import openpyxl
import pandas as pd
import pytest
from openpyxl.chart import LineChart
from small_case import HEADER, measured, small_case

from geom.errors import InputError
from measured.importing.clock import clock_of
from measured.importing.source import read_source
from measured.recordings import formats
from measured.recordings.alignment import clock_shift
from measured.recordings.formats import joined, read_recording, recording
from measured.recordings.sheet import read_sheet
from measured.recordings.tables import load_table
from measured.recordings.units import checked_unit, converted
from thermoscope.case_folder.folder import load_case

ROWS = measured(0, True, 6.0)
COLUMNS = HEADER.split(",")


def as_xlsx(path):
    with pd.ExcelWriter(path, engine="openpyxl") as book:
        pd.DataFrame({"parameter": ["film"], "value": [4.0]}).to_excel(book, sheet_name="input", index=False)
        pd.DataFrame(ROWS, columns=COLUMNS).to_excel(book, sheet_name="results", index=False)


def as_tdms(path):
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(path) as file:
        wave = {"wf_increment": 10.0, "wf_start_offset": 0.0}
        file.write_segment(
            [ChannelObject("Log", n, ROWS[:, i + 1], properties=wave) for i, n in enumerate(COLUMNS[1:])]
        )


def as_mf4(path):
    from asammdf import MDF, Signal

    with MDF(version="4.10") as file:
        signals = [Signal(ROWS[:, i + 1], ROWS[:, 0], name=n) for i, n in enumerate(COLUMNS[1:])]
        file.append(signals[:2], comment="electrical")
        file.append(signals[2:], comment="temperatures")
        file.save(path)


def as_parquet(path):
    pd.DataFrame(ROWS, columns=COLUMNS).to_parquet(path)


WRITERS = {"xlsx": as_xlsx, "tdms": as_tdms, "mf4": as_mf4, "parquet": as_parquet}


@pytest.mark.parametrize("suffix", WRITERS)
def test_a_case_reads_the_same_from_every_format(tmp_path, suffix):
    """A recording that replaces a CSV of the same name gives the same test."""
    case = small_case(tmp_path)
    plain = load_case(case).case.tests[0]
    (case / "tests" / "stand.csv").unlink()
    ROWS[:] = measured(0, False, 6.0)
    WRITERS[suffix](case / "tests" / f"stand.{suffix}")
    if suffix == "xlsx":
        sheet = case / "tests" / "stand.toml"
        sheet.write_text(sheet.read_text().replace('time = "time_s"', 'time = "time_s"\nworksheet = "results"'))
    other = load_case(case).case.tests[0]
    assert other.time == pytest.approx(plain.time)
    for a, b in zip(plain.channels, other.channels):
        assert b.y == pytest.approx(a.y, abs=1e-3)


def test_channels_of_two_rates_share_the_time(tmp_path):
    """A TDMS file with 1 s and 5 s channels: every reading at its own instant, the rest empty."""
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(tmp_path / "a.tdms") as file:
        fast = ChannelObject("E", "I", np.arange(21.0), properties={"wf_increment": 1.0})
        slow = ChannelObject("T", "T1", np.arange(5.0), properties={"wf_increment": 5.0})
        file.write_segment([fast, slow])
    table = read_recording(tmp_path / "a.tdms")
    assert table["time_s"].tolist() == list(range(21))
    sampled = np.isfinite(table["T1"])
    assert table["T1"][sampled].tolist() == [0, 1, 2, 3, 4]
    assert table["time_s"][sampled].tolist() == [0, 5, 10, 15, 20]
    with pytest.raises(InputError, match="known: E, T"):
        read_recording(tmp_path / "a.tdms", "X")


@pytest.mark.parametrize("suffix", WRITERS)
def test_seconds_are_counted_inside_every_reader(tmp_path, monkeypatch, suffix):
    """Between pieces that the format's own reader hands over."""
    instants = iter(range(0, 10**6, 400))
    WRITERS[suffix](tmp_path / f"a.{suffix}")
    monkeypatch.setattr("geom.limits.time.monotonic", lambda: next(instants))
    with pytest.raises(InputError, match="limit 'seconds'"):
        read_recording(tmp_path / f"a.{suffix}")


@pytest.mark.parametrize("suffix", [".xlsx", ".tdms", ".mf4", ".parquet"])
def test_a_file_that_is_something_else(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    path.write_bytes(b"this is no such file, but long enough to be looked at twice" * 10)
    with pytest.raises(InputError, match="not readable as"):
        read_recording(path)


def test_instants_without_a_name_are_the_time(tmp_path):
    """As pandas writes a table whose index has none; row numbers are no column."""
    index = pd.date_range("2026-03-28 12:00:10", periods=40, freq="15s", tz="UTC")
    pd.DataFrame({"T_winding": np.arange(40.0)}, index).to_parquet(tmp_path / "a.parquet")
    assert list(read_recording(tmp_path / "a.parquet").columns) == ["T_winding", "time"]
    assert np.diff(clock_of(read_source(tmp_path / "a.parquet")).seconds) == pytest.approx(15.0)


def test_unknown_format_and_missing_worksheet(tmp_path):
    (tmp_path / "a.ods").write_text("x")
    with pytest.raises(InputError, match=r"ending in '\.ods'"):
        read_recording(tmp_path / "a.ods")
    as_xlsx(tmp_path / "a.xlsx")
    with pytest.raises(InputError, match=r"no worksheet 'result'.*did you mean 'results'"):
        read_recording(tmp_path / "a.xlsx", "result")
    with pytest.raises(InputError, match=r"found there: a\.xlsx"):
        recording(tmp_path / "b.csv")


SHEET = """
[test]
time = "time_s"
[columns.T]
column = "T winding [F]"
quantity = "temperature"
unit = "degF"
place = "winding"
[columns.I]
quantity = "current"
unit = "uA"
"""


def sheet(text, folder):
    import tomllib

    return read_sheet(tomllib.loads(text), "sheet.toml", folder)


def test_columns_are_mapped_and_units_converted(tmp_path):
    """A column under another name, in degF, and a unit only pint knows."""
    rows = "".join(f"{t},{68 + t},{1e6 * t}\n" for t in range(5))
    (tmp_path / "a.csv").write_text(f"time_s,T winding [F],I\n{rows}")
    values = load_table(tmp_path / "a.csv", sheet(SHEET, tmp_path)).values
    assert values["T"][0] == pytest.approx(20.0)
    assert values["I"][4] == pytest.approx(4.0)


@pytest.mark.parametrize(
    ("of", "unit", "value", "inside"),
    [
        *(("temperature", "kelvin", 300.0, 26.85), ("torque", "lbf*ft", 1.0, 1.3558179)),
        *(("speed", "rad/min", 2 * np.pi, 1.0), ("power", "hp", 1.0, 745.69987)),
        *(("air_flow", "ft**3/min", 1.0, 1.69901), ("time", "day", 1.0, 86400.0)),
        *(("resistance", "milliohm", 5.0, 5e-3), ("water_flow", "gallon/min", 1.0, 3.785412)),
    ],
)
def test_units_by_pint(of, unit, value, inside):
    assert checked_unit(of, unit, "x") == unit
    assert converted(np.array([value]), of, unit)[0] == pytest.approx(inside, rel=1e-5)


@pytest.mark.parametrize(
    ("of", "unit"), [("current", "V"), ("temperature", "W"), ("speed", "km/h"), ("power", "wat t")]
)
def test_units_of_another_kind_are_refused(of, unit):
    with pytest.raises(InputError, match="unknown unit"):
        checked_unit(of, unit, "x")


BESIDE = """
[recorders.power]
file = "power.parquet"
time = "t"
time_unit = "ms"
"""


def two_recorders(folder, extra, late=7.0):
    """T by the main recorder, I by another whose clock is `late` seconds behind and in ms; both saw the load."""
    t = np.arange(0.0, 400.0, 2.0)
    load = np.where((t > 60) & (t < 200), 1.0, 0.2) + 0.3 * np.sin(t / 15.0)
    pd.DataFrame({"time_s": t, "T winding [F]": 68 + 0 * t, "load": load}).to_csv(folder / "a.csv", index=False)
    seen = np.interp(t + late, t, load)
    pd.DataFrame({"t": 1e3 * t, "I": 1e6 * seen, "P": 5.0 * seen}).to_parquet(folder / "power.parquet")
    return load_table(folder / "a.csv", sheet(SHEET + BESIDE + extra, folder))


def test_second_recorder_is_shifted_as_told(tmp_path):
    samples = two_recorders(tmp_path, "shift_s = 7.0")
    at = np.flatnonzero(np.isfinite(samples.values["I"]))
    assert samples.time[at[0]] == pytest.approx(7.0)


def test_second_recorder_is_aligned_by_what_both_saw(tmp_path):
    samples = two_recorders(tmp_path, 'align = ["load", "P"]\nlimit_s = 30')
    at = np.flatnonzero(np.isfinite(samples.values["I"]))
    assert samples.time[at[0]] == pytest.approx(7.0, abs=0.5)


def test_clocks_that_cannot_be_aligned():
    t = np.arange(0.0, 300.0)
    step, noise = (t > 100).astype(float), np.random.default_rng(0).standard_normal(t.size)
    with pytest.raises(InputError, match="correlation of"):
        clock_shift(t, step, t, noise, 20.0, "x")
    with pytest.raises(InputError, match="differ by 20 s or more"):
        clock_shift(t, step, t, (t > 150).astype(float), 20.0, "x")
    with pytest.raises(InputError, match="saw change"):
        clock_shift(t, step, t, np.ones(t.size), 20.0, "x")
    assert clock_shift(t, step, t, (t > 92).astype(float), 20.0, "x") == pytest.approx(8.0, abs=0.5)


def test_column_recorded_twice_is_refused(tmp_path):
    with pytest.raises(InputError, match="'P' is not in the file"):
        two_recorders(tmp_path, 'align = ["P", "P"]')
    frame = pd.DataFrame({"time_s": [0.0, 1, 2], "I": [1.0, 2, 3]})
    frame.to_csv(tmp_path / "b.csv", index=False)
    frame.rename(columns={"time_s": "t"}).to_parquet(tmp_path / "power.parquet")
    with pytest.raises(InputError, match="'I' is recorded twice"):
        load_table(tmp_path / "b.csv", sheet(SHEET + BESIDE, tmp_path))


def test_joined_leaves_out_what_is_no_number():
    table = joined([("a", np.arange(3.0), np.arange(3.0)), ("note", np.arange(3.0), np.array(["x", "y", "z"]))])
    assert [name for name, _ in table] == ["time_s", "a"]


def test_workbook_holds_input_and_results(tmp_path):
    """What compare says is what the workbook says, and Excel's own reader opens it."""
    import openpyxl

    from thermoscope.case_folder.workbook import tables, write_csvs, write_xlsx

    folder = load_case(small_case(tmp_path))
    content = tables(folder)
    path = write_xlsx(tmp_path / "out.xlsx", content)
    book = openpyxl.load_workbook(io.BytesIO(path.read_bytes()), read_only=True)
    assert book.sheetnames[:4] == ["parameters", "errors", "stand input", "stand results"]
    back = pd.read_excel(path, sheet_name="road results")
    road = folder.case.tests[1]
    assert back["T_yoke measured (degC)"].to_numpy() == pytest.approx(road.channels[1].y)
    gap = back["T_yoke calculated (degC)"] - back["T_yoke measured (degC)"]
    (errors,) = (table.frame() for table in content if table.title == "errors")
    rmse = dict(zip(zip(errors["test"], errors["channel"]), errors["rmse_K"]))
    assert np.sqrt((gap**2).mean()) == pytest.approx(rmse["road", "T_yoke"])
    written = write_csvs(tmp_path / "csv", content)
    assert pd.read_csv(written[1])["rmse_K"].to_numpy() == pytest.approx(errors["rmse_K"])


def test_a_chart_sheet_holds_no_table(tmp_path):
    """The first sheet that has cells is read; a chart by its name is not a worksheet."""
    book = openpyxl.Workbook()
    for row in (["time_s", "T"], [0, 20.0], [1, 21.0], [2, 22.0]):
        book.active.append(row)
    book.create_chartsheet("drawn", 0).add_chart(LineChart())
    book.save(tmp_path / "x.xlsx")
    assert read_recording(tmp_path / "x.xlsx").columns == ["time_s", "T"]
    with pytest.raises(InputError, match="no worksheet 'drawn'"):
        read_recording(tmp_path / "x.xlsx", "drawn")


@pytest.mark.parametrize("drawn", [True, False])
def test_a_workbook_of_charts_alone_is_told(tmp_path, drawn):
    book = openpyxl.Workbook()
    sheet = book.create_chartsheet("drawn")
    if drawn:
        sheet.add_chart(LineChart())
    book.remove(book.worksheets[0])
    book.save(tmp_path / "x.xlsx")
    for read in (read_recording, read_source):
        with pytest.raises(InputError, match="holds charts alone"):
            read(tmp_path / "x.xlsx")


@pytest.mark.parametrize("claimed", [78, 10**6, 10**8, 10**12, 2**63 - 1])
@pytest.mark.parametrize("ending", ["tdms", "mf4"])
def test_rows_that_a_file_claims_and_does_not_hold_cost_nothing(tmp_path, ending, claimed):
    """77 rows that call themselves more are 77, or refused: rows that are not there are never read as zeros."""
    file, t = tmp_path / f"a.{ending}", np.arange(77.0)
    if ending == "tdms":
        nptdms = pytest.importorskip("nptdms")
        with nptdms.TdmsWriter(str(file)) as writer:
            writer.write_segment([nptdms.ChannelObject("g", n, t, {"wf_increment": 1.0}) for n in ("T winding", "I")])
    else:
        asammdf = pytest.importorskip("asammdf")
        with asammdf.MDF(version="4.10") as made:
            made.append([asammdf.Signal(t, t, name=n, unit=u) for n, u in (("T winding", "degC"), ("I", "A"))])
            made.save(file)
    sound, count = file.read_bytes(), struct.pack("<Q", 77)
    assert count in sound
    file.write_bytes(sound.replace(count, struct.pack("<Q", claimed)))
    if ending == "tdms":
        assert read_source(file).rows == 77
    else:
        words = "the limit 'rows'" if claimed > 10**7 else f"claims {claimed:,} rows and holds 77"
        with pytest.raises(InputError, match=words):
            read_source(file)


def test_a_book_that_is_read_again_is_opened_once(tmp_path, monkeypatch):
    file, opened, plain = tmp_path / "a.xlsx", [], formats._workbook
    book = openpyxl.Workbook()
    for row in (["t [s]", "T [degC]"], [0, 20], [1, 21], [2, 22]):
        book.active.append(row)
    book.save(file)
    monkeypatch.setattr(formats, "_workbook", lambda file: opened.append(file) or plain(file))
    with formats.each_book_once():
        assert formats.workbook_rows(file, "") == next(iter(formats.worksheets(file).values()))
    assert opened == [file]
    assert formats.workbook_rows(file, "")[0] == ["t [s]", "T [degC]"]
    assert len(opened) == 2
