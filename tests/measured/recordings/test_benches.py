"""Files as benches, controllers and CAN tools write them: runs in one file, ratios as units, powers of parts."""

from datetime import datetime, time, timedelta

import numpy as np
import pytest
from logger_formats import workbook

from geom.description.roles import Role
from geom.errors import InputError
from measured.headers.rows import layout
from measured.importing.aligned import Recording, longest_part
from measured.importing.case_files import read_runs
from measured.importing.guess import guesses
from measured.importing.source import Source, read_source
from measured.importing.target import Target

ROWS = 60
T = np.arange(0.0, 2 * ROWS, 2.0)


def read(tmp_path, **columns):
    """Columns of a CSV file under their names, with a clock in front unless one is given."""
    columns = {"t [s]": T, **columns}
    lines = [",".join(columns), *(",".join(f"{v:g}" for v in row) for row in zip(*columns.values(), strict=True))]
    (tmp_path / "a.csv").write_text("\n".join(lines) + "\n")
    return tmp_path / "a.csv"


def test_a_row_of_units_stands_over_that_of_the_clock():
    rows = [
        ["Tag", "", "", "U-PHASE SLOT", "FRAME", "POWER"],
        ["Unit", "", "", "°C", "°C", "kW"],
        ["Date", "Time", "sec"],
    ]
    plan = layout(
        [*rows, *([["2021/08/17", f"13:02:{k:02d}", "0", str(20 + k), "21", "8"] for k in range(9)])], "a.csv"
    )
    assert plan.units[3:] == ("°C", "°C", "kW")


def test_a_label_before_the_unit_of_every_signal():
    """As a scope of control systems writes a clock beside each signal."""
    rows = [
        ["Name", "GVL.fWicklung", "Name", "GVL.fStrom"],
        ["Einheit", "°C", "Einheit", "A"],
        *([f"{k}", "20", f"{k}", "5"] for k in range(9)),
    ]
    plan = layout(rows, "a.csv")
    assert (plan.names[1], plan.names[3]) == ("GVL.fWicklung", "GVL.fStrom")
    assert (plan.units[1], plan.units[3]) == ("°C", "A")


def test_a_sign_of_degrees_makes_the_letter_behind_it_a_unit(tmp_path):
    """Whatever quantity the channel's own number looks like: M01 is not a torque."""
    names = ["M01.0 Wicklung °C", "M02.0 Gehäuse °C"]
    source = read_source(read(tmp_path, **dict.fromkeys(names, 20 + T)))
    assert [source.units[name] for name in names] == ["degC", "degC"]


def test_channels_are_called_by_what_differs_between_them():
    settings = [[f"CH{k}", name, "TEMP", "TC_K"] for k, name in enumerate(["Coil", "Frame", "Bearing", "Room"], 1)]
    head = ["Number", *(f"CH{k}" for k in range(1, 5))]
    plan = layout(
        [*settings, ["Logic/Pulse", "Off"], ["Data"], head, *([[str(k), "20", "21", "22", "23"] for k in range(9)])],
        "a.csv",
    )
    assert plan.names == ("Number", "CH1 Coil", "CH2 Frame", "CH3 Bearing", "CH4 Room")


def test_what_is_no_reading_of_the_machine_is_left_out(tmp_path):
    rise = 20 + 0.1 * T
    others = {"TC spare [°C]": 2290 + rise, "CU digital inputs": T % 3, "Brake": T % 4, "Efficiency [%]": rise}
    asked = {"Speed Cmd (%)": rise, "Speed [rpm]": 30 * rise, "trq\\ETKC:1 [Nm]": rise, "trqDes\\ETKC:1 [Nm]": rise}
    source = read_source(read(tmp_path, **{"T_winding [°C]": rise}, **others, **asked))
    found = {g.column: g.quantity for g in guesses(source, ["t [s]"], Target({"winding": Role.WINDING})) if g.used}
    assert found == {"T_winding [°C]": "temperature", "Speed [rpm]": "speed", "trq\\ETKC:1 [Nm]": "torque"}


def test_powers_of_parts_are_each_an_input(tmp_path):
    target = Target({"winding": Role.WINDING}, {}, {"power_W": "power"})
    source = read_source(read(tmp_path, **{"T_winding [°C]": 20 + T, "P_Cu [W]": 1 + T, "P_Fe [W]": 2 + T}))
    assert [g.feeds for g in guesses(source, ["t [s]"], target)] == ["", "power_W", "p_fe_W"]


@pytest.mark.parametrize("sign", ["clock", "number"])
def test_a_file_of_several_runs_is_as_many_tests(tmp_path, sign):
    run = np.repeat([3.0, 7.0, 4.0], 20)
    columns = {"t [s]": np.tile(T[:20], 3)} if sign == "clock" else {"t [s]": 0 * T, "profile_id": run}
    file = read(tmp_path, **columns, **{"T_winding [°C]": 20 + T})
    if sign == "number":
        file.write_text("\n".join(line.partition(",")[2] for line in file.read_text().splitlines()) + "\n")
    runs = read_runs(file)
    assert [source.numbers("T_winding [°C]")[0] for source, _ in runs] == [20.0, 60.0, 100.0]
    assert "3 tests, one from each start on" in runs[0][0].notes[-1]


