"""Habits of other people's loggers, each in a file that its test makes."""

import json
import re
import tomllib

import numpy as np
import pytest

from geom.description.roles import Role
from geom.errors import InputError
from lumped.model.quantities import INPUTS
from measured.headers.cells import split_unit
from measured.headers.words import roles_of
from measured.importing.aligned import Recording, shift
from measured.importing.case_files import read_runs
from measured.importing.clock import clock_of
from measured.importing.guess import (
    AS_FLOW,
    AS_ROOM,
    DEAD,
    ELSE,
    OF_READINGS,
    OF_SUPPLY,
    OF_WHAT,
    ON_OFF,
    VARIANT,
    guesses,
    in_memory,
)
from measured.importing.source import read_source, signature
from thermoscope.commands.test.new import Wishes, first_model, new_case as new

N = 240
T = 5 * np.arange(N)
ON = np.where((np.arange(N) > 20) & (np.arange(N) < 120), 1.0, 0.0)
HEAT = np.cumsum(ON - 0.3 * np.roll(ON, 60))
WARM = {"W": 22 + 0.5 * HEAT, "H": 22 + 0.2 * HEAT, "A": np.full(N, 22.0), "I": 9 * ON, "n": 1500 * ON, "t": T}


def file(tmp_path, header, *columns, name="a.csv", digits=2):
    values = [WARM[c] if isinstance(c, str) else c for c in columns]
    rows = zip(*([f"{x:.{digits}f}" if isinstance(x, float) else str(x) for x in v] for v in values))
    (tmp_path / name).write_text("\n".join([header, *map(",".join, rows)]) + "\n")
    return tmp_path / name


def read(*files):
    """Column -> its guess, with the first network that is made of the files; and the recordings."""
    runs = [run for one in files for run in read_runs(one)]
    target = first_model(runs, {}).target
    return {g.column: (g, source) for source, clock in runs for g in guesses(source, clock.columns, target)}, runs


def goes(found):
    return {column: g.place or g.feeds for column, (g, _) in found.items() if g.used}


def written(tmp_path, *files):
    document = tmp_path / "new.json"
    assert new([*files], Wishes(out=tmp_path / "made", yes=True), str(document)) == 0
    return json.loads(document.read_text())


def test_units_that_change_from_cell_to_cell_are_made_one(tmp_path):
    """Dashboards write 845 W and 1.23 kW in one column."""
    power = [f"{x:.0f} W" if x < 1000 else f"{x / 1000:.3f} kW" for x in np.linspace(100, 2000, N)]
    found, _ = read(file(tmp_path, "t [s],winding [°C],Room [°C],P", "t", "W", "A", power))
    g, source = found["P"]
    assert g.unit == "W"
    assert in_memory(source, g) == pytest.approx(np.linspace(100, 2000, N), abs=1)


def test_registers_in_tenths_are_read_by_their_names(tmp_path):
    tenths = [(10 * WARM[c]).round().astype(int) for c in "WHA"]
    found, _ = read(file(tmp_path, "t [s],T_wdg_x10,T_hsg_x10,T_amb_x10,I [A]", "t", *tenths, "I"))
    assert goes(found) == {"T_wdg_x10": "wdg", "T_hsg_x10": "hsg", "T_amb_x10": "ambient", "I [A]": "current_A"}
    g, source = found["T_wdg_x10"]
    assert in_memory(source, g) == pytest.approx(WARM["W"], abs=0.06)


@pytest.mark.parametrize(
    ("header", "name", "unit"),
    [
        ("Wicklung US", "Wicklung US", ""),
        ("I_sek", "I_sek", ""),
        ("T_wdg_min", "T_wdg_min", ""),
        ("t_min", "t", "min"),
        ("Частота вращения, об/мин", "Частота вращения", "rpm"),
        ("Мощность, кВт", "Мощность", "kW"),
    ],
)
def test_the_end_of_a_name_is_no_unit_of_time(header, name, unit):
    assert split_unit(header) == (name, unit)


def test_what_is_made_of_a_reading_and_a_current_before_the_inverter_give_way(tmp_path):
    header = "t [s],T_stator,T_stator_filtered,room [°C],I_batt [A],I_phase [A],eta [%]"
    found, _ = read(file(tmp_path, header, "t", "W", "W", "A", WARM["I"] / 3, "I", WARM["I"]))
    assert goes(found) == {"T_stator": "stator", "room [°C]": "ambient", "I_phase [A]": "current_A"}
    header = "t [s],T_pm,T_pm_hat,T_pm_kf,room [°C],OTI_A,I [A]"
    found, _ = read(file(tmp_path, header, "t", *"WH", WARM["W"] + np.sin(T), "A", 1 - ON, "I"))
    assert goes(found).keys() == {"T_pm", "T_pm_kf", "room [°C]", "I [A]"}
    assert found["T_pm_kf"][0].doubt.startswith(VARIANT)
    assert found["OTI_A"][0].doubt == "a state, by its values"
    found, _ = read(file(tmp_path, "t [s],winding [°C],room [°C],I_rms_mean,I_rms_rms", "t", "W", "A", "I", "I"))
    assert "I_rms_rms" in goes(found)


def test_what_was_not_measured_where_something_else_was(tmp_path):
    """A model beside the readings, by its name or by theirs; an odometer, and a temperature in percent, are neither."""
    header = "t [s],winding measured [°C],winding LPTN [°C],frame meas [°C],frame XQZ [°C],odometer_km,Temp INV [%]"
    model = [WARM[c] + 3 * np.sin(T) for c in "WH"]
    found, _ = read(file(tmp_path, header, "t", "W", model[0], "H", model[1], 1e4 + T, 20 + 0.3 * HEAT))
    assert goes(found).keys() == {"winding measured [°C]", "frame meas [°C]", "frame XQZ [°C]"}
    assert found["winding LPTN [°C]"][0].doubt == "modelled, not read"
    assert found["frame XQZ [°C]"][0].doubt == VARIANT


@pytest.mark.parametrize("heads", [("", ""), ("Test 1: rated ", "Test 2: steps ")])
def test_tests_side_by_side_in_one_table(tmp_path, heads):
    """The second is shorter; two loggers that ran at one time are no two tests."""
    header = ",".join(
        f"{head}{name}" for head in heads for name in ("t (min)", "T_winding (°C)", "T_room (°C)", "I (A)")
    )
    short = {c: [f"{x:.1f}" for x in WARM[c][:200]] + [""] * (N - 200) for c in "tWAI"}
    _, runs = read(file(tmp_path, header, *"tWAI", *(short[c] for c in "tWAI")))
    assert [source.rows for source, _ in runs] == [N, 200]
    assert [clock.end_s for _, clock in runs] == [60 * T[-1], 60 * T[199]]
    assert [source.labels["T_winding"] for source, _ in runs] == ["T_winding"] * 2
    for day in ("2026-03-01 ", ""):
        stamps = [f"{day}{8 + k // 3600:02d}:{k // 60 % 60:02d}:{k % 60:02d}" for k in T.tolist()]
        _, runs = read(file(tmp_path, "Time,T1 (°C),T2 (°C),Time,T1 (°C),T2 (°C)", stamps, *"WH", stamps, *"HA"))
        assert len(runs) == 1


def test_tests_one_under_another_with_their_header_again(tmp_path):
    from openpyxl import Workbook

    book = Workbook()
    for _ in range(2):
        book.active.append(["t [min]", "winding [°C]", "room [°C]", "I [A]"])
        for row in zip(*(WARM[c].tolist() for c in "tWAI")):
            book.active.append(row)
        book.active.append([])
        book.active.append(["Test 2", "rated"])
    book.save(tmp_path / "a.xlsx")
    runs = read_runs(tmp_path / "a.xlsx")
    assert [clock.end_s for _, clock in runs] == [60 * T[-1]] * 2


def test_files_of_one_run_and_of_two(tmp_path):
    """A file for each signal: their clocks are one, whatever begins first. Other spellings are another test."""
    names = {"A": "T room", "W": "T wdg", "I": "I"}
    written(tmp_path, *(file(tmp_path, f"t [s],{h}", "t", c, name=f"{c}.csv") for c, h in names.items()))
    assert (tmp_path / "made/tests/A.toml").read_text().count("shift_s = 0 ") == 2
    a = file(tmp_path, "t [s],T wdg (°C),T room (°C),I (A)", *"tWAI", name="a.csv")
    b = file(tmp_path, "t_[s],i_[A],t_room_[°C],t_wdg_[°C]", *"tIAW", name="b.csv")
    assert signature(read_source(a)) == signature(read_source(b))


def test_a_list_of_uneven_steps_has_no_gaps_that_are_usual(tmp_path):
    rows = np.cumsum([0, *[2, 5, 5, 10, 3] * 6, 15, 15, 12, 5])
    at = [np.interp(60.0 * rows, 36 * T, WARM[c]) for c in "WAI"]
    written(tmp_path, file(tmp_path, "t [min],winding [°C],room [°C],I [A]", rows, *at))
    assert "max_gap_s" in (tmp_path / "made/tests/a.toml").read_text()
    assert "to_s" not in (tmp_path / "made/tests/a.toml").read_text()


def test_what_drives_a_motor_is_not_the_motor_and_two_words_of_no_latin_letters_are_two_inputs(tmp_path):
    header = (
        "t [s],Motor controller temp [°C],电机控制器温度(℃),电机温度(℃),总电压(V),输入电压(V),环境(℃),I cmd [A],I [A]"
    )
    found, _ = read(file(tmp_path, header, "t", 22 + 0.1 * HEAT, 22 + 0.15 * HEAT, "W", 300 - HEAT, 310 - HEAT, *"AII"))
    assert goes(found).keys() == {"电机温度(℃)", "总电压(V)", "输入电压(V)", "环境(℃)", "I [A]"}
    assert len({*goes(found).values()}) == 5


def test_a_robot_s_velocity_is_in_rad_s(tmp_path):
    """Beside its effort, as joints are logged; any other is in rpm."""
    for name, unit in (("effort", "rad/s"), ("torque", "rpm")):
        found, _ = read(file(tmp_path, f"t [s],velocity,{name},motor_temperature,I [A]", "t", "n", "I", "W", "I"))
        assert found["velocity"][0].unit == unit


def test_a_sheet_of_words_says_what_channels_are_and_a_load_read_less_often_has_no_gaps(tmp_path):
    from openpyxl import Workbook

    book = Workbook()
    book.active.append(["t [min]", "TC1 [°C]", "TC2 [°C]", "I [A]"])
    for i, row in enumerate(zip(*(WARM[c].tolist() for c in "tWAI"))):
        book.active.append([*row[:3], row[3] if i % 3 == 0 else None])
    legend = book.create_sheet("Plan")
    for row in (("Kanal", "Stelle"), ("TC1", "Wicklung U"), ("TC2", "Halle")):
        legend.append(row)
    book.save(tmp_path / "a.xlsx")
    document = written(tmp_path, tmp_path / "a.xlsx")
    assert [c["place"] for c in document["tests"][0]["columns"][:2]] == ["1-wicklung-u", "ambient"]
    assert "max_gap_s" in (tmp_path / "made/tests/a.toml").read_text()