def test_where_an_input_is_unknown_for_long_the_longest_part_is_the_test(tmp_path):
    ((source, clock),) = read_runs(read(tmp_path, **{"t [s]": 100 * T, "T_winding [°C]": 20 + T, "I [A]": T}))
    current = np.where((T > 30) & (T < 50), np.nan, T)
    record = Recording(Source({**source.cells, "I [A]": current}, file=source.file), clock, [])
    window, notes = longest_part(record, 120.0, ["I [A]"])
    assert window == (5000.0, 11800.0)
    assert "no 'I [A]' in a.csv from 3000 s to 5000 s" in notes[0]


def test_times_of_day_over_remarks_and_a_unit_alone_under_its_quantity(tmp_path):
    """A list by hand, whose last rows are signatures."""
    head = [["Time", "Voltage", None, None, "Current", None, None, "Input", "Speed", "Amb", "Coil"]]
    head += [["(hrs)", "R-Y", "Y-B", "B-R", "R", "Y", "B", "(kW)", "(rpm)", "(°C)", "(°C)"]]
    rows = [[time(10 + k // 2, 30 * (k % 2)), 415, 414, 416, 5, 4, 6, 2.5, 1480, 30.0, 30.0 + k] for k in range(9)]
    rows = [*head, *rows, [], ["Rise by resistance 80 K"], ["Tested by", None, "Witness"]]
    [(source, clock)] = read_runs(workbook(tmp_path / "a.xlsx", Sheet=rows))
    assert clock.seconds == pytest.approx(1800.0 * np.arange(9))
    assert "Input (kW)" in source.cells


def test_sheets_with_the_same_columns_are_tests_and_others_are_named(tmp_path):
    names = ["t [s]", "T_winding [°C]"]
    sheets = {"Sheet": [["step", "W"], *([k, 2] for k in range(4))]}
    for sheet, first in (("Run 1", 20.0), ("Run 2", 30.0)):
        sheets[sheet] = [names, *([t, first + t] for t in T[: 30 + int(first)].tolist())]
    runs = read_runs(workbook(tmp_path / "a.xlsx", **sheets, Words=[["About", "this"]]))
    assert [source.numbers(names[1])[0] for source, _ in runs] == [20.0, 30.0]
    assert [note.partition(": ")[2] for note in runs[0][0].notes] == [
        "a test from each of the worksheets Run 1, Run 2",
        "worksheet 'Sheet' is left out",
    ]


@pytest.mark.parametrize("clock", [float, lambda s: datetime(2026, 3, 28, 23, 58) + timedelta(seconds=s)])
def test_a_sheet_for_each_signal_is_one_test(tmp_path, clock):
    """Each at its own times, of its own length and begun at its own instant; a summary is not a signal."""
    signals = {"Winding": ("°C", 0, 5, 60), "Raum": ("°C", 10, 30, 12), "Strom": ("A", 4, 2, 140)}
    truth, sheets = {}, {"Sheet": [["Summary", "of all"]]}
    for sheet, (unit, begin, step, rows) in signals.items():
        truth[sheet] = {begin + step * k: 20.0 + k for k in range(rows)}
        head = ["Zeit [s]" if clock is float else "Zeit", f"Wert [{unit}]"]
        sheets[sheet] = [head, *([clock(second), value] for second, value in truth[sheet].items())]
    [(source, at)] = read_runs(workbook(tmp_path / "a.xlsx", **sheets))
    for sheet, readings in truth.items():
        (column,) = (c for c in source.columns if c.startswith(sheet))
        read = source.numbers(column)
        found = dict(zip(np.round(at.seconds[np.isfinite(read)], 3).tolist(), read[np.isfinite(read)], strict=True))
        assert found == {second: value for second, value in readings.items() if second <= 282}  # as Strom ends
    assert "the signals of the worksheets Winding, Raum, Strom are one test" in " ".join(source.notes)


def test_sheets_of_signals_that_share_no_time_are_refused(tmp_path):
    first, last = ([["t [s]", "value"], *([begin + t, 20 + t] for t in T.tolist())] for begin in (0, 900))
    with pytest.raises(InputError, match="never run at one time"):
        read_runs(workbook(tmp_path / "a.xlsx", Winding=first, Room=last))


def test_the_clocks_unit_behind_the_label_of_the_row_of_units():
    rows = [
        ["Name", "T_coil", "I"],
        ["Unit [s]", "°C", "A"],
        ["Comment", "", ""],
        *([[str(k), "20", "5"] for k in range(9)]),
    ]
    assert layout(rows, "a.txt").units == ("s", "°C", "A")


@pytest.mark.parametrize(("room", "added"), [("Ambient [°C]", True), ("Water in [°C]", False)])
def test_rises_beside_the_room_alone_are_temperatures(tmp_path, room, added):
    columns = {"Winding rise ΔT [K]": T, "dT_Frame [K]": 0.5 * T, room: 20 + 0.1 * T}
    [(source, _)] = read_runs(read(tmp_path, **columns))
    assert ("Winding" in source.labels.values()) == added
    if added:
        assert source.numbers(f"Winding rise ΔT [K] + {room}") == pytest.approx(20 + 1.1 * T)
        assert f"'{room}' is added" in source.notes[-1]