def test_a_picture_beside_a_recording_is_left_out(tmp_path):
    (tmp_path / "bench.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 40)
    ((source, _),) = read_runs(file(tmp_path, "t [s],winding [°C],room [°C],I [A]", *"tWAI"), tmp_path / "bench.png")
    assert "bench.png is left out: it is not a record" in source.notes


def test_times_of_day_with_points_every_minute(tmp_path):
    stamps = [f"{9 + k // 60:02d}.{k % 60:02d}.00" for k in range(N)]
    ((_, clock),) = read_runs(file(tmp_path, "Dato,Klokkeslæt,T,I", ["03-02-2025"] * N, stamps, *"WI"))
    assert clock.end_s == 60 * (N - 1)


def test_of_two_speeds_the_motor_s_is_the_speed(tmp_path):
    found, _ = read(file(tmp_path, "t [s],cadence_rpm,motor_rpm,motor_temp [°C],I [A]", "t", 70 + ON, *"nWI"))
    assert goes(found)["motor_rpm"] == "speed_rpm"


def test_rows_of_several_machines(tmp_path):
    """One after the other at every time: a test of each; rows that a state parts are of one."""
    both = {c: np.repeat(WARM[c], 2) for c in "tWAI"}
    header = "t [s],Turbine,T_winding [°C],T_room [°C],I [A]"
    _, runs = read(file(tmp_path, header, both["t"], ["T01", "T06"] * N, *(both[c] for c in "WAI")))
    assert [(source.rows, clock.end_s, clock.doubt) for source, clock in runs] == [(N, T[-1], "")] * 2
    assert runs[0][0].numbers("T_winding [°C]") == pytest.approx(WARM["W"], abs=0.006)
    _, runs = read(file(tmp_path, header, "t", ["on", "off"] * (N // 2), *"WAI"))
    assert len(runs) == 1


def test_a_clock_without_a_unit_in_a_log_of_a_signal_a_row(tmp_path):
    """Rows 90 apart that read each signal every 1000: those are milliseconds."""
    rows = [(1000 * k + 90 * j, j) for k in range(N) for j in range(3)]
    cells = [[f"{WARM[c][k // 3]:.2f}" if j == i else "" for k, (_, j) in enumerate(rows)] for i, c in enumerate("WAI")]
    _, runs = read(file(tmp_path, "Time,T_winding [°C],T_room [°C],I [A]", [t for t, _ in rows], *cells))
    ((_, clock),) = runs
    assert clock.doubt == "no unit of 'Time': ms are assumed"


def test_brackets_of_a_chinese_sheet_and_the_letters_of_a_channel_in_a_word(tmp_path):
    header = "t [s],绕组（℃）,环境（℃）,电流（A）,转速（rpm）,Pmech/W"
    found, _ = read(file(tmp_path, header, *"tWAIn", 100 + 3 * HEAT))
    assert {g.doubt for g, _ in found.values()} == {""}
    assert found["Pmech/W"][0].unit == "W"


def test_names_that_two_words_were_joined_to(tmp_path):
    header = "t [s],motortemp,settemp,cputemp,vehicle_speed,wind speed,room [°C],I [A]"
    found, _ = read(file(tmp_path, header, "t", "W", "H", WARM["W"] + 1.0, "n", "I", "A", "I"))
    assert goes(found)["motortemp"] == "motor"
    assert not {"settemp", "cputemp"} & goes(found).keys()
    assert {found[c][0].quantity for c in ("vehicle_speed", "wind speed")} == {"vehicle_speed"}
    assert {found[c][0].quantity for c in ("motortemp", "settemp")} == {"temperature"}


def test_other_devices_are_no_parts_and_the_motor_is_its_winding(tmp_path):
    header = "t [s],Temp_Motor [°C],Temp_ESC [°C],Schaltschrank [°C],Gehäuse [°C],Halle [°C],I [A]"
    one = file(tmp_path, header, "t", "W", "H", "A", "H", "A", "I")
    found, runs = read(one)
    assert goes(found) == {
        "Temp_Motor [°C]": "motor",
        "Gehäuse [°C]": "gehäuse",
        "Halle [°C]": "ambient",
        "I [A]": "current_A",
    }
    network = tomllib.loads(first_model(runs, {}).first.text())
    assert network["nodes"]["motor"]["role"] == "winding"
    assert "the winding?" in found["Temp_Motor [°C]"][0].doubt


def test_rows_of_statistics_under_names_and_readings_without_a_unit_of_their_own(tmp_path):
    """As data frames write them, and as sets for machine learning scale them."""
    header = "t [s],T_wdg [°C],T_wdg [°C],room [°C],I [A],I [A],Batt [V]\n,mean,max,mean,mean,max,min"
    found, _ = read(file(tmp_path, header, "t", "W", WARM["W"] + 1, "A", "I", WARM["I"] + 1, 13 + np.sin(T)))
    assert found["min Batt [V]"][0].doubt == OF_READINGS
    assert {c: to for c, to in goes(found).items() if to != "voltage_V"} == {
        "mean T_wdg [°C]": "mean-wdg",
        "mean room [°C]": "ambient",
        "mean I [A]": "current_A",
    }
    scaled = [(v - v.mean()) / 20 for v in (WARM["W"], WARM["H"], WARM["A"] + np.sin(T))]
    found, _ = read(file(tmp_path, "t [s],winding,frame,room,I [A]", "t", *scaled, "I"))
    assert all(ELSE in found[name][0].doubt for name in ("winding", "frame", "room"))


def test_what_hardly_warms_is_the_room_where_no_other_column_is(tmp_path, capsys):
    one = file(tmp_path, "t [s],T_wdg,T_housing,T_cell,I [A]", "t", "W", "H", WARM["A"] + 0.1 * np.sin(T), "I")
    assert goes(read(one)[0])["T_cell"] == "ambient"
    assert written(tmp_path, one)["warnings"] == ["'T_cell': hardly warms: taken as the room"]


def test_a_long_table_by_day_and_month_has_its_units_and_a_remark_at_its_end(tmp_path):
    """Each signal by itself, one below the other, each where it changes."""
    lines = ["Tag;Horodatage;Valeur;Unité;Qualité"]
    for name, unit, key, step in (
        ("T_STATOR_U1", "°C", "W", 1),
        ("AMBIANCE", "°C", "A", 2),
        ("P_ACTIVE", "MW", "I", 5),
    ):
        for k in range(step - 1, N, step):
            lines.append(f"{name};02/04/2024 {18 + k // 60}:{k % 60:02d}:00;{WARM[key][k]:.2f};{unit};Good")
    (tmp_path / "a.csv").write_text("\n".join([*lines, "412 enregistrements;;;;"]) + "\n")
    found, ((source, clock),) = read(tmp_path / "a.csv")
    assert clock.seconds == pytest.approx(60.0 * np.arange(N))
    assert {g.unit for g, _ in found.values() if g.used} == {"degC", "MW"}
    assert not any("share signal and time" in note for note in source.notes)


def test_logs_of_what_changes_have_no_gaps(tmp_path):
    """Ten minutes without a row: nothing changed."""
    lines = ["time,tag,value", *(f"2024-04-02 18:{m:02d}:00,T_winding,{20 + m}" for m in (0, 2, 4, 14, 16, 26, 28, 30))]
    lines += [
        f"2024-04-02 18:{m:02d}:30,I_stator,{value}" for m, value in ((0, 0), (15, 9), (17, "I/O Timeout"), (29, 2))
    ]
    (tmp_path / "a.csv").write_text("\n".join(lines) + "\n")
    document = written(tmp_path, tmp_path / "a.csv")
    assert document["tests"][0]["duration_s"] == pytest.approx(1800.0)
    limit = re.search(r"max_gap_s = (\d+)", (tmp_path / "made/tests/a.toml").read_text())
    assert 600 <= int(limit[1]) < 1000


def test_a_home_writes_its_room_seldom_and_a_control_system_its_own_end(tmp_path):
    """A room that changes every ten minutes among rows of seconds; a tag that is read once, after the last reading."""
    lines = ["entity_id,state,last_changed"]
    for name, key, step, late in (("sensor.motor_winding", "W", 1, 0), ("sensor.cellar_temperature", "A", 60, 2)):
        values = WARM[key] + (np.arange(N) // 60 % 2) * 0.1
        stamps = [(k, 5 * k + late) for k in range(0, N, step)]
        lines += [f"{name},{values[k]:.2f},2026-05-07T09:{s // 60:02d}:{s % 60:02d}Z" for k, s in stamps]
    (tmp_path / "a.csv").write_text("\n".join([*lines, "$RT_OFF$,0,2026-05-07T09:40:00Z"]) + "\n")
    document = written(tmp_path, tmp_path / "a.csv")
    assert document["tests"][0]["duration_s"] == pytest.approx(5 * (N - 1))
    assert "'sensor.cellar_temperature': hardly warms: taken as the room" in document["warnings"]


@pytest.mark.parametrize(
    ("line", "step_s"),
    [("Rate,10 s", 10.0), ("Scan rate = 500 ms", 0.5), ("Messtakt:;10 s;;", 10.0), ("Sampling rate: 10 Hz", 1.0)],
)
def test_how_often_a_logger_reads(tmp_path, line, step_s):
    """By a line before the names; a frequency is none, nor a flow."""
    rows = "".join(f"{w:.2f},{i:.1f}\n" for w, i in zip(WARM["W"], WARM["I"]))
    (tmp_path / "a.csv").write_text(f"{line}\nflow rate,3 l/min\nT_winding [°C],I [A]\n{rows}")
    assert clock_of(read_source(tmp_path / "a.csv")).seconds == pytest.approx(step_s * np.arange(N))


def test_series_of_instants_and_readings(tmp_path):
    """As data bases of measurements answer: a name and pairs, the instant first or last."""
    for pair in (lambda t, v: [1778138070 + t, f"{v:.3f}"], lambda t, v: [v, 1000 * (1778138070 + t)]):
        series = [
            {"metric": {"__name__": name, "at": at}, "values": [pair(int(t), v) for t, v in zip(T, WARM[key])]}
            for name, at, key in (
                ("motor_celsius", "winding", "W"),
                ("motor_celsius", "frame", "H"),
                ("room_celsius", "hall", "A"),
                ("motor_current_amperes", "drive", "I"),
            )
        ]
        (tmp_path / "a.json").write_text(json.dumps({"status": "success", "data": {"result": series}}))
        found, ((source, clock),) = read(tmp_path / "a.json")
        assert clock.seconds == pytest.approx(T)
        assert goes(found)["room_celsius"] == "ambient"
        assert source.numbers("motor_celsius winding") == pytest.approx(WARM["W"], abs=1e-3)
        assert source.numbers("motor_celsius frame") == pytest.approx(WARM["H"], abs=1e-3)


def test_channels_of_two_rates_in_an_mf4(tmp_path):
    """Temperatures every 5 s beside a current ten times a second: each at its own instants, in one case."""
    asammdf = pytest.importorskip("asammdf")
    fast = np.arange(0.0, T[-1] + 0.05, 0.1)
    with asammdf.MDF() as mdf:
        slow = [("T_winding", "W"), ("T_housing", "H"), ("T_ambient", "A")]
        mdf.append([asammdf.Signal(WARM[key], T.astype(float), name=name, unit="degC") for name, key in slow])
        mdf.append([asammdf.Signal(np.interp(fast, T, WARM["I"]), fast, name="current", unit="A")])
        mdf.save(tmp_path / "a.mf4")
    _, ((source, clock),) = read(tmp_path / "a.mf4")
    at = np.isfinite(source.numbers("T_winding"))
    assert clock.seconds[at] == pytest.approx(T)
    assert source.numbers("T_winding")[at] == pytest.approx(WARM["W"])
    assert source.numbers("current") == pytest.approx(np.interp(fast, T, WARM["I"]))
    assert written(tmp_path, tmp_path / "a.mf4")["tests"][0]["duration_s"] == pytest.approx(T[-1])


def test_an_outlet_beside_an_inlet_is_a_check_and_the_first_line_says_so(tmp_path):
    header = "t [s],winding [°C],T_cool_in [°C],T_cool_out [°C],room [°C],I [A]"
    document = written(tmp_path, file(tmp_path, header, "t", "W", "A", "H", "A", "I"))
    assert document["warnings"] == ["'T_cool_out [°C]' stays in the file as a check, and feeds nothing"]


def test_air_that_leaves_the_machine_is_no_boundary_beside_a_room(tmp_path):
    """Without a room it is what there is."""
    header = "t [s],winding [°C],EXHAUST [°C],I [A]"
    found, _ = read(file(tmp_path, f"{header},room [°C]", "t", "W", "H", "I", "A"))
    assert goes(found) == {"winding [°C]": "winding", "I [A]": "current_A", "room [°C]": "ambient"}
    found, _ = read(file(tmp_path, f"{header},frame [°C]", "t", "W", "A", "I", "H"))
    assert goes(found)["EXHAUST [°C]"] == "coolant"


@pytest.mark.parametrize(
    ("more", "most_Hz", "feeds"), [("", 50.0, "speed_rpm"), (",n [rpm]", 50.0, ""), (",n [rpm]", 8e3, "switching_Hz")]
)
def test_the_frequency_of_the_supply_is_the_speed_where_none_was_recorded(tmp_path, more, most_Hz, feeds):
    """50 Hz are 3000 rpm of one pole pair; an inverter switches faster than any motor is fed."""
    columns = ["t", "W", "A", "I", most_Hz * ON, *["n"] * bool(more)]
    found, _ = read(file(tmp_path, f"t [s],winding [°C],room [°C],I [A],Freq [Hz]{more}", *columns))
    guess, source = found["Freq [Hz]"]
    assert guess.feeds == feeds
    assert in_memory(source, guess).max() == pytest.approx(3000.0 if feeds == "speed_rpm" else most_Hz)
    assert feeds or guess.doubt == OF_SUPPLY


@pytest.mark.parametrize("name", ["T_cabinet", "T_Schaltschrank"])
def test_a_cabinet_is_the_room_where_no_other_is_and_all_parts_are_warmer(tmp_path, name):
    found, _ = read(file(tmp_path, f"t [s],I [A],T_winding [°C],{name} [°C]", "t", "I", "W", "A"))
    assert goes(found) == {"I [A]": "current_A", "T_winding [°C]": "winding", f"{name} [°C]": "ambient"}
    assert AS_ROOM in found[f"{name} [°C]"][0].doubt
    found, _ = read(file(tmp_path, f"t [s],I [A],T_winding [°C],{name} [°C],Room [°C]", "t", "I", "W", "A", "A"))
    assert goes(found)["Room [°C]"] == "ambient"
    assert f"{name} [°C]" not in goes(found)
    found, _ = read(file(tmp_path, f"t [s],I [A],T_winding [°C],{name} [°C]", "t", "I", "H", "W"))
    assert f"{name} [°C]" not in goes(found)  # it is warmer than the winding: of an inverter in there


@pytest.mark.parametrize("words", [("1", "0"), ("on", "off"), ("TRUE", "FALSE")])
def test_what_is_on_and_off_is_an_input_where_no_other_says_the_same(tmp_path, words):
    brake = [words[k // 17 % 2] for k in range(N)]
    names = "t [s],I [A],T_winding [°C],Room [°C],Brake,Main contactor"
    found, _ = read(file(tmp_path, names, "t", "I", "W", "A", brake, [words[0 if on else 1] for on in ON]))
    assert goes(found)["Brake"] == "brake_percent"
    assert found["Brake"][0].doubt == ON_OFF
    assert "Main contactor" not in goes(found)  # it is where the current is


def test_the_speed_of_a_fan_is_a_flow_and_none_of_the_machine(tmp_path):
    fan = np.where(np.arange(N) > 80, 1200.0, 600.0)
    source = file(tmp_path, "t [s],I [A],T_winding [°C],Room [°C],fan_rpm", "t", "I", "W", "A", fan)
    found, _ = read(source)
    g, read_source = found["fan_rpm"]
    assert (g.quantity, g.feeds, g.doubt) == ("flow_share", "flow_percent", AS_FLOW)
    assert in_memory(read_source, g) == pytest.approx(fan)
    for place, quantity in (("fan_rpm", "speed"), ("speed", "speed"), ("flow_share", "flow_share")):
        out = tmp_path / place
        assert new([source], Wishes(out=out, yes=True, places={"fan_rpm": place}), str(tmp_path / "new.json")) == 0
        (column,) = (
            c
            for c in json.loads((tmp_path / "new.json").read_text())["tests"][0]["columns"]
            if c["column"] == "fan_rpm"
        )
        assert (column["feeds"], column["quantity"]) == (INPUTS.get(place, place), quantity)


def test_a_share_by_its_unit_alone_is_doubted(tmp_path):
    found, _ = read(file(tmp_path, "t [s],Q7 [%],I [A],T_winding [°C],T_room [°C]", "t", 100 * ON, "I", "W", "A"))
    assert found["Q7 [%]"][0].doubt == OF_WHAT


def test_a_cooler_that_is_on_and_off_in_signs_without_blanks(tmp_path):
    on = [str(k // 23 % 2) for k in range(N)]
    found, _ = read(file(tmp_path, "时间(s),电流(A),电机绕组温度,环境温度,冷却风机", "t", "I", "W", "A", on))
    assert found["冷却风机"][0].quantity == "flow_share"
    assert [g.doubt for g, _ in found.values() if g.place] == ["", ""]


def test_a_heading_beside_a_longitude_is_no_bearing(tmp_path):
    heading, east = (7.0 * np.arange(N)) % 360, 11.5 + 1e-4 * np.arange(N)
    names = "t [s],Longitude,Bearing,T_winding [°C],T_amb [°C],I [A]"
    found, _ = read(file(tmp_path, names, "t", east, heading, "W", "A", "I"))
    assert goes(found) == {"T_winding [°C]": "winding", "T_amb [°C]": "ambient", "I [A]": "current_A"}
    found, _ = read(file(tmp_path, names.replace("Longitude", "Bearing 2"), "t", "H", "H", "W", "A", "I"))
    assert goes(found)["Bearing"] == "bearing"


def test_the_room_of_the_machine_goes_before_that_of_a_converter(tmp_path):
    names = "t [s],T_stator [°C],Ambient temp (converter) [°C],Nacelle ambient temp [°C],I [A]"
    found, _ = read(file(tmp_path, names, "t", "W", "H", "A", "I"))
    assert [c for c, place in goes(found).items() if place == "ambient"] == ["Nacelle ambient temp [°C]"]


def test_a_place_by_hand_is_not_doubted(tmp_path):
    source = file(tmp_path, "t [s],winding [°C],Xyz 7 [°C],room [°C],I [A]", "t", "W", "H", "A", "I")
    wishes = Wishes(out=tmp_path / "made", yes=True, places={"Xyz 7 [°C]": "pulley"})
    assert new([source], wishes, str(tmp_path / "new.json")) == 0
    assert json.loads((tmp_path / "new.json").read_text())["warnings"] == []


def test_what_a_model_would_read_in_a_unit_that_nobody_knows_is_said_first(tmp_path):
    header = "t,winding,room,I,Flow,Depth\ns,°C,°C,A,bucket/h,kPa"
    document = written(tmp_path, file(tmp_path, header, "t", "W", "A", "I", 200 + 9 * ON, 300 + 9 * ON))
    assert document["warnings"] == ["'Flow' is left out: its unit 'bucket/h' is unknown"]


def test_a_folder_that_cannot_be_made_is_told_before_anything_is_read(tmp_path):
    (tmp_path / "a.csv").write_text("no recording at all")
    with pytest.raises(InputError, match="no such folder"):
        new([tmp_path / "a.csv"], Wishes(out=tmp_path / "none" / "made", yes=True), None)


def test_a_test_begins_where_its_inputs_do(tmp_path):
    late = ["" if t < 300 else f"{i:.1f}" for t, i in zip(T, WARM["I"])]
    (test,) = written(tmp_path, file(tmp_path, "t [s],winding [°C],room [°C],I [A]", "t", "W", "A", late))["tests"]
    assert test["duration_s"] == pytest.approx(5 * (N - 1) - 300)


def test_runs_of_two_recorders_are_told_by_their_column(tmp_path):
    """A row for every reading beside a table of loads, both with the test of every row; two powers are a loss."""
    lines = [
        f"R{r},{k},{s},{273.15 + WARM[c][k]:.2f}"
        for r in (1, 2)
        for k in range(N)
        for s, c in zip(("winding", "room"), "WA")
    ]
    (tmp_path / "T.csv").write_text("\n".join(["test_id,elapsed_min,sensor,value_K", *lines]) + "\n")
    loads = [f"R{r},{k},{300 * ON[k]:.1f},{250 * ON[k]:.1f}" for r in (1, 2) for k in range(N)]
    (tmp_path / "P.csv").write_text("\n".join(["test_id,elapsed_min,P_in [W],P_out [W]", *loads]) + "\n")
    document = written(tmp_path, tmp_path / "T.csv", tmp_path / "P.csv")
    assert [len(test["files"]) for test in document["tests"]] == [2, 2]
    assert document["tests"][0]["files"][1]["aligned_by"] == "both clocks count alike"
    given = {c["column"]: (c["feeds"], c["unit"]) for c in document["tests"][0]["columns"] if c["feeds"]}
    assert given["loss P_in [W] - P_out [W]"] == ("power_W", "W")
    assert {"P_in [W]", "P_out [W]"} < given.keys()
    assert "of all between them" in str(document["tests"][0]["files"][1]["notes"])


def test_a_number_of_the_run_parts_a_clock_that_goes_on(tmp_path):
    """But only where it pauses: a profile that changes on the way is no other test."""
    for pause, count in ((4000, 2), (0, 1)):
        t, run = T + pause * (np.arange(N) >= 100), np.where(np.arange(N) < 100, 41, 42)
        assert len(read_runs(file(tmp_path, "t [s],run,winding [°C],I [A]", t, run, "W", "I"))) == count


def test_clocks_since_boot_agree_and_a_recorder_of_something_else_is_left_out(tmp_path):
    boot = 61_234_567 + 100_000 * np.arange(N)
    a = file(
        tmp_path,
        "timestamp,esc[0].rpm,esc[0].current,esc[1].rpm,esc[1].current",
        boot,
        "n",
        "I",
        "n",
        "I",
        name="e.csv",
    )
    b = file(tmp_path, "timestamp,m1_winding_degC,air_degC", boot + 50_000, "W", "A", name="m.csv")
    c = file(tmp_path, "timestamp,baro_temp_degC,rho", boot, "H", "A", name="b.csv")
    document = written(tmp_path, a, b, c)
    (test,) = document["tests"]
    assert [f["shift_s"] for f in test["files"]] == [0.0, pytest.approx(0.05)]
    assert {c["column"] for c in test["columns"] if c["feeds"]} == {"esc[0].rpm", "esc[0].current"}
    assert any("several machines" in warning for warning in document["warnings"])
    assert any(note.startswith("b.csv is left out") for note in test["notes"])


def test_clocks_of_two_loggers_from_zero_are_still_set_by_what_begins(tmp_path):
    a, b = (
        read_runs(file(tmp_path, f"t [s],{name}", "t", key, name=f"{key}.csv"))[0]
        for name, key in (("I [A]", "I"), ("winding [°C]", "W"))
    )
    records = [
        Recording(source, clock, list(guesses(source, clock.columns, first_model([b], {}).target)))
        for source, clock in (a, b)
    ]
    assert "onset" in shift(*records)[1]


def test_a_labview_file_has_its_units_in_its_second_head_and_no_groups(tmp_path):
    head = [
        "LabVIEW Measurement",
        "Separator\tTab",
        "***End_of_Header***\t",
        "Channels\t3",
        "Date" + 3 * "\t2024/06/11",
    ]
    head += [
        "Y_Unit_Label\tGrad C\tGrad C\tA",
        "X_Dimension" + 3 * "\tTime",
        "X0" + 3 * "\t0.0",
        "Delta_X" + 3 * "\t5.0",
    ]
    rows = "\n".join(f"{5 * k}\t{WARM['W'][k]:.3f}\t{WARM['A'][k]:.3f}\t{WARM['I'][k]:.3f}" for k in range(N))
    (tmp_path / "a.lvm").write_text(
        "\n".join(head) + f"\n***End_of_Header***\t\t\t\nX_Value\tQx oben\tUmgebung\tI_sek\n{rows}\n"
    )
    found, _ = read(tmp_path / "a.lvm")
    assert {c: g.unit for c, (g, _) in found.items()} == {"Qx oben": "degC", "Umgebung": "degC", "I_sek": "A"}


@pytest.mark.parametrize(
    ("name", "role"),
    [
        ("fTempSpindleNut", Role.BEARING),
        ("Nut 3", Role.WINDING),
        ("TEMP_STATOR_V1", Role.WINDING),
        ("Stator", Role.IRON),
        ("příruba", Role.END_SHIELD),
        ("Hölje", Role.HOUSING),
        ("axle", Role.SHAFT),
        ("T polea", Role.SHAFT),
        ("gearbox oil", None),
        ("oil inlet", Role.COOLANT),
        ("Bain d'huile", None),
        ("T escobillas", Role.COMMUTATOR),
        ("Olie boven", None),  # no oven
        ("teplota okolia", Role.AMBIENT),
        ("Rulman sıcaklığı tahrik tarafı", Role.BEARING),
        ("อุณหภูมิตลับลูกปืน", Role.BEARING),
        ("อุณหภูมิตัวถัง", Role.HOUSING),
        ("Korpus", Role.HOUSING),
        ("코일 온도", Role.WINDING),
        ("실내 온도", Role.AMBIENT),
        ("T_Ruecklauf", Role.COOLANT),
        ("T_lozysko", Role.BEARING),
        ("kolnierz", Role.END_SHIELD),
        ("EmTRtr_T", Role.ROTOR),
        ("airtemp", Role.AMBIENT),
        ("template", Role.TEST_BED),  # a plate, and no temperature
    ],
)
def test_names_of_parts_in_the_words_of_other_shops(name, role):
    assert next(iter(roles_of(name)), None) is role


@pytest.mark.parametrize(
    ("header", "quantity", "first", "doubted"),
    [
        ("flow [g/s]", "water_flow", 0.06 * 9.0, False),  # water of 1 kg/l
        ("mdot_kg_h", "water_flow", 9.0 / 60.0, False),
        ("air mass flow [kg/h]", "air_flow", 9.0 / 1.2, False),  # 1.2 kg/m3 at 20 degC
        ("Luftmassenstrom [kg/s]", "air_flow", 3600 * 9.0 / 1.2, False),
        ("air flow [m3/h]", "air_flow", 9.0, False),
        ("flow [m3/hr]", "water_flow", 9000.0 / 60.0, False),
        ("flow [L/hour]", "water_flow", 9.0 / 60.0, False),
        ("flow [l/sec]", "water_flow", 60 * 9.0, False),
        ("gas [kg/h]", "water_flow", 9.0 / 60.0, True),
    ],
)
def test_a_flow_of_mass_or_of_air(tmp_path, header, quantity, first, doubted):
    found, _ = read(file(tmp_path, f"t,{header},T_winding,T_amb", "t", np.full(N, 9.0), "W", "A"))
    guess, source = next(one for column, one in found.items() if column[:2] == header[:2])
    assert guess.quantity == quantity
    assert in_memory(source, guess)[0] == pytest.approx(first, rel=1e-9)
    assert bool(guess.doubt) == doubted


@pytest.mark.parametrize("cell", ["{0:.1f}°C ({1:.1f}°F)", "{0:.1f} C / {1:.1f} F", "{0:.1f}C {1:.1f}F"])
def test_two_units_in_a_cell_are_two_columns_of_one_reading(tmp_path, cell):
    both = [cell.format(w, 1.8 * w + 32) for w in WARM["W"]]
    found, runs = read(file(tmp_path, "t [s],Temperature,I [A]", "t", both, "I"))
    celsius, fahrenheit, _ = (g for g, _ in found.values())
    assert (celsius.unit, fahrenheit.unit, fahrenheit.used) == ("degC", "degF", False)
    assert in_memory(runs[0][0], celsius) == pytest.approx(WARM["W"], abs=0.06)


def test_a_temperature_and_a_current_in_one_cell(tmp_path):
    both = [f"{w:.1f} C {i:.2f} A" for w, i in zip(WARM["W"], WARM["I"], strict=True)]
    found, _ = read(file(tmp_path, "t [s],winding", "t", both))
    assert [(g.quantity, g.used) for g, _ in found.values()] == [("temperature", True), ("current", True)]


@pytest.mark.parametrize("names", ["batt_v,batt_i", "V,I", "Voltage_load,Current_load", "pack.v,pack.i"])
def test_a_voltage_is_told_by_the_current_beside_it(tmp_path, names):
    volts = 3.7 + 0.01 * WARM["I"]
    found, _ = read(file(tmp_path, f"t [s],{names},T_cell [°C]", "t", volts, "I", "W"))
    assert [g.feeds for g, _ in found.values() if g.feeds] == ["voltage_V", "current_A"]
    assert sum(bool(g.place) for g, _ in found.values()) == 1


def test_phases_are_no_voltage_and_current(tmp_path):
    """The temperatures of three phases beside a current."""
    found, _ = read(file(tmp_path, "t [s],T_u,T_v,T_w,T_i", "t", "W", WARM["W"] + 0.31, WARM["W"] - 0.17, "A"))
    assert not any(g.quantity == "voltage" for g, _ in found.values())


@pytest.mark.parametrize(("flow", "place"), [("flow", "coolant"), ("draught", "")])
def test_what_comes_in_beside_a_flow_is_the_coolant(tmp_path, flow, place):
    flows = 1.2 + 0.001 * np.sin(WARM["t"])
    header = f"t [s],winding [°C],T_in [°C],T_out [°C],{flow},I [A]"
    found, runs = read(file(tmp_path, header, "t", "W", "A", 0.7 * WARM["A"] + 0.3 * WARM["W"], flows, "I"))
    assert (found["T_in [°C]"][0].place == "coolant") == bool(place)
    assert ("those of the flow" in " ".join(runs[0][0].notes)) == bool(place)


def test_minutes_and_seconds_go_on_from_hour_to_hour(tmp_path):
    """As spreadsheets cut instants: no test begins anew at each full hour."""
    stamps = [f"{10 * k % 60:02d}:42.0" for k in range(N)]
    ((_, clock),) = read_runs(file(tmp_path, "Time,T [°C],I [A]", stamps, "W", "I"))
    assert clock.end_s == 600 * (N - 1)


def test_a_clock_that_slips_for_one_row_costs_that_row(tmp_path):
    seconds = [*range(0, 60 * N, 60)]
    slips = [max(s - 180, 0) if k == N // 2 else s for k, s in enumerate(seconds)]
    stamps = [f"2025-03-01 {s // 3600:02d}:{s // 60 % 60:02d}:{s % 60:02d}" for s in slips]
    ((_, clock),) = read_runs(file(tmp_path, "Time,T [°C],I [A]", stamps, "W", "I"))
    assert np.isnan(clock.seconds).sum() == 1
    assert "1 rows whose clock runs back" in clock.doubt
    back = [s - 1800 * (k >= N // 2) for k, s in enumerate(seconds)]
    stamps = [f"2025-03-01 {s // 3600:02d}:{s // 60 % 60:02d}:{s % 60:02d}" for s in back]
    with pytest.raises(InputError, match="runs back"):
        read_runs(file(tmp_path, "Time,T [°C],I [A]", stamps, "W", "I"))


def test_two_dashes_before_a_reading_with_its_name(tmp_path):
    lines = [f"06/05/2021 23:{k // 60:02d}:{k % 60:02d}--Coil T1 : {20 + k / 7:.3f} C" for k in range(N)]
    (tmp_path / "a.txt").write_text("\n".join(lines) + "\n")
    ((source, clock),) = read_runs(tmp_path / "a.txt")
    assert (clock.end_s, source.units["Coil T1"]) == (N - 1, "degC")


def test_a_reading_of_all_rows_of_an_instant_in_a_table_without_names(tmp_path):
    """Temperatures and powers of rooms take turns; the air outside stands behind each of them."""
    rows = [
        f"2025-07-28T{k // 4:02d}:{15 * (k % 4):02d},{name},{value:.2f},{5 + 0.1 * k:.1f}"
        for k, (w, i) in enumerate(zip(WARM["W"][:40], WARM["I"][:40], strict=True))
        for name, value in (
            ("temp_kitchen", w),
            ("power_kitchen", i),
            ("temp_bedroom", w + 1),
            ("power_bedroom", 2 * i),
        )
    ]
    (tmp_path / "a.csv").write_text("\n".join(rows) + "\n")
    found, runs = read(tmp_path / "a.csv")
    assert runs[0][0].rows == 40
    assert found["temp_bedroom"][0].place not in ("", "ambient")
    assert [g.quantity for g, _ in found.values()].count("power") == 2
    assert runs[0][0].numbers("column 4") == pytest.approx(5 + 0.1 * np.arange(40))


def test_a_constant_that_is_all_there_is_says_so(tmp_path):
    found, _ = read(file(tmp_path, "t [s],T_1 [°C],T_2 [°C],I [A]", "t", ["21.5"] * N, ["14.25"] * N, "I"))
    assert all(DEAD in g.doubt for g, _ in found.values() if g.quantity == "temperature")


def test_percents_without_a_name_are_no_temperatures(tmp_path):
    (tmp_path / "a.csv").write_text("".join(f"{29 + k // 9}%,{885 + k}000,{1598098561 + 60 * k}\n" for k in range(N)))
    with pytest.raises(InputError, match="no column is a temperature"):
        read(tmp_path / "a.csv")


def test_boiler_and_return_are_temperatures_by_their_names(tmp_path):
    burner = ["1" if i > 0 else "0" for i in WARM["I"]]
    found, _ = read(
        file(tmp_path, "t [s],boiler,return,burner,room [°C]", "t", WARM["W"] + 30, WARM["W"] + 20, burner, "A")
    )
    assert [g.quantity for g, _ in found.values()][:3] == ["temperature", "temperature", "share"]
